// SPDX-License-Identifier: Apache-2.0
/** The legends of colours, in the corner of the 3D view: of the surface, and of meshes. */
import { mapColour, systemColour, toCss, type MapName } from "../base/colour";
import { colouring } from "../model/colouring";
import { deviationText, kDeviationMap, sharedRange } from "../case/deviation";
import type { Part } from "../model/model";
import { brief, h } from "../base/ui";

/** A title, a bar of colours and the numbers at its ends and in its middle. */
class Scale {
  private readonly bar = h("canvas", { width: 120, height: 8, "aria-hidden": "true" });
  private readonly ends = [h("span", {}), h("span", {}), h("span", {})];
  private readonly title = h("strong", {});
  private readonly box = h("div", { class: "scale" }, this.bar, h("div", { class: "ends" }, ...this.ends));

  constructor(private readonly element: HTMLElement) {
    element.append(this.title, this.box);
  }

  hide(isHidden: boolean): void {
    this.title.hidden = this.box.hidden = isHidden;
  }

  show(title: string, [low, high]: [number, number], map: MapName): void {
    this.title.textContent = title;
    [low, (low + high) / 2, high].forEach((value, i) => (this.ends[i].textContent = brief(value)));
    this.element.setAttribute("aria-label", `${title}: from ${brief(low)} to ${brief(high)}`);
    const context = this.bar.getContext("2d")!;
    for (let x = 0; x < this.bar.width; ++x) {
      context.fillStyle = toCss(mapColour(map, x / (this.bar.width - 1)));
      context.fillRect(x, 0, 1, this.bar.height);
    }
  }
}

/** That of the surface's colours. */
export function surfaceLegend(element: HTMLElement, app: Part<"document" | "scene">): void {
  const scale = new Scale(element),
    systems = h("div", { class: "figures" });
  element.append(systems);
  app.store.watch(["scene.colourBy", "document.surface", "document.distance", "document.tree"], view => {
    const c = colouring(view),
      names = c.mapped ? [] : (view.document.tree?.systems ?? []);
    element.hidden = !c.mapped && names.length === 0;
    scale.hide(!c.mapped);
    if (names.length > 0) element.setAttribute("aria-label", `Systems: ${names.join(", ")}`);
    systems.replaceChildren(
      ...names.map(name => {
        const word = h("span", {}, name.replaceAll("-", " "));
        word.style.color = toCss(systemColour(name, 1) ?? [0.7, 0.7, 0.7]); // the page's policy refuses the attribute
        return word;
      }),
    );
    if (c.mapped) scale.show(c.unit === "" ? c.title : `${c.title}, ${c.unit}`, c.range, c.map);
  });
}

/** That of meshes which are coloured by their deviation, with the figures of each. */
export function deviationLegend(element: HTMLElement, app: Part<"document">): void {
  const scale = new Scale(element),
    lines = h("div", { class: "figures" });
  element.append(lines);
  app.store.watch(["document.deviations"], ({ document: { deviations } }) => {
    element.hidden = deviations.size === 0;
    if (deviations.size === 0) return;
    const all = [...deviations.values()];
    scale.show("Mesh from wall, mm", sharedRange(all), kDeviationMap);
    lines.replaceChildren(
      ...all.map(each =>
        h("span", {}, all.length > 1 ? `${each.name}: ${deviationText(each)}` : deviationText(each)),
      ),
    );
    element.setAttribute(
      "aria-label",
      `${element.getAttribute("aria-label")!}; ${all.map(each => `${each.name}: ${deviationText(each)}`).join("; ")}`,
    );
  });
}
