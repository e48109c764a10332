// SPDX-License-Identifier: Apache-2.0
/** The label map of the volume in the slices: colours of labels, how they are drawn, and the label of a place. */
import { branchColour, systemColour, type Rgb } from "../base/colour";
import type { Label, State, Vec3 } from "../base/types";
import type { Volume } from "../case/volume";

type LabelMode = "off" | "fill" | "outline";
export interface LabelLook {
  mode: LabelMode;
  /** In [0, 1]. */
  opacity: number;
}
export const kUsualLabels: LabelLook = { mode: "fill", opacity: 0.4 };

export const kLabelModes: [LabelMode, string][] = [
  ["fill", "Filled"],
  ["outline", "Outlines"],
  ["off", "Not shown"],
];

/** Whether a value of another program is one. */
export const isLabelLook = (x: LabelLook): boolean =>
  kLabelModes.some(([mode]) => mode === x.mode) && x.opacity >= 0 && x.opacity <= 1;

export const nameOf = ({ name, value }: Label): string => name ?? `label ${value}`;

/** The colour of the label at a place of the list: of the system of vessels that its role states, or of its place. */
export const labelColour = ({ role }: Label, place: number): Rgb =>
  systemColour(role, place) ?? branchColour(place);

/** RGBA of each place, counted from 1; without opacity for what is around labels and those that are hidden. */
export function labelPalette(labels: readonly Label[], hidden: ReadonlySet<number>): Uint8Array {
  const palette = new Uint8Array(4 * (labels.length + 1));
  labels.forEach((label, i) => {
    const colour = labelColour(label, i + 1).map(x => Math.round(255 * x));
    if (!hidden.has(label.value)) palette.set([...colour, 255], 4 * (i + 1));
  });
  return palette;
}

/** The label of the voxel that holds a position; null where there is none. */
export function labelAt(
  { labels, state }: { labels: Volume | null; state: Pick<State, "labels"> },
  p: Vec3,
): Label | null {
  const place = labels?.nearest(p) ?? 0;
  return state.labels?.list[place - 1] ?? null;
}

/** The middle of the voxel of a label that is nearest to the mean of them all; null if it has none. */
export function middleOf(labels: Volume, place: number): Vec3 | null {
  const [nx, ny] = labels.size,
    mean = [0, 0, 0],
    each = (call: (i: Vec3) => void): void =>
      labels.voxel.forEach((stored, at) => {
        if (stored === place) call([at % nx, Math.floor(at / nx) % ny, Math.floor(at / (nx * ny))]);
      });
  let count = 0,
    best: Vec3 | null = null,
    least = Infinity;
  each(i => {
    ++count;
    i.forEach((x, a) => (mean[a] += x));
  });
  each(i => {
    const away = i.reduce((sum, x, a) => sum + (x - mean[a] / count) ** 2, 0);
    if (away < least) [least, best] = [away, i];
  });
  return best === null ? null : labels.position(best);
}
