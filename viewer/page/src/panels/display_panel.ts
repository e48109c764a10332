// SPDX-License-Identifier: Apache-2.0
/** Display settings: volumes, parts of the 3D view, colours, planes. */
import { kColourTitles, numbersOf } from "../model/colouring";
import type { Actions } from "./actions";
import type { CursorPart, Part, ColourBy, Layers, Planes } from "../model/model";
import { followVessel } from "../model/selection";
import { resetPlanes, turnPlanes } from "../tools/slice_input";
import { button, checkbox, h, section, select, slider } from "../base/ui";
import { secondSection, volumeSection } from "./volume_panel";

const kLayerTitles: [keyof Layers, string, string][] = [
  ["surface", "Surface", "The wall as triangles"],
  ["lines", "Centerlines", "The tree's lines, in slices as dots"],
  ["nodes", "Nodes", "Each node as a cylinder, instead of the surface"],
  ["points", "Wall points", "The points that the tracker found on the wall"],
  [
    "local",
    "Local model",
    "The model of the node at the cursor alone: its own field, not blended with its neighbours",
  ],
  ["contours", "Outlines", "The surface's outlines in the slices"],
  ["seeds", "Seeds", "Clicks"],
  ["places", "Missing vessels", "Vessels that the check found missing"],
  ["proposals", "Proposals", "Vessels that were found and wait to be accepted, dashed"],
  ["names", "Names", "Names of vessels in all views  (L)"],
  ["slices", "Slices in 3D", "The three slices as planes in the 3D view"],
];

export function displayPanel(
  app: CursorPart<"scene" | "page", "inform">,
  actions: Pick<Actions, "lookFrom" | "parallel">,
): HTMLElement[] {
  return [volumeSection(app), secondSection(app), sceneSection(app, actions), planesSection(app)];
}

function sceneSection(
  app: Part<"document" | "selection" | "scene">,
  actions: Pick<Actions, "lookFrom" | "parallel">,
): HTMLElement {
  const { store } = app;
  const boxes = kLayerTitles.map(([name, title, tip]) => ({
    name,
    element: checkbox(`layer-${name}`, title, tip, store.get().scene.layers[name], on =>
      store.set({ scene: { layers: { ...store.get().scene.layers, [name]: on } } }),
    ),
  }));
  const by = select<ColourBy>(
    "colour-by",
    "Colour by",
    Object.entries(kColourTitles) as [ColourBy, string][],
    "branch",
    value => store.set({ scene: { colourBy: value } }),
  );
  const opacity = slider("opacity", "Opacity of all vessels", [0.05, 1, 0.05], 1, value =>
    store.set({ selection: { allOpacity: value } }),
  );
  const sides = (["A", "P", "L", "R", "S", "I"] as const).map(side =>
    button(
      {
        text: side,
        label: `Look from ${{ A: "the front", P: "the back", L: "the left", R: "the right", S: "above", I: "below" }[side]}`,
        id: `look-${side}`,
        class: "button side",
      },
      () => actions.lookFrom(side),
    ),
  );
  const clip = checkbox(
    "clip",
    "Clip at crosshair",
    "Cut away what is nearer than the plane through the crosshair  (C)",
    false,
    on => store.set({ scene: { clip: { ...store.get().scene.clip, on } } }),
  );
  const flip = checkbox("clip-flip", "Other side", "Cut away the other side", false, on =>
    store.set({ scene: { clip: { ...store.get().scene.clip, flip: on } } }),
  );
  store.watch(["scene.layers"], view => {
    for (const { name, element } of boxes) element.querySelector("input")!.checked = view.scene.layers[name];
  });
  store.watch(["scene.clip"], view => {
    clip.querySelector("input")!.checked = view.scene.clip.on;
    flip.querySelector("input")!.checked = view.scene.clip.flip;
  });
  store.watch(["selection.allOpacity"], view => {
    opacity.value = String(view.selection.allOpacity);
  });
  store.watch(
    ["scene.colourBy", "document.tree", "document.surface", "document.distance", "document.state"],
    view => {
      by.value = view.scene.colourBy;
      for (const option of by.options)
        option.disabled =
          option.value !== "branch" &&
          (option.value === "compare"
            ? !view.document.state.has_truth
            : numbersOf(view, option.value as ColourBy) === null);
    },
  );
  return section(
    "section-scene",
    "3D view",
    true,
    h("label", { class: "line" }, "Colour by", by),
    h("label", { class: "line" }, "Opacity", opacity),
    h("div", { class: "checks" }, ...boxes.map(b => b.element)),
    h("div", { class: "row" }, clip, flip),
    h(
      "div",
      { class: "row sides", role: "group", "aria-label": "Look from" },
      h("span", { class: "lead" }, "From"),
      ...sides,
      button(
        { text: "∥", label: "Parallel projection or perspective", id: "parallel", class: "button side" },
        () => actions.parallel(),
      ),
    ),
  );
}

function planesSection(app: CursorPart): HTMLElement {
  const { store } = app;
  const planes = select<Planes>(
    "planes",
    "Planes of the slices",
    [
      ["patient", "Patient axes"],
      ["vessel", "Across the vessel"],
      ["free", "Oblique"],
    ],
    "patient",
    value => {
      if (value === "patient") resetPlanes(app);
      else if (value === "vessel") followVessel(app);
      else store.set({ slices: { planes: "free" } });
    },
  );
  const turns = (["right", "up", "normal"] as const).map((axis, i) =>
    slider(
      `turn-${axis}`,
      `Turn the planes about ${["left-right", "front-back", "head-feet"][i]}`,
      [-90, 90, 1],
      0,
      () => undefined,
    ),
  );
  const at = [0, 0, 0];
  turns.forEach((field, i) =>
    field.addEventListener("input", () => {
      const value = Number(field.value),
        axis = store.get().slices.frame[(["right", "up", "normal"] as const)[i]];
      turnPlanes(app, axis, ((value - at[i]) * Math.PI) / 180);
      at[i] = value;
    }),
  );
  store.watch(["slices.planes"], view => {
    planes.value = view.slices.planes;
    if (view.slices.planes !== "free")
      turns.forEach((field, i) => {
        field.value = "0";
        at[i] = 0;
      });
  });
  return section(
    "section-planes",
    "Slices",
    false,
    h("label", { class: "line" }, "Planes", planes),
    ...turns.map((field, i) => h("label", { class: "line" }, ["Turn L–R", "Turn A–P", "Turn S–I"][i], field)),
  );
}
