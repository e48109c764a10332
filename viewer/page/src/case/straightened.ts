// SPDX-License-Identifier: Apache-2.0
/** The volume along a vessel, laid straight (curved planar reformation; A. Kanitsar et al., 2002): each column is a line
 * across the vessel. */
import type { Tree } from "./tree";
import type { Vec3 } from "../base/types";
import { across, along, distance, dot, mix, rotate, scale, sub, unit } from "../base/vec";
import type { Volume } from "./volume";

export interface Straight {
  path: Vec3[];
  side: Vec3[];
}

/** Points of a branch at equal steps of its length, from where it leaves its parent's lumen, each with a vector across it that does not turn about the vessel (double
 * reflection; W. Wang et al., 2008). */
export function straighten(tree: Tree, branch: number, count: number): Straight {
  const record = tree.branches[branch],
    own = tree.alongOf(record),
    nodes = own.map((_, i) => record.first_node + i),
    points = nodes.map(n => tree.position(n)),
    s = [...own];
  if (s[0] > 0) {
    const parent = tree.position(record.parent_node);
    points.unshift(mix(points[0], parent, Math.min(1, s[0] / (distance(points[0], parent) || 1)))); // at the parent's wall
    nodes.unshift(nodes[0]);
    s.unshift(0);
  }
  const whole = s.at(-1)!,
    path: Vec3[] = [],
    owner: number[] = [];
  for (let k = 0, i = 0; k < count; ++k) {
    const t = (whole * k) / Math.max(count - 1, 1);
    while (i + 2 < s.length && s[i + 1] <= t) ++i;
    const share = points.length < 2 ? 0 : Math.min(1, Math.max(0, (t - s[i]) / (s[i + 1] - s[i] || 1)));
    path.push(points.length < 2 ? points[0] : mix(points[i], points[i + 1], share));
    owner.push(nodes[share < 0.5 ? i : Math.min(i + 1, nodes.length - 1)]);
  }
  const tangent = (k: number): Vec3 => {
    const d = sub(path[Math.min(k + 1, count - 1)], path[Math.max(k - 1, 0)]);
    return dot(d, d) > 0 ? unit(d) : unit(tree.axis(owner[k]));
  };
  const side: Vec3[] = [across(tangent(0))];
  for (let k = 1; k < count; ++k) {
    const v = sub(path[k], path[k - 1]),
      c = dot(v, v) || 1,
      t0 = tangent(k - 1),
      t1 = tangent(k);
    const u = along(side[k - 1], v, (-2 * dot(v, side[k - 1])) / c),
      t = along(t0, v, (-2 * dot(v, t0)) / c);
    const w = sub(t1, t),
      d = dot(w, w);
    side.push(unit(d > 1e-12 ? along(u, w, (-2 * dot(w, u)) / d) : u));
  }
  return { path, side };
}

/** Grey values of the straightened vessel: a column for each point, rows from +half to -half mm across. */
export function reformat(
  volume: Volume,
  straight: Straight,
  rows: number,
  half: number,
  turn: number,
  window: [number, number],
): ImageData {
  const n = straight.path.length,
    image = new ImageData(n, rows),
    span = Math.max(window[1] - window[0], 1e-9),
    pixels = new Uint32Array(image.data.buffer);
  for (let k = 0; k < n; ++k) {
    const before = straight.path[Math.max(0, k - 1)],
      after = straight.path[Math.min(n - 1, k + 1)],
      d = unit(sub(after, before));
    const side = turn === 0 ? straight.side[k] : rotate(straight.side[k], d, turn),
      from = along(straight.path[k], side, half),
      step = scale(side, (-2 * half) / Math.max(rows - 1, 1));
    for (let j = 0; j < rows; ++j) {
      const v = volume.sample(along(from, step, j)),
        g = Number.isNaN(v) ? 12 : Math.min(255, Math.max(0, Math.round((255 * (v - window[0])) / span)));
      pixels[j * n + k] = 0xff000000 | (g * 0x010101);
    }
  }
  return image;
}
