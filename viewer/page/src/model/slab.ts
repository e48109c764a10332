// SPDX-License-Identifier: Apache-2.0
/** Slabs: a slice that shows the brightest, the darkest or the mean voxel through a thickness. */
import { kSliceNames, type SliceName, type SliceProjection } from "./slice_frame";
import type { Vec3 } from "../base/types";
import { along, type Frame } from "../base/vec";
import type { Volume } from "../case/volume";

type SlabKind = "off" | "max" | "min" | "mean";
export interface Slab {
  kind: SlabKind;
  /** Thickness, half of it on either side of the plane. */
  mm: number;
}
export type Slabs = Readonly<Record<SliceName, Slab>>;

export const kSlabKinds: [SlabKind, string][] = [
  ["off", "Slice"],
  ["max", "Maximum"],
  ["min", "Minimum"],
  ["mean", "Mean"],
];
const kUsual = 10; // mm
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
  kSliceNames.every(name => kSlabKinds.some(([kind]) => kind === slabs[name].kind) && slabs[name].mm > 0);

/** The depth of a slice on either side of its plane, mm: of its slab, at least `thin`. */
export const reachOf = (
  { slices: { slabs } }: { slices: { slabs: Slabs } },
  slice: Pick<SliceProjection, "name">,
  thin: number,
): number => {
  const { kind, mm } = slabs[slice.name];
  return kind === "off" ? thin : Math.max(thin, mm / 2);
};

export const throughOf = (slab: Slab, frame: Frame): Vec3 =>
  frame.normal.map(x => (slab.kind === "off" ? 0 : (x * slab.mm) / 2)) as Vec3;
