// SPDX-License-Identifier: Apache-2.0
/** One line under everything: what is at the pointer, or at the crosshair while the pointer is elsewhere. */
import type { App } from "./model";
import { probe, type Answer, type Wall } from "./probe";
import type { Tools } from "./tools";
import { brief, h } from "./ui";

const kTitles = {
  position: "mm",
  value: "Value",
  distance: "Wall",
  normal: "Normal",
  node: "Node",
  branch: "Vessel",
};

/** With the digits that are true: libblob's error is a hundred-thousandth of the radius, or unknown. */
export function distanceText(wall: Pick<Wall, "distance" | "converged">): string {
  const size = Math.abs(wall.distance),
    sign = wall.distance >= 0 ? "+" : "−";
  return wall.converged ? `${sign}${size.toFixed(3)} mm` : `about ${sign}${size.toPrecision(2)} mm`;
}

export class ProbeLine {
  private readonly fields = Object.fromEntries(
    Object.keys(kTitles).map(name => [name, h("span", { id: `probe-${name}`, class: `field ${name}` })]),
  ) as Record<keyof typeof kTitles, HTMLElement>;
  private pointing = false;

  constructor(
    element: HTMLElement,
    private readonly app: App,
    tools: Tools,
  ) {
    for (const [name, title] of Object.entries(kTitles))
      element.append(
        h(
          "span",
          { class: "pair" },
          h("span", { class: "title" }, title),
          this.fields[name as keyof typeof kTitles],
        ),
      );
    tools.onProbe(answer => {
      this.pointing = answer !== null;
      if (answer !== null) this.show(answer);
      else this.rest();
    });
    app.store.watch(["crosshair", "blob", "volumeReady"], () => {
      if (!this.pointing) this.rest();
    });
  }

  private rest(): void {
    const view = this.app.store.get();
    this.show(probe(view, view.crosshair));
  }

  private show(a: Answer): void {
    const { tree } = this.app.store.get(),
      branch = a.wall === null ? undefined : tree?.branches[tree.branch[a.wall.node]];
    const texts: Record<keyof typeof kTitles, string> = {
      position: a.position.map(x => x.toFixed(2)).join("  "),
      value: brief(a.value),
      distance: a.wall === null ? "–" : distanceText(a.wall),
      normal: a.wall === null ? "–" : a.wall.normal.map(x => x.toFixed(2)).join(" "),
      node: a.wall === null ? "–" : String(a.wall.node),
      branch: branch?.label ?? "–",
    };
    for (const name of Object.keys(kTitles) as (keyof typeof kTitles)[])
      this.fields[name].textContent = texts[name];
    // all digits, for programs
    const { position, distance, node } = this.fields;
    position.dataset.mm = a.position.join(" ");
    if (a.wall !== null) {
      distance.dataset.mm = String(a.wall.distance);
      node.dataset.node = String(a.wall.node);
    } else {
      delete distance.dataset.mm;
      delete node.dataset.node;
    }
    distance.classList.toggle("inside", a.wall?.inside === true);
  }
}
