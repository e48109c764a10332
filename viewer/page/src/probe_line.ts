// SPDX-License-Identifier: Apache-2.0
/** One line under everything: what is at the pointer, or at the crosshair while the pointer is elsewhere. */
import type { App } from "./model";
import { probe, type Answer } from "./probe";
import type { Tools } from "./tools";
import { brief, h } from "./ui";

export class ProbeLine {
  private readonly fields = ["position", "value", "distance", "normal", "node", "branch"].map(name => ({ name, value: h("span", { id: `probe-${name}`, class: `field ${name}` }) }));
  private pointing = false;

  constructor(element: HTMLElement, private readonly app: App, tools: Tools) {
    const titles: Record<string, string> = { position: "mm", value: "Value", distance: "Wall", normal: "Normal", node: "Node", branch: "Vessel" };
    for (const { name, value } of this.fields) element.append(h("span", { class: "pair" }, h("span", { class: "title" }, titles[name]), value));
    tools.onProbe(answer => { this.pointing = answer !== null; if (answer !== null) this.show(answer); else this.rest(); });
    app.store.watch(["crosshair", "blob", "volumeReady"], () => { if (!this.pointing) this.rest(); });
  }

  private rest(): void { const view = this.app.store.get(); this.show(probe(view, view.crosshair)); }

  private show(a: Answer): void {
    const { tree } = this.app.store.get(), branch = a.wall === null ? undefined : tree?.branches[tree.branch[a.wall.node]];
    const texts: Record<string, string> = {
      position: a.position.map(x => x.toFixed(2)).join("  "), value: brief(a.value), distance: a.wall === null ? "–" : `${a.wall.distance >= 0 ? "+" : "−"}${Math.abs(a.wall.distance).toFixed(3)} mm`,
      normal: a.wall === null ? "–" : a.wall.normal.map(x => x.toFixed(2)).join(" "), node: a.wall === null ? "–" : String(a.wall.node), branch: branch?.label ?? "–",
    };
    for (const { name, value } of this.fields) value.textContent = texts[name];
    // for whoever reads them by program: all digits
    const distance = this.fields[2].value;
    if (a.wall !== null) distance.dataset.mm = String(a.wall.distance); else delete distance.dataset.mm;
    distance.classList.toggle("inside", a.wall?.inside === true);
  }
}
