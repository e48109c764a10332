// SPDX-License-Identifier: Apache-2.0
/** The one length of vessels (docs/measures.md, section 2) in a page without a server: along the smoothed axis, from where the
 * vessel leaves its parent's lumen, as converters/judge/measure/vessel_length.cpp has it. */
import type { BranchRecord, Vec3 } from "../base/types";
import { at, distance, dot, sub } from "../base/vec";
import { SmoothAxis } from "./smooth_axis";

const kNearestRadii = 0.1, // between nodes of an axis
  kLeavingRadii = 0.1, // step of the search for the parent's wall
  kMostLeaving = 1000, // steps of that search along an axis
  kHalvings = 10; // of the last step

export interface Nodes {
  centre: Float32Array<ArrayBuffer>; // x y z of each, mm, LPS
  radius: Float32Array<ArrayBuffer>; // mm
  parent: Int32Array<ArrayBuffer>; // -1: none
  branch: Uint32Array<ArrayBuffer>;
}

function median(values: readonly number[]): number {
  const sorted = [...values].sort((a, b) => a - b),
    n = sorted.length;
  return 0.5 * (sorted[(n - 1) >> 1] + sorted[n >> 1]);
}

/** mm from a node's parent; of a branch's first node, outside of the parent's ball. */
function edgeOf({ centre, radius, parent, branch }: Nodes, node: number): number {
  const from = parent[node];
  if (from < 0) return 0;
  const apart = distance(at(centre, from), at(centre, node));
  return branch[from] === branch[node] ? apart : Math.max(0, apart - radius[from]);
}

/** Whether a point lies in the convex hull of two balls. */
function isInCone(p: Vec3, a: Vec3, radiusA: number, b: Vec3, radiusB: number): boolean {
  const apart = distance(a, b);
  if (distance(p, a) < radiusA || distance(p, b) < radiusB) return true;
  if (apart <= Math.abs(radiusA - radiusB)) return false;
  const v = sub(p, a),
    x = dot(v, sub(b, a)) / apart,
    y = Math.sqrt(Math.max(0, dot(v, v) - x * x)),
    sine = (radiusA - radiusB) / apart,
    cosine = Math.sqrt((1 - sine) * (1 + sine)),
    foot = x - (y * sine) / cosine;
  return foot > 0 && foot < apart && sine * x + cosine * y < radiusA;
}

/** Arc length where an axis leaves the tube of a branch; its whole length if it never does. */
function leavingPlace(axis: SmoothAxis, { centre, radius }: Nodes, of: BranchRecord, own: number): number {
  const last = of.first_node + of.node_count - 1;
  const isInside = (along: number): boolean => {
    const p = axis.at(along);
    for (let n = of.first_node; n < last || n === of.first_node; ++n) {
      const next = Math.min(n + 1, last);
      if (isInCone(p, at(centre, n), radius[n], at(centre, next), radius[next])) return true;
    }
    return false;
  };
  if (!isInside(0)) return 0;
  const step = Math.max(kLeavingRadii * own, axis.length / kMostLeaving);
  let inside = 0,
    outside = step;
  for (; outside < axis.length && isInside(outside); outside += step) inside = outside;
  if (outside >= axis.length) return axis.length;
  for (let i = 0; i < kHalvings; ++i) {
    const middle = 0.5 * (inside + outside);
    if (isInside(middle)) inside = middle;
    else outside = middle;
  }
  return outside;
}

/** Nodes of a branch through which its axis goes: a tenth of a radius from the one before, and the last. */
function nodesOfAxis(
  { centre, radius }: Nodes,
  { first_node: first, node_count: count }: BranchRecord,
): number[] {
  const kept: number[] = [];
  for (let n = first; n < first + count; ++n) {
    const before = kept.at(-1);
    if (before !== undefined) {
      const from = distance(at(centre, before), at(centre, n)),
        least = kNearestRadii * Math.max(radius[n], radius[before]);
      if (!(from > 0) || (from < least && n !== first + count - 1)) continue;
    }
    kept.push(n);
  }
  return kept;
}

/** By node, mm: the part of its branch from the node before it. Zero within the parent's lumen. Along edges for an aneurysm, and for a
 * vessel whose nodes lie at one place. */
export function edgeLengths(nodes: Nodes, branches: readonly BranchRecord[]): Float64Array {
  const edge = new Float64Array(nodes.radius.length);
  for (const branch of branches) {
    const kept = branch.kind === "aneurysm" ? [] : nodesOfAxis(nodes, branch);
    if (kept.length < 2) {
      for (let n = branch.first_node; n < branch.first_node + branch.node_count; ++n)
        edge[n] = edgeOf(nodes, n);
      continue;
    }
    const radii = kept.map(n => nodes.radius[n]),
      axis = new SmoothAxis(
        kept.map(n => at(nodes.centre, n)),
        radii,
      ),
      parent = branch.parent_node < 0 ? null : branches[nodes.branch[branch.parent_node]],
      begin = parent === null ? 0 : leavingPlace(axis, nodes, parent, median(radii)),
      gap = parent !== null && begin === 0 ? edgeOf(nodes, branch.first_node) : 0;
    let before = 0;
    kept.forEach((node, i) => {
      const along = Math.max(0, gap + axis.alongOf(i) - begin);
      edge[node] = along - before;
      before = along;
    });
  }
  return edge;
}
