// SPDX-License-Identifier: Apache-2.0
/** Lengths, angles, sections across a vessel, and gaps between vessels. mm, degrees. */
import type { Model } from "../../../../libblob/wasm/blob.mjs";
import { Flags, toWall } from "./probe";
import type { Tree } from "../case/tree";
import type { Vec3 } from "../base/types";
import { across, add, along, cross, distance, dot, length, scale, sub, unit } from "../base/vec";

export function angle(a: Vec3, corner: Vec3, b: Vec3): number {
  const u = unit(sub(a, corner)),
    v = unit(sub(b, corner));
  return (180 / Math.PI) * Math.atan2(length(cross(u, v)), dot(u, v));
}

interface Section {
  centre: Vec3;
  normal: Vec3;
  outline: Vec3[];
  area: number;
  perimeter: number;
  /** Diameter of the circle of the same area, and the least and greatest width through the centre. */
  diameter: number;
  least: number;
  greatest: number;
}

const kRays = 72;

/** Across the vessel at one of its nodes: the wall along rays from the axis. */
export function sectionAt(model: Model, tree: Tree, node: number): Section {
  const centre = tree.position(node),
    normal = unit(tree.axis(node)),
    u = across(normal),
    v = cross(normal, u),
    r = tree.radius[node];
  const reach: number[] = [],
    outline: Vec3[] = [];
  for (let i = 0; i < kRays; ++i) {
    const a = (2 * Math.PI * i) / kRays,
      d = add(scale(u, Math.cos(a)), scale(v, Math.sin(a)));
    const t = toWall(model, centre, d, node, r, 4 * r);
    reach.push(t);
    outline.push(along(centre, d, t));
  }
  return { centre, normal, outline, ...sectionFigures(reach, outline) };
}

/** Area, perimeter and widths of a star-shaped outline, by rays at equal angles. */
export function sectionFigures(
  reach: number[],
  outline: Vec3[],
): Omit<Section, "centre" | "normal" | "outline"> {
  const n = reach.length;
  let area = 0,
    perimeter = 0,
    least = Infinity,
    greatest = 0;
  for (let i = 0; i < n; ++i) {
    const j = (i + 1) % n;
    area += 0.5 * reach[i] * reach[j] * Math.sin((2 * Math.PI) / n);
    perimeter += distance(outline[i], outline[j]);
    if (i < n / 2) {
      const width = reach[i] + reach[i + (n >> 1)];
      least = Math.min(least, width);
      greatest = Math.max(greatest, width);
    }
  }
  return { area, perimeter, least, greatest, diameter: 2 * Math.sqrt(area / Math.PI) };
}

interface Gap {
  a: number;
  b: number;
  nodeA: number;
  nodeB: number;
  gap: number;
  from: Vec3;
  to: Vec3;
}

const kNearRadii = 1; // a gap below this many of both radii together is looked at
const kAlongRadii = 4; // vessels nearer along the tree than this many of both radii are one vessel, not two that touch

/** Places where vessels that are apart along the tree come near each other: the narrowest of each pair of branches, up to
 * `most` of them, the narrowest first. Gaps of balls first; the wall itself where there is a model. */
export function gaps(tree: Tree, model: Model | null, most: number, only = -1): Gap[] {
  const best = new Map<number, Gap>(),
    cells = new Map<string, number[]>(),
    size = 2 * (1 + kNearRadii) * Math.max(...tree.radius, 0.1);
  const cell = (p: Vec3): [number, number, number] =>
    p.map(x => Math.floor(x / size)) as [number, number, number];
  for (let i = 0; i < tree.count; ++i) {
    const p = tree.position(i),
      [x, y, z] = cell(p);
    for (let k = 0; k < 27; ++k)
      for (const j of cells.get(
        `${x + (k % 3) - 1},${y + (Math.floor(k / 3) % 3) - 1},${z + Math.floor(k / 9) - 1}`,
      ) ?? [])
        consider(j, i);
    const key = `${x},${y},${z}`,
      there = cells.get(key);
    if (there === undefined) cells.set(key, [i]);
    else there.push(i);
  }
  function consider(i: number, j: number): void {
    const a = Math.min(tree.branch[i], tree.branch[j]),
      b = Math.max(tree.branch[i], tree.branch[j]);
    if (a === b || (only >= 0 && a !== only && b !== only)) return;
    const both = tree.radius[i] + tree.radius[j],
      gap = distance(tree.position(i), tree.position(j)) - both,
      key = a * tree.branches.length + b;
    if (gap > kNearRadii * both || gap >= (best.get(key)?.gap ?? Infinity)) return;
    if (lengthBetween(tree, i, j) < kAlongRadii * both + distance(tree.position(i), tree.position(j))) return;
    const [nodeA, nodeB] = tree.branch[i] === a ? [i, j] : [j, i];
    best.set(key, { a, b, nodeA, nodeB, gap, from: tree.position(nodeA), to: tree.position(nodeB) });
  }
  const narrowest = [...best.values()].sort((x, y) => x.gap - y.gap).slice(0, most);
  return narrowest.map(gap => onWalls(tree, model, gap)).sort((x, y) => x.gap - y.gap);
}

/** The gap from wall to wall, each of its own vessel: the cursor is held at the node. */
function onWalls(tree: Tree, model: Model | null, gap: Gap): Gap {
  const p = tree.position(gap.nodeA),
    q = tree.position(gap.nodeB),
    d = unit(sub(q, p)),
    whole = distance(p, q);
  const reach = (node: number, from: Vec3, towards: Vec3): number => {
    const r = tree.radius[node];
    return model === null
      ? r
      : toWall(model, from, towards, node, r, Math.max(whole, r) * 1.5, Flags.LOCAL | Flags.HOLD);
  };
  const s = reach(gap.nodeA, p, d),
    t = reach(gap.nodeB, q, scale(d, -1));
  return { ...gap, gap: whole - s - t, from: along(p, d, s), to: along(q, d, -t) };
}

/** mm along the tree from one node to another; infinity if they are in different trees. */
export function lengthBetween(tree: Tree, i: number, j: number): number {
  let a = i,
    b = j,
    sum = 0;
  while (a !== b) {
    const step = a > b ? a : b,
      up = tree.parent[step]; // parents come before their children
    if (up < 0) return Infinity;
    sum += distance(tree.position(step), tree.position(up));
    if (a > b) a = up;
    else b = up;
  }
  return sum;
}
