// SPDX-License-Identifier: Apache-2.0
/** The meaning of the surface's colours. */
import { usualRange, type MapName } from "../base/colour";
import type { ColourBy, View } from "./model";

export interface Colouring {
  mapped: boolean;
  range: [number, number];
  map: MapName;
  title: string;
  unit: string;
}

export const kColourTitles: Record<ColourBy, string> = {
  branch: "Branch",
  radius: "Radius",
  confidence: "Confidence",
  error: "Error of fit",
  root: "Distance from root",
  compare: "Distance to truth",
};

/** The numbers of the nodes (or vertices) that a choice shows; null: none are there. */
export function numbersOf(
  view: View,
  by: ColourBy,
): { nodes: ArrayLike<number> } | { vertices: Float32Array } | null {
  const { tree, surface } = view;
  if (tree === null || surface === null) return null;
  switch (by) {
    case "radius":
      return { vertices: surface.radius };
    case "confidence":
      return tree.inlierRate === null ? null : { nodes: tree.inlierRate };
    case "error":
      return tree.error === null ? null : { nodes: tree.error };
    case "root":
      return { nodes: tree.rootDistance };
    case "compare":
      return view.distance?.length !== surface.radius.length ? null : { vertices: view.distance };
    default:
      return null;
  }
}

const ranges = new WeakMap<object, Map<string, [number, number]>>();

/** The range of numbers that the map spans, kept as long as the surface. */
function rangeOf(view: View): [number, number] {
  const numbers = numbersOf(view, view.colourBy);
  if (numbers === null || view.surface === null) return [0, 1];
  let kept = ranges.get(view.surface);
  if (kept === undefined) ranges.set(view.surface, (kept = new Map()));
  const key = view.colourBy + (view.colourBy === "compare" ? String(view.state.revisions.distance) : "");
  let range = kept.get(key);
  if (range === undefined) {
    if (view.colourBy === "confidence") range = [0, 1];
    else
      range = usualRange("nodes" in numbers ? numbers.nodes : numbers.vertices, view.colourBy === "compare");
    kept.set(key, range);
  }
  return range;
}

export function colouring(view: View): Colouring {
  const mapped = view.colourBy !== "branch" && numbersOf(view, view.colourBy) !== null;
  return {
    mapped,
    range: rangeOf(view),
    map: view.colourBy === "compare" ? "diverging" : "sequential",
    title: kColourTitles[view.colourBy],
    unit: view.colourBy === "confidence" || view.colourBy === "branch" ? "" : "mm",
  };
}

/** Puts the numbers of the present choice into the surface. */
export function fillValues(view: View): void {
  const numbers = numbersOf(view, view.colourBy);
  if (view.surface === null || numbers === null) return;
  if ("nodes" in numbers) view.surface.fromNodes(numbers.nodes);
  else view.surface.fromVertices(numbers.vertices);
}
