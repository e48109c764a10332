// SPDX-License-Identifier: Apache-2.0
/** The surface of a case without a server: marching tetrahedra over the distance that libblob answers, on those blocks of a grid
 * that a wall may pass through, and each vertex moved onto the wall. */
import { NOWHERE, type Batch, type Model } from "../../../../libblob/wasm/blob.mjs";
import { makePack } from "./pack";
import type { Tree } from "./tree";

const kBlock = 6, // cells along an edge of a block
  kSide = kBlock + 1, // points
  kPoints = kSide ** 3,
  kReach = 1.5, // radii from a node's centre within which its wall is looked for
  kCellsAcross = 4, // cells across a vessel at the lower quartile of radii
  kMostPoints = 1e6, // bound on the grid's points: a second or two of queries
  kSteps = 2; // steps of Newton's method onto the wall

/** Six tetrahedra of a cube that share its diagonal; corners are bits x, y, z. */
export const kTetrahedra = [
  [0, 1, 3, 7],
  [0, 3, 2, 7],
  [0, 2, 6, 7],
  [0, 6, 4, 7],
  [0, 4, 5, 7],
  [0, 5, 1, 7],
];

class Grid {
  readonly low: number[];
  /** Blocks that a wall may pass through, by their number. */
  readonly blocks = new Set<number>();
  private readonly across: number[];

  constructor(
    tree: Tree,
    readonly step: number,
  ) {
    const box = tree.box()!,
      margin = Math.max(...tree.radius),
      size = kBlock * step;
    this.low = box.low.map(x => x - margin);
    this.across = box.high.map((x, a) => Math.ceil((x + margin - this.low[a]) / size) + 1);
    for (let node = 0; node < tree.count; ++node) this.mark(tree, node, size);
  }

  private mark(tree: Tree, node: number, size: number): void {
    const centre = tree.position(node),
      reach = kReach * tree.radius[node],
      [first, last] = [-reach, reach].map(d =>
        centre.map((x, a) =>
          Math.min(this.across[a] - 1, Math.max(0, Math.floor((x + d - this.low[a]) / size))),
        ),
      );
    for (let k = first[2]; k <= last[2]; ++k)
      for (let j = first[1]; j <= last[1]; ++j)
        for (let i = first[0]; i <= last[0]; ++i)
          this.blocks.add(i + this.across[0] * (j + this.across[1] * k));
  }

  /** First point of a block, in steps from `low`. */
  corner(block: number): number[] {
    const [nx, ny] = this.across;
    return [block % nx, Math.floor(block / nx) % ny, Math.floor(block / (nx * ny))].map(i => kBlock * i);
  }
  /** A number of its own for each point of the grid. */
  number(i: number, j: number, k: number): number {
    const [nx, ny] = this.across.map(n => kBlock * n + 1);
    return i + nx * (j + ny * k);
  }
}

/** A grid that is fine enough for most vessels, and coarser where it would have too many points. */
function gridOf(tree: Tree): Grid {
  const radii = Float32Array.from(tree.radius).sort();
  let step = (2 * radii[Math.floor(radii.length / 4)]) / kCellsAcross;
  for (;;) {
    const grid = new Grid(tree, step);
    if (grid.blocks.size * kPoints <= kMostPoints) return grid;
    step *= Math.max(1.05, Math.cbrt((grid.blocks.size * kPoints) / kMostPoints));
  }
}

/** Vertices on edges of the grid, each made once, and triangles. */
class Soup {
  readonly position: number[] = [];
  readonly triangle: number[] = [];
  private readonly vertices = new Map<number, number>();

  /** The vertex between two points of distances of unlike signs. `edge`: a number of its own. */
  vertex(edge: number, a: number[], b: number[], fa: number, fb: number): number {
    let vertex = this.vertices.get(edge);
    if (vertex === undefined) {
      vertex = this.position.length / 3;
      const t = fa / (fa - fb);
      this.position.push(...a.map((x, d) => x + t * (b[d] - x)));
      this.vertices.set(edge, vertex);
    }
    return vertex;
  }

  /** Turned so that it faces outwards, from the inner point. */
  add(a: number, b: number, c: number, inner: number[]): void {
    const p = (v: number, d: number): number => this.position[3 * v + d],
      u = [0, 1, 2].map(d => p(b, d) - p(a, d)),
      w = [0, 1, 2].map(d => p(c, d) - p(a, d)),
      n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]],
      out = n.reduce((sum, x, d) => sum + x * (p(a, d) - inner[d]), 0);
    if (out >= 0) this.triangle.push(a, b, c);
    else this.triangle.push(a, c, b);
  }
}

/** The triangles of a block whose distances are known. */
function march(grid: Grid, block: number, distance: Float64Array, soup: Soup): void {
  const corner = grid.corner(block),
    at = (i: number, j: number, k: number): number => distance[i + kSide * (j + kSide * k)];
  for (let k = 0; k < kBlock; ++k)
    for (let j = 0; j < kBlock; ++j)
      for (let i = 0; i < kBlock; ++i) {
        const f = [0, 1, 2, 3, 4, 5, 6, 7].map(c => at(i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2)));
        if (f.every(x => x < 0) || f.every(x => !(x < 0))) continue;
        cell(grid, [corner[0] + i, corner[1] + j, corner[2] + k], f, soup);
      }
}

