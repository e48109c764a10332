// SPDX-License-Identifier: Apache-2.0
/** Display settings: the volume's window, parts of the 3D view, colours. */
import { kColourTitles, numbersOf } from "./colouring";
import type { Actions } from "./actions";
import type { App, Cast, ColourBy, Layers, Planes, View } from "./model";
import { followVessel } from "./selection";
import { resetPlanes, turnPlanes } from "./slice_input";
import { brief, button, checkbox, h, section, select, slider } from "./ui";
import type { Volume } from "./volume";
import { kPresets, presetOf, windowOf } from "./window_presets";

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

export function displayPanel(app: App, actions: Actions): HTMLElement[] {
  return [volumeSection(app), sceneSection(app, actions), planesSection(app)];
}

function volumeSection(app: App): HTMLElement {
  const { store } = app,
    plot = h("canvas", { class: "histogram", id: "histogram", "aria-hidden": "true" });
  const number = (id: string, label: string, which: 0 | 1): HTMLInputElement => {
    const field = h("input", { type: "number", id, "aria-label": label, title: label, step: "any" });
    field.addEventListener("change", () => {
      const window: [number, number] = [...store.get().window];
      window[which] = Number(field.value);
      if (Number.isFinite(window[which]) && window[0] < window[1]) store.set({ window });
      else field.value = brief(store.get().window[which]);
    });
    return field;
  };
  const low = number("window-low", "Darkest intensity", 0),
    high = number("window-high", "Brightest intensity", 1);
  const cast = select<Cast>(
    "cast",
    "The volume in the 3D view",
    [
      ["off", "Not in 3D"],
      ["mip", "Projection (MIP)"],
      ["volume", "Volume"],
    ],
    "off",
    value => store.set({ cast: value }),
  );
  const smooth = checkbox(
    "interpolate",
    "Smooth voxels",
    "Interpolate between voxels in the slices",
    true,
    on => store.set({ interpolate: on }),
  );
  const preset = select<string>(
    "window-preset",
    "Window for CT, in Hounsfield units",
    [["", "Window…"], ...kPresets.map(({ name, title }): [string, string] => [name, title])],
    "",
    name => {
      const window = windowOf(name);
      if (window !== null) store.set({ window });
    },
  );
  const about = h("p", { class: "hint", id: "volume-about" });
  const box = section(
    "section-volume",
    "Volume",
    true,
    h(
      "div",
      { class: "row" },
      low,
      h("span", {}, "to"),
      high,
      button(
        {
          text: "Auto",
          label: "The window that the volume came with",
          id: "window-auto",
          class: "button text",
        },
        () => {
          const { volume } = store.get();
          if (volume !== null) store.set({ window: volume.meta.window as [number, number] });
        },
      ),
    ),
    plot,
    h("div", { class: "row" }, cast, smooth),
    h("label", { class: "line" }, "CT", preset),
    about,
  );
  let drawn: Volume | null = null,
    counts: ReturnType<Volume["histogram"]> | null = null;
  const draw = (view: View): void => {
    low.value = brief(view.window[0]);
    high.value = brief(view.window[1]);
    cast.value = view.cast;
    preset.value = presetOf(view.window);
    if (view.volume !== null && view.volumeReady >= view.volume.size[2] && drawn !== view.volume) {
      drawn = view.volume;
      counts = view.volume.histogram(128);
    }
    if (counts !== null && view.volume !== null) drawHistogram(plot, counts, view.window);
  };
  store.watch(["volume"], view => {
    box.hidden = view.volume === null;
    const m = view.volume?.meta;
    about.textContent =
      m === undefined
        ? ""
        : `${m.name}: ${m.sourceSize.join(" × ")} voxels of ${m.spacing.map((s, i) => brief(s / (m.reduction[i] || 1))).join(" × ")} mm${
            m.reduction.some(r => r > 1) ? `, shown reduced by ${m.reduction.join(" × ")}` : ""
          }`;
  });
  store.watch(["volume", "volumeReady", "window", "cast", "theme"], draw);
  dragWindow(plot, app, () => counts);
  return box;
}

