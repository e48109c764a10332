// SPDX-License-Identifier: Apache-2.0
/** The volume and the one beside it: window, presets, histogram, and how both are seen together. */
import { kBesideModes, type Beside } from "../model/beside";
import { kFirst, kSecond, type Part, type Cast, type View, type VolumeKeys } from "../model/model";
import { brief, button, checkbox, h, section, select, slider } from "../base/ui";
import type { Volume } from "../case/volume";

/** Windows by which CT is usually read, in Hounsfield units: the usual centre and width. */
export const kPresets: readonly { name: string; title: string; centre: number; width: number }[] = [
  { name: "bone", title: "CT bone", centre: 400, width: 1800 },
  { name: "lung", title: "CT lung", centre: -600, width: 1500 },
  { name: "vessel", title: "CT vessel", centre: 300, width: 600 },
  { name: "brain", title: "CT brain", centre: 40, width: 80 },
  { name: "abdomen", title: "CT abdomen", centre: 40, width: 400 },
];

export function windowOf(name: string): [number, number] | null {
  const preset = kPresets.find(each => each.name === name);
  return preset === undefined ? null : [preset.centre - preset.width / 2, preset.centre + preset.width / 2];
}

/** The name of the preset that has this window; empty: none. */
export function presetOf(window: readonly [number, number]): string {
  return kPresets.find(({ name }) => windowOf(name)!.every((x, i) => x === window[i]))?.name ?? "";
}

const setWindow = (app: Part<"slices">, keys: VolumeKeys, window: [number, number]): void =>
  app.store.set({ slices: { [keys.window]: window } });

/** A name and a geometry for people. */
function aboutVolume({ meta: m }: Volume): string {
  const reduced = m.reduction.some(r => r > 1) ? `, shown reduced by ${m.reduction.join(" × ")}` : "";
  return `${m.name}: ${m.source_size.join(" × ")} voxels of ${m.spacing_mm.map((s, i) => brief(s / (m.reduction[i] || 1))).join(" × ")} mm${reduced}`;
}

export function volumeSection(app: Part<"document" | "slices" | "scene" | "page">): HTMLElement {
  const { store } = app;
  const cast = select<Cast>(
    "cast",
    "The volume in the 3D view",
    [
      ["off", "Not in 3D"],
      ["mip", "Projection (MIP)"],
      ["volume", "Volume"],
    ],
    "off",
    value => store.set({ scene: { cast: value } }),
  );
  const smooth = checkbox(
    "interpolate",
    "Smooth voxels",
    "Interpolate between voxels in the slices",
    true,
    on => store.set({ slices: { interpolate: on } }),
  );
  store.watch(["scene.cast"], view => {
    cast.value = view.scene.cast;
  });
  const { range, plot, preset, about } = windowControls(app, kFirst, "");
  const box = section(
    "section-volume",
    "Volume",
    true,
    range,
    plot,
    h("div", { class: "row" }, cast, smooth),
    preset,
    about,
  );
  store.watch(["document.volume"], view => {
    box.hidden = view.document.volume === null;
  });
  return box;
}

/** The volume beside the first: how it is seen, its own window, and what speaks against seeing both at one place. */
export function secondSection(app: Part<"document" | "slices" | "page", "inform">): HTMLElement {
  const { store } = app,
    change = (to: Partial<Beside>): void =>
      store.set({ slices: { beside: { ...store.get().slices.beside, ...to } } });
  const mode = select(
      "beside-mode",
      "The second volume in the slices",
      kBesideModes,
      store.get().slices.beside.mode,
      value => change({ mode: value }),
    ),
    share = slider("beside-share", "Share of the second volume", [0, 1, 0.01], 0.5, value =>
      change({ share: value }),
    ),
    shareTitle = h("span", {}, "Share"),
    shareLine = h("label", { class: "line" }, shareTitle, share),
    warm = checkbox(
      "beside-warm",
      "Warm colours",
      "The second volume from black over orange to white, instead of grey",
      true,
      on => change({ warm: on }),
    ),
    doubt = h("p", { class: "warning", id: "second-doubt", role: "alert" });
  const { range, plot, preset, about } = windowControls(app, kSecond, "second-");
  const box = section(
    "section-second",
    "Second volume",
    true,
    doubt,
    h("div", { class: "row" }, mode, warm),
    shareLine,
    range,
    plot,
    preset,
    about,
    h(
      "p",
      { class: "hint" },
      "Each volume is where its file places it. No file states whether both are of one patient.",
    ),
  );
  store.watch(["slices.beside"], ({ slices: { beside } }) => {
    const isSplit = beside.mode === "split";
    mode.value = beside.mode;
    share.value = String(beside.share);
    shareTitle.textContent = isSplit ? "Line" : "Share";
    share.title = isSplit ? "Where the second volume begins" : "Share of the second volume";
    share.setAttribute("aria-label", share.title);
    shareLine.hidden = beside.mode === "off";
    warm.hidden = beside.mode !== "blend";
    warm.querySelector("input")!.checked = beside.warm;
  });
  store.watch(["document.second"], view => {
    const isNew = box.hidden && view.document.second !== null;
    box.hidden = view.document.second === null;
    if (isNew) box.scrollIntoView({ block: "nearest" });
  });
  let said: string | null = null;
  store.watch(["document.state"], ({ document: { state } }) => {
    const now = state.second?.doubt ?? null;
    doubt.hidden = now === null;
    doubt.textContent = now === null ? "" : `${now}.`;
    if (now !== null && now !== said) app.inform(`${now}.`, "warning");
    said = now;
  });
  return box;
}

