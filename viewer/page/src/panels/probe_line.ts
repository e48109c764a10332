// SPDX-License-Identifier: Apache-2.0
/** One line under everything: what is at the pointer, or at the crosshair while the pointer is elsewhere. */
import type { Part } from "../model/model";
import { probe, type Answer, type Wall } from "../tools/probe";
import type { Tools } from "../tools/tools";
import { goTo } from "../model/selection";
import type { Axes } from "../model/model";
import type { Vec3 } from "../base/types";
import { askText, brief, h } from "../base/ui";

const kTitles = {
  position: "mm",
  value: "Value",
  second: "Second",
  label: "Label",
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

/** A position or direction in the axes that are shown, and back. */
export function inAxes([x, y, z]: Vec3, axes: Axes): Vec3 {
  return axes === "LPS" ? [x, y, z] : [0 - x, 0 - y, z];
}

/** Three numbers, apart by blanks, commas or semicolons; null for anything else. */
export function parsePosition(text: string): Vec3 | null {
  const words = text
      .trim()
      .split(/[\s,;]+/)
      .map(Number),
    [x, y, z] = words;
  return words.length === 3 && words.every(Number.isFinite) && text.trim() !== "" ? [x, y, z] : null;
}

/** Asks for coordinates and goes there. */
export async function askPosition(app: Part<"slices", "inform">): Promise<void> {
  const { crosshair, axes } = app.store.get().slices,
    text = await askText(
      "Go to a place",
      `x, y and z in mm, ${axes}`,
      inAxes(crosshair, axes)
        .map(mm => mm.toFixed(2))
        .join(" "),
    );
  if (text === null) return;
  const place = parsePosition(text);
  if (place === null) app.inform(`“${text}” is no place: expected are three numbers.`, "warning");
  else goTo(app, inAxes(place, axes));
}

export class ProbeLine {
  private readonly fields = Object.fromEntries(
    Object.keys(kTitles).map(name => [name, h("span", { id: `probe-${name}`, class: `field ${name}` })]),
  ) as Record<keyof typeof kTitles, HTMLElement>;
  private pointing = false;

  constructor(
    element: HTMLElement,
    private readonly app: Part<"document" | "motion" | "slices", "inform">,
    tools: Tools,
  ) {
    const frame = h(
      "button",
      {
        type: "button",
        class: "title frame",
        id: "probe-frame",
        title:
          "Axes of the coordinates, in mm: LPS (to the left, back, head) or RAS (to the right, front, head)",
        onclick: () =>
          app.store.set({ slices: { axes: app.store.get().slices.axes === "LPS" ? "RAS" : "LPS" } }),
      },
      "LPS",
    );
    element.append(frame);
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
    app.store.watch(
      [
        "slices.crosshair",
        "document.blob",
        "motion.time",
        "document.volumeReady",
        "document.secondReady",
        "document.labelsReady",
      ],
      () => {
        if (!this.pointing) this.rest();
      },
    );
    const second = this.fields.second.parentElement!;
    second.title = "Value of the second volume";
    app.store.watch(["document.second"], view => {
      second.hidden = view.document.second === null;
    });
    const label = this.fields.label.parentElement!;
    label.title = "Label of the voxel";
    app.store.watch(["document.labels"], view => {
      label.hidden = view.document.labels === null;
    });
    app.store.watch(["slices.axes"], ({ slices: { axes } }) => {
      frame.textContent = axes;
      frame.setAttribute("aria-label", `Coordinates in mm, ${axes}; press for the others`);
      this.rest();
    });
    this.fields.position.title = "Go to a place  (J)";
    this.fields.position.addEventListener("click", () => void askPosition(app));
  }

  private rest(): void {
    const view = this.app.store.get();
    this.show(probe(view, view.slices.crosshair));
  }

  private show(a: Answer): void {
    const {
        document: { tree },
        slices: { axes },
      } = this.app.store.get(),
      branch = a.wall === null ? undefined : tree?.branches[tree.branch[a.wall.node]];
    const texts: Record<keyof typeof kTitles, string> = {
      position: inAxes(a.position, axes)
        .map(x => x.toFixed(2))
        .join("  "),
      value: brief(a.value),
      second: brief(a.second),
      label: a.label === null ? "–" : `${a.label.value} ${a.label.name ?? ""}`.trim(),
      distance: a.wall === null ? "–" : distanceText(a.wall),
      normal:
        a.wall === null
          ? "–"
          : inAxes(a.wall.normal, axes)
              .map(x => x.toFixed(2))
              .join(" "),
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
