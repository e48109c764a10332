// SPDX-License-Identifier: Apache-2.0
/** The distances of a mesh's vertices from the wall of the case, and the colours that show them. */
import { usualRange, type MapName } from "../base/colour";
import { mm } from "../base/ui";
import type { Pack } from "./pack";

export interface Deviation {
  /** Name of the mesh. */
  name: string;
  /** Of each vertex to the wall, mm; negative in the lumen. */
  distance: Float32Array;
  /** Of the absolute distances, mm. */
  median: number;
  percentile90: number;
}

/** Blue in the lumen, red outside of it, white on the wall. */
export const kDeviationMap: MapName = "diverging";

/** Reads the distances of a mesh with the stated number of vertices. Throws if the answer is that of another mesh. */
export function deviationOf(pack: Pack, name: string, vertices: number): Deviation {
  const distance = pack.get("distance_mm", "f32"),
    { median_mm: median, percentile90_mm: percentile90 } = pack.meta.figures as Record<string, unknown>;
  if (distance.length !== vertices || typeof median !== "number" || typeof percentile90 !== "number")
    throw new Error(`${name}: its distances are those of another mesh.`);
  return { name, distance, median, percentile90 };
}

/** One range for all of them, so that a colour means one distance. */
export function sharedRange(all: readonly Deviation[]): [number, number] {
  const most = Math.max(...all.map(each => usualRange(each.distance, true)[1]));
  return [-most, most];
}

export const deviationText = (deviation: Deviation): string =>
  `median ${mm(deviation.median)}, 90 % within ${mm(deviation.percentile90)}`;
