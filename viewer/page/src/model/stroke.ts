// SPDX-License-Identifier: Apache-2.0
/** A stroke of the brush, and where it takes the outlines of a wall: what is shown before the wall is fitted anew. */
import type { Tree } from "../case/tree";
import type { Vec3 } from "../base/types";
import { along, dot, length, scale, sub } from "../base/vec";

export interface Stroke {
  /** Near which the wall moves. */
  node: number;
  /** Where the stroke begins, mm. */
  at: Vec3;
  /** mm, the way of the wall there. */
  by: Vec3;
  /** Of the brush, mm. */
  radius: number;
}

/** Share of its distance from the axis that a point keeps, as the server moves wall points. */
const kNearest = 0.25;

/** The place to which a stroke takes a point of the wall whose vessel has that centre and direction there; the same
 * rule as the server's. */
export function pushed(p: Vec3, centre: Vec3, axis: Vec3, stroke: Stroke): Vec3 {
  const away = length(sub(p, stroke.at)) / stroke.radius;
  if (away >= 1) return p;
  let way = scale(stroke.by, (1 - away * away) ** 2);
  const from = sub(p, centre),
    across = along(from, axis, -dot(from, axis)),
    distance = length(across),
    inwards = distance > 0 ? -dot(way, across) / distance : 0,
    most = (1 - kNearest) * distance;
  if (inwards > most) way = scale(way, most / inwards);
  return along(p, way, 1);
}

/** The branch of a node, the one that it leaves, and those that leave it: walls that a stroke can move. */
export function branchesAt(tree: Tree, node: number): Set<number> {
  const own = tree.branch[node],
    { parent_node: parentNode } = tree.branches[own],
    found = new Set([own]);
  if (parentNode >= 0) found.add(tree.branch[parentNode]);
  for (const branch of tree.branches)
    if (branch.parent_node >= 0 && tree.branch[branch.parent_node] === own) found.add(branch.index);
  return found;
}