/** The controls of a volume's window. `prefix`: of their ids. */
function windowControls(
  app: Part<"document" | "slices" | "page">,
  keys: VolumeKeys,
  prefix: string,
): Record<"range" | "plot" | "preset" | "about", HTMLElement> {
  const { store } = app,
    plot = h("canvas", { class: "histogram", id: `${prefix}histogram`, "aria-hidden": "true" }),
    about = h("p", { class: "hint", id: `${prefix || "volume-"}about` });
  const { range, low, high } = windowFields(app, keys, prefix);
  const preset = select<string>(
    `${prefix}window-preset`,
    "Window for CT, in Hounsfield units",
    [["", "Window…"], ...kPresets.map(({ name, title }): [string, string] => [name, title])],
    "",
    name => {
      const window = windowOf(name);
      if (window !== null) setWindow(app, keys, window);
    },
  );
  let drawn: Volume | null = null,
    counts: ReturnType<Volume["histogram"]> | null = null;
  const draw = (view: Pick<View, "document" | "slices">): void => {
    const volume = view.document[keys.volume],
      window = view.slices[keys.window];
    low.value = brief(window[0]);
    high.value = brief(window[1]);
    preset.value = presetOf(window);
    if (volume !== null && view.document[keys.ready] >= volume.size[2] && drawn !== volume) {
      drawn = volume;
      counts = volume.histogram(128);
    }
    if (counts !== null && volume !== null) drawHistogram(plot, counts, window);
  };
  store.watch([`document.${keys.volume}`], view => {
    const volume = view.document[keys.volume];
    about.textContent = volume === null ? "" : aboutVolume(volume);
  });
  store.watch(
    [`document.${keys.volume}`, `document.${keys.ready}`, `slices.${keys.window}`, "page.theme"],
    draw,
  );
  dragWindow(plot, app, keys, () => counts);
  return { range, plot, preset: h("label", { class: "line" }, "CT", preset), about };
}

/** Two fields for the edges of a window, and a button for the window that the volume came with. */
function windowFields(
  app: Part<"document" | "slices">,
  keys: VolumeKeys,
  prefix: string,
): { range: HTMLElement; low: HTMLInputElement; high: HTMLInputElement } {
  const { store } = app,
    whose = keys === kFirst ? "" : " of the second volume";
  const number = (id: string, label: string, which: 0 | 1): HTMLInputElement => {
    const field = h("input", { type: "number", id, "aria-label": label, title: label, step: "any" });
    field.addEventListener("change", () => {
      const window: [number, number] = [...store.get().slices[keys.window]];
      window[which] = Number(field.value);
      if (Number.isFinite(window[which]) && window[0] < window[1]) setWindow(app, keys, window);
      else field.value = brief(store.get().slices[keys.window][which]);
    });
    return field;
  };
  const low = number(`${prefix}window-low`, `Darkest intensity${whose}`, 0),
    high = number(`${prefix}window-high`, `Brightest intensity${whose}`, 1);
  const range = h(
    "div",
    { class: "row" },
    low,
    h("span", {}, "to"),
    high,
    button(
      {
        text: "Auto",
        label: `The window that the ${keys === kFirst ? "volume" : "second volume"} came with`,
        id: `${prefix}window-auto`,
        class: "button text",
      },
      () => {
        const volume = store.get().document[keys.volume];
        if (volume !== null) setWindow(app, keys, volume.meta.window as [number, number]);
      },
    ),
  );
  return { range, low, high };
}

/** Moves the nearer edge of the window with the pointer. */
function dragWindow(
  plot: HTMLCanvasElement,
  app: Part<"slices">,
  keys: VolumeKeys,
  counts: () => { low: number; high: number } | null,
): void {
  const to = (e: PointerEvent): void => {
    const c = counts(),
      box = plot.getBoundingClientRect();
    if (c === null) return;
    const x = c.low + ((e.clientX - box.left) / box.width) * (c.high - c.low),
      [a, b] = app.store.get().slices[keys.window];
    setWindow(app, keys, Math.abs(x - a) < Math.abs(x - b) ? [Math.min(x, b), b] : [a, Math.max(a, x)]);
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