/** Moves the nearer edge of the window with the pointer. */
function dragWindow(
  plot: HTMLCanvasElement,
  app: App,
  counts: () => { low: number; high: number } | null,
): void {
  const to = (e: PointerEvent): void => {
    const c = counts(),
      box = plot.getBoundingClientRect();
    if (c === null) return;
    const x = c.low + ((e.clientX - box.left) / box.width) * (c.high - c.low),
      [a, b] = app.store.get().window;
    app.store.set({ window: Math.abs(x - a) < Math.abs(x - b) ? [Math.min(x, b), b] : [a, Math.max(a, x)] });
  };
  plot.addEventListener("pointerdown", e => {
    plot.setPointerCapture(e.pointerId);
    to(e);
  });
  plot.addEventListener("pointermove", e => {
    if (e.buttons === 1) to(e);
  });
}

function drawHistogram(
  plot: HTMLCanvasElement,
  counts: { low: number; high: number; counts: Uint32Array },
  window: [number, number],
): void {
  const ratio = devicePixelRatio,
    width = (plot.width = Math.max(1, plot.clientWidth * ratio)),
    height = (plot.height = Math.max(1, plot.clientHeight * ratio));
  const c = plot.getContext("2d")!,
    style = getComputedStyle(plot),
    most = Math.log(1 + Math.max(...counts.counts)),
    n = counts.counts.length;
  c.fillStyle = style.getPropertyValue("--dim");
  counts.counts.forEach((count, i) => {
    const h = (height * Math.log(1 + count)) / most;
    c.fillRect((i * width) / n, height - h, width / n + 0.5, h);
  });
  const at = (x: number): number => ((x - counts.low) / (counts.high - counts.low || 1)) * width;
  const [a, b] = window.map(at);
  c.fillStyle = style.getPropertyValue("--accent-soft");
  c.fillRect(a, 0, b - a, height);
  c.fillStyle = style.getPropertyValue("--accent");
  for (const x of [a, b]) c.fillRect(x - ratio, 0, 2 * ratio, height);
}

function sceneSection(app: App, actions: Actions): HTMLElement {
  const { store } = app;
  const boxes = kLayerTitles.map(([name, title, tip]) => ({
    name,
    element: checkbox(`layer-${name}`, title, tip, store.get().layers[name], on =>
      store.set({ layers: { ...store.get().layers, [name]: on } }),
    ),
  }));
  const by = select<ColourBy>(
    "colour-by",
    "Colour by",
    Object.entries(kColourTitles) as [ColourBy, string][],
    "branch",
    value => store.set({ colourBy: value }),
  );
  const opacity = slider("opacity", "Opacity of all vessels", [0.05, 1, 0.05], 1, value =>
    store.set({ allOpacity: value }),
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
    on => store.set({ clip: { ...store.get().clip, on } }),
  );
  const flip = checkbox("clip-flip", "Other side", "Cut away the other side", false, on =>
    store.set({ clip: { ...store.get().clip, flip: on } }),
  );
  store.watch(["layers"], view => {
    for (const { name, element } of boxes) element.querySelector("input")!.checked = view.layers[name];
  });
  store.watch(["clip"], view => {
    clip.querySelector("input")!.checked = view.clip.on;
    flip.querySelector("input")!.checked = view.clip.flip;
  });
  store.watch(["allOpacity"], view => {
    opacity.value = String(view.allOpacity);
  });
  store.watch(["colourBy", "tree", "surface", "distance", "state"], view => {
    by.value = view.colourBy;
    for (const option of by.options)
      option.disabled =
        option.value !== "branch" &&
        (option.value === "compare"
          ? !view.state.hasTruth
          : numbersOf(view, option.value as ColourBy) === null);
  });
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

function planesSection(app: App): HTMLElement {
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
      else store.set({ planes: "free" });
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
        axis = store.get().frame[(["right", "up", "normal"] as const)[i]];
      turnPlanes(app, axis, ((value - at[i]) * Math.PI) / 180);
      at[i] = value;
    }),
  );
  store.watch(["planes"], view => {
    planes.value = view.planes;
    if (view.planes !== "free")
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
