// SPDX-License-Identifier: Apache-2.0
/** Slabs: a slice that shows the brightest, the darkest or the mean voxel through a thickness. */
import type { App, View } from "./model";
import type { SliceName, SliceProjection } from "./slice_frame";
import type { Vec3 } from "./types";
import { h, select } from "./ui";
import { along, type Frame } from "./vec";
import type { Volume } from "./volume";

export type SlabKind = "off" | "max" | "min" | "mean";
export interface Slab {
  kind: SlabKind;
  /** Thickness, half of it on either side of the plane. */
  mm: number;
}
export type Slabs = Readonly<Record<SliceName, Slab>>;

const kKinds: [SlabKind, string][] = [
  ["off", "Slice"],
  ["max", "Maximum"],
  ["min", "Minimum"],
  ["mean", "Mean"],
];
const kNames: SliceName[] = ["axial", "coronal", "sagittal"];
const kUsual = 10, // mm
  kMinThickness = 0.5,
  kMaxThickness = 200,
  kStep = 1.25; // factor from one thickness to the next
/** Places along a ray at most: beyond, a picture in software takes longer than a moment. */
export const kMostSamples = 129;

const kNone: Slab = { kind: "off", mm: kUsual };
export const kNoSlabs: Slabs = { axial: kNone, coronal: kNone, sagittal: kNone };

/** Places along the thickness of a slab: half a voxel apart, and farther where these would be too many. */
export function samplesOf(slab: Slab, spacing: Vec3): number {
  if (slab.kind === "off") return 1;
  return Math.min(kMostSamples, 2 * Math.ceil(slab.mm / Math.min(...spacing)) + 1);
}

/** The place that a slab shows where its middle plane is at `p`: the brightest along its normal, the darkest of a minimum.
 * Without a slab, and where the volume has nothing, `p` itself. */
export function pickInSlab(volume: Volume | null, slab: Slab, p: Vec3, normal: Vec3): Vec3 {
  if (volume === null || slab.kind === "off") return p;
  const samples = samplesOf(slab, volume.spacing),
    sign = slab.kind === "min" ? -1 : 1;
  let best = p,
    most = -Infinity;
  for (let i = 0; i < samples; ++i) {
    const at = along(p, normal, (i / (samples - 1) - 0.5) * slab.mm),
      value = sign * volume.sample(at);
    if (value > most) {
      most = value;
      best = at;
    }
  }
  return best;
}

/** Whether a value of another program is one for all slices. */
export const areSlabs = (slabs: Slabs): boolean =>
  kNames.every(name => kKinds.some(([kind]) => kind === slabs[name].kind) && slabs[name].mm > 0);

/** The depth of a slice on either side of its plane, mm: of its slab, at least `thin`. */
export const reachOf = (
  view: Pick<View, "slabs">,
  slice: Pick<SliceProjection, "name">,
  thin: number,
): number => {
  const { kind, mm } = view.slabs[slice.name];
  return kind === "off" ? thin : Math.max(thin, mm / 2);
};

export const throughOf = (slab: Slab, frame: Frame): Vec3 =>
  frame.normal.map(x => (slab.kind === "off" ? 0 : (x * slab.mm) / 2)) as Vec3;

const within = (mm: number): number => Math.min(kMaxThickness, Math.max(kMinThickness, mm));

/** Changes the slabs of the named slices; of all without a name. */
function change(app: App, name: SliceName | null, to: (slab: Slab) => Slab): void {
  const { slabs } = app.store.get();
  app.store.set({
    slabs: Object.fromEntries(
      kNames.map(each => [each, name === null || name === each ? to(slabs[each]) : slabs[each]]),
    ) as unknown as Slabs,
  });
}
/** Slice, maximum, minimum, mean, and the slice again; all slices follow the first of them. */
export function nextKind(app: App, name: SliceName | null): void {
  const now = app.store.get().slabs[name ?? "axial"].kind,
    next = kKinds[(kKinds.findIndex(([kind]) => kind === now) + 1) % kKinds.length][0];
  change(app, name, slab => ({ ...slab, kind: next }));
}
/** Makes slabs thinner (-1) or thicker (1). */
export function thicken(app: App, name: SliceName | null, way: 1 | -1): void {
  change(app, name, slab => ({
    kind: slab.kind === "off" ? "max" : slab.kind,
    mm: Number(within(slab.mm * kStep ** way).toPrecision(2)),
  }));
}
/** The keys of slabs; false for another key. Without a name they act on all slices. */
export function slabKey(app: App, name: SliceName | null, key: string): boolean {
  if (key === "7") nextKind(app, name);
  else if (key === "8") thicken(app, name, -1);
  else if (key === "9") thicken(app, name, 1);
  else return false;
  return true;
}

/** The control of a slice. */
export function slabControl(app: App, name: SliceName): HTMLElement {
  const kind = select(
    `slab-${name}`,
    `${name.charAt(0).toUpperCase()}${name.slice(1)}: one plane, or a slab of a thickness  (7)`,
    kKinds,
    "off",
    value => change(app, name, slab => ({ ...slab, kind: value })),
  );
  const mm = h("input", {
    type: "number",
    id: `slab-${name}-mm`,
    class: "slabmm",
    min: kMinThickness,
    max: kMaxThickness,
    step: 0.5,
    "aria-label": `Thickness of the ${name} slab, mm`,
    title: "Thickness, mm  (8 and 9)",
  });
  mm.addEventListener("change", () => {
    const wanted = Number(mm.value);
    if (wanted > 0) change(app, name, slab => ({ ...slab, mm: within(wanted) }));
    else mm.value = String(app.store.get().slabs[name].mm);
  });
  app.store.watch(["slabs"], ({ slabs }) => {
    const slab = slabs[name];
    kind.value = slab.kind;
    mm.value = String(slab.mm);
    mm.hidden = slab.kind === "off";
  });
  const box = h("div", { class: "slab" }, kind, mm);
  for (const event of ["pointerdown", "dblclick", "wheel"])
    box.addEventListener(event, e => e.stopPropagation());
  box.addEventListener("keydown", e => {
    if (!e.ctrlKey && e.key !== "Escape") e.stopPropagation(); // arrows choose here
  });
  return box;
}
