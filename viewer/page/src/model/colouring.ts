// SPDX-License-Identifier: Apache-2.0
/** The meaning of the surface's colours. */
import { usualRange, type MapName } from "../base/colour";
import type { ColourBy, View } from "./model";

interface Colouring {
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
  view: Pick<View, "document">,
  by: ColourBy,
): { nodes: ArrayLike<number> } | { vertices: Float32Array } | null {
  const { tree, surface } = view.document;
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
      return view.document.distance?.length !== surface.radius.length
        ? null
        : { vertices: view.document.distance };
    default:
      return null;
  }
}

const ranges = new WeakMap<object, Map<string, [number, number]>>();

/** The range of numbers that the map spans, kept as long as the surface. */
function rangeOf(view: Pick<View, "document" | "scene">): [number, number] {
  const numbers = numbersOf(view, view.scene.colourBy);
  if (numbers === null || view.document.surface === null) return [0, 1];
  let kept = ranges.get(view.document.surface);
  if (kept === undefined) ranges.set(view.document.surface, (kept = new Map()));
  const key =
    view.scene.colourBy +
    (view.scene.colourBy === "compare" ? String(view.document.state.revisions.distance) : "");
  let range = kept.get(key);
  if (range === undefined) {
    if (view.scene.colourBy === "confidence") range = [0, 1];
    else
      range = usualRange(
        "nodes" in numbers ? numbers.nodes : numbers.vertices,
        view.scene.colourBy === "compare",
      );
    kept.set(key, range);
  }
  return range;
}

export function colouring(view: Pick<View, "document" | "scene">): Colouring {
  const mapped = view.scene.colourBy !== "branch" && numbersOf(view, view.scene.colourBy) !== null;
  return {
    mapped,
    range: rangeOf(view),
    map: view.scene.colourBy === "compare" ? "diverging" : "sequential",
    title: kColourTitles[view.scene.colourBy],
    unit: view.scene.colourBy === "confidence" || view.scene.colourBy === "branch" ? "" : "mm",
  };
}

/** Puts the numbers of the present choice into the surface. */
export function fillValues(view: Pick<View, "document" | "scene">): void {
  const numbers = numbersOf(view, view.scene.colourBy);
  if (view.document.surface === null || numbers === null) return;
  if ("nodes" in numbers) view.document.surface.fromNodes(numbers.nodes);
  else view.document.surface.fromVertices(numbers.vertices);
}
