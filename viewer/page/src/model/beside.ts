// SPDX-License-Identifier: Apache-2.0
/** A second volume beside the first: blended over it in all slices, or to the right of a line that can be dragged. */
import type { Volume } from "../case/volume";

type BesideMode = "off" | "blend" | "split";
export interface Beside {
  mode: BesideMode;
  /** Of a blend, the share of the second volume; of a split, that of a view's width which the first has. In [0, 1]. */
  share: number;
  /** Whether a blend shows the second volume in warm colours, or grey as the first. */
  warm: boolean;
}
export const kNoBeside: Beside = { mode: "blend", share: 0.5, warm: true };

export const kBesideModes: [BesideMode, string][] = [
  ["off", "Not shown"],
  ["blend", "Blended over"],
  ["split", "Side by side"],
];

/** Whether a value of another program is one. */
export const isBeside = (x: Beside): boolean =>
  kBesideModes.some(([mode]) => mode === x.mode) && x.share >= 0 && x.share <= 1;

/** The volumes that are there, and how they are seen. */
interface Both {
  document: { volume: Volume | null; second: Volume | null };
  slices: { beside: Beside };
}

/** Whether both volumes are in the slices. */
export const showsSecond = ({ document, slices }: Both): boolean =>
  document.volume !== null && document.second !== null && slices.beside.mode !== "off";

/** The drawing of the second volume: opacity, the place in [-1, 1] across the view where it begins, and its colours. */
export function drawingOf({ mode, share, warm }: Beside): { alpha: number; from: number; warm: boolean } {
  return mode === "split" ? { alpha: 1, from: 2 * share - 1, warm: false } : { alpha: share, from: -1, warm };
}

/** Whether the second volume alone is seen at a share of a view's width. */
export const isSecondAt = (view: Both, across: number): boolean =>
  showsSecond(view) && view.slices.beside.mode === "split" && across > view.slices.beside.share;