function cell(grid: Grid, [i, j, k]: number[], f: number[], soup: Soup): void {
  const place = (c: number): number[] =>
    [i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2)].map((x, a) => grid.low[a] + grid.step * x);
  const cut = (a: number, b: number): number => {
    const [first, last] = a < b ? [a, b] : [b, a]; // bits of first are among those of last
    const edge = 8 * grid.number(i + (first & 1), j + ((first >> 1) & 1), k + (first >> 2)) + (last ^ first);
    return soup.vertex(edge, place(first), place(last), f[first], f[last]);
  };
  for (const tetrahedron of kTetrahedra) {
    const inside = tetrahedron.filter(c => f[c] < 0),
      outside = tetrahedron.filter(c => !(f[c] < 0));
    if (inside.length === 0 || outside.length === 0) continue;
    const inner = place(inside[0]);
    if (inside.length === 1) {
      const [a, b, c] = outside.map(each => cut(inside[0], each));
      soup.add(a, b, c, inner);
    } else if (outside.length === 1) {
      const [a, b, c] = inside.map(each => cut(each, outside[0]));
      soup.add(a, b, c, inner);
    } else {
      const [a, b] = inside,
        [c, d] = outside,
        [p, q, r, s] = [cut(a, c), cut(a, d), cut(b, d), cut(b, c)];
      soup.add(p, q, r, inner);
      soup.add(p, r, s, inner);
    }
  }
}

function ask(batch: Batch, points: ArrayLike<number>): void {
  batch.cursors.fill(NOWHERE);
  batch.points.set(points);
  batch.query();
}

/** Moves the vertices onto the wall; the node of each, and the field's normal there. */
function settle(
  model: Model,
  position: Float64Array,
): { node: Uint32Array<ArrayBuffer>; normal: Float32Array<ArrayBuffer> } {
  const count = position.length / 3,
    batch = model.batch(count),
    node = new Uint32Array(count),
    normal = new Float32Array(3 * count);
  for (let step = 0; step <= kSteps; ++step) {
    ask(batch, position);
    for (let i = 0; i < count; ++i) {
      const sample = batch.sample(i);
      if (step === kSteps) normal.set(sample.normal, 3 * i);
      else if (Number.isFinite(sample.distance))
        for (let a = 0; a < 3; ++a) position[3 * i + a] -= sample.distance * sample.normal[a];
    }
  }
  node.set(batch.cursors);
  batch.free();
  return { node, normal };
}

/** Triangles in the order of their branches, and the part that each branch is. */
function partsOf(
  tree: Tree,
  node: Uint32Array,
  triangle: number[],
): { sorted: Uint32Array<ArrayBuffer>; parts: Record<string, unknown>[] } {
  const ofBranch = tree.branches.map((): number[] => []);
  for (let t = 0; t < triangle.length; t += 3)
    ofBranch[tree.branch[node[triangle[t]]]].push(triangle[t], triangle[t + 1], triangle[t + 2]);
  const sorted = new Uint32Array(triangle.length),
    parts: Record<string, unknown>[] = [];
  let first = 0;
  ofBranch.forEach((own, branch) => {
    sorted.set(own, 3 * first);
    parts.push({ name: tree.branches[branch].label, branch, first, count: own.length / 3 });
    first += own.length / 3;
  });
  return { sorted, parts };
}

/** The pack "surface" (../../README.md) of the model's wall. */
export function surfacePack(model: Model, tree: Tree): Uint8Array {
  const grid = gridOf(tree),
    soup = new Soup(),
    batch = model.batch(kPoints),
    points = new Float64Array(3 * kPoints);
  for (const block of grid.blocks) {
    const corner = grid.corner(block);
    for (let k = 0, o = 0; k < kSide; ++k)
      for (let j = 0; j < kSide; ++j)
        for (let i = 0; i < kSide; ++i)
          for (const [a, x] of [i, j, k].entries()) points[o++] = grid.low[a] + grid.step * (corner[a] + x);
    ask(batch, points);
    march(grid, block, batch.distances(), soup);
  }
  batch.free();
  const position = Float64Array.from(soup.position),
    { node, normal } = settle(model, position),
    vertices = node.length,
    { sorted, parts } = partsOf(tree, node, soup.triangle);
  return makePack(
    { parts, kind: "quick", level: 0, levels: 1, overlaps: [] },
    {
      position: { type: "f32", shape: [vertices, 3], data: Float32Array.from(position) },
      normal: { type: "f32", shape: [vertices, 3], data: normal },
      triangle: { type: "u32", shape: [sorted.length / 3, 3], data: sorted },
      node: { type: "u32", shape: [vertices], data: node },
      radius_mm: { type: "f32", shape: [vertices], data: Float32Array.from(node, n => tree.radius[n]) },
    },
  );
}
