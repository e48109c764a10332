// SPDX-License-Identifier: Apache-2.0
/** The centerline tree of a case: the arrays of its pack, and what follows from them. */
import { kSystems } from "../base/colour";
import { Motion, poseMatrix, type Poses } from "./motion";
import type { Pack } from "./pack";
import type { BranchRecord, Vec3 } from "../base/types";
import { at } from "../base/vec";

export interface Branch extends BranchRecord {
  index: number;
  /** Mean radius of its nodes, mm, as `lumen info` and reports have it. */
  mean: number;
  least: number;
  greatest: number;
  /** Branch that its parent node belongs to, or -1. */
  parentBranch: number;
}

export class Tree {
  readonly centre: Float32Array;
  readonly direction: Float32Array;
  readonly radius: Float32Array;
  readonly height: Float32Array;
  readonly parent: Int32Array;
  readonly branch: Uint32Array;
  readonly inlierRate: Float32Array | null;
  readonly error: Float32Array | null;
  /** 1 for a node whose wall was changed by hand; null if there is none. */
  readonly edited: Uint8Array | null;
  readonly rootDistance: Float32Array;
  readonly pointOffset: Uint32Array | null;
  readonly point: Float32Array | null;
  readonly links: Uint32Array;
  readonly branches: Branch[];
  readonly hasModels: boolean;
  readonly voxelSize: number;
  /** Least radius that the volume shows, mm; 0: not known. */
  readonly leastShown: number;
  readonly reachable: { reached_mm: number; total_mm: number; trees: number } | null;
  readonly count: number;
  /** Null: the case does not move. */
  readonly motion: Motion | null;

  constructor(pack: Pack) {
    this.centre = pack.get("centre", "f32");
    this.direction = pack.get("direction", "f32");
    this.radius = pack.get("radius_mm", "f32");
    this.height = pack.get("height_mm", "f32");
    this.parent = pack.get("parent", "i32");
    this.branch = pack.get("branch", "u32");
    this.inlierRate = pack.optional("inlier_rate", "f32");
    this.error = pack.optional("error_mm", "f32");
    this.edited = pack.optional("edited", "u8");
    this.rootDistance = pack.get("root_distance_mm", "f32");
    this.pointOffset = pack.optional("point_offset", "u32");
    this.point = pack.optional("point", "f32");
    this.links = pack.optional("links", "u32") ?? new Uint32Array(0);
    this.hasModels = pack.meta.has_models === true;
    this.voxelSize = typeof pack.meta.voxel_size_mm === "number" ? pack.meta.voxel_size_mm : 0;
    const least = pack.meta.least_shown_radius_mm;
    this.leastShown = typeof least === "number" ? least : 0;
    this.reachable = (pack.meta.reachable ?? null) as Tree["reachable"];
    this.count = this.radius.length;
    this.motion = Motion.of(pack);
    this.branches = (pack.meta.branches as BranchRecord[]).map((record, index) =>
      this.describe(record, index),
    );
  }

  private describe(record: BranchRecord, index: number): Branch {
    const radii = Array.from(this.radius.subarray(record.first_node, record.first_node + record.node_count));
    return {
      ...record,
      index,
      mean: radii.reduce((sum, r) => sum + r, 0) / radii.length,
      least: Math.min(...radii),
      greatest: Math.max(...radii),
      parentBranch: record.parent_node < 0 ? -1 : this.branch[record.parent_node],
    };
  }

  /** The systems of the branches, each once, in the order of their numbers; none if none is known. */
  get systems(): string[] {
    const found = new Set(this.branches.map(b => b.system ?? kSystems[0]));
    return found.size === 1 && found.has(kSystems[0]) ? [] : kSystems.filter(name => found.has(name));
  }

  position(node: number): Vec3 {
    return at(this.centre, node);
  }
  axis(node: number): Vec3 {
    return at(this.direction, node);
  }

  /** Nodes of a branch, from the node that it leaves its parent at. */
  nodesOf(record: BranchRecord): number[] {
    const own = Array.from({ length: record.node_count }, (_, i) => record.first_node + i);
    return record.parent_node < 0 ? own : [record.parent_node, ...own];
  }

  /** mm of each node of a branch from where the branch leaves its parent's lumen, along its smoothed axis. */
  alongOf({ parent_node: parent, first_node: first, node_count: count }: BranchRecord): number[] {
    const begin = parent < 0 ? 0 : this.rootDistance[parent];
    return Array.from({ length: count }, (_, i) => this.rootDistance[first + i] - begin);
  }

  /** Number of nodes of a branch whose wall was changed by hand. */
  countEdited({ first_node: firstNode, node_count: nodeCount }: BranchRecord): number {
    return this.edited?.subarray(firstNode, firstNode + nodeCount).reduce((sum, each) => sum + each, 0) ?? 0;
  }

  /** Nodes from the root to the end of a branch: the way of a tool. */
  pathTo(branch: number): number[] {
    const record = this.branches[branch],
      path: number[] = [];
    for (let node = record.first_node + record.node_count - 1; node >= 0; node = this.parent[node])
      path.push(node);
    return path.reverse();
  }

  /** The node whose centre is nearest in terms of power |x - c|^2 - r^2. */
  nearest(p: Vec3, among: (branch: number) => boolean = () => true): number {
    let best = -1,
      least = Infinity;
    for (let i = 0; i < this.count; ++i) {
      const x = this.centre[3 * i] - p[0],
        y = this.centre[3 * i + 1] - p[1],
        z = this.centre[3 * i + 2] - p[2];
      const power = x * x + y * y + z * z - this.radius[i] * this.radius[i];
      if (power < least && among(this.branch[i])) {
        least = power;
        best = i;
      }
    }
    return best;
  }

  /** The tree with nodes and wall points where poses carry them. */
  posed(poses: Poses): Tree {
    const moved = {
      centre: this.centre.slice(),
      direction: this.direction.slice(),
      radius: this.radius.slice(),
      height: this.height.slice(),
      point: this.point?.slice() ?? null,
      whole: null,
    };
    for (const [node, pose] of poses) {
      const m = poseMatrix(pose, this.centre.subarray(3 * node, 3 * node + 3)),
        d = this.axis(node);
      moved.centre.set(pose.centre, 3 * node);
      for (let a = 0; a < 3; ++a)
        moved.direction[3 * node + a] =
          (m[4 * a] * d[0] + m[4 * a + 1] * d[1] + m[4 * a + 2] * d[2]) / pose.factor;
      moved.radius[node] *= pose.factor;
      moved.height[node] *= pose.factor;
      if (moved.point === null || this.pointOffset === null) continue;
      for (let k = this.pointOffset[node]; k < this.pointOffset[node + 1]; ++k) {
        const [x, y, z] = at(this.point!, k);
        for (let a = 0; a < 3; ++a)
          moved.point[3 * k + a] = m[4 * a] * x + m[4 * a + 1] * y + m[4 * a + 2] * z + m[4 * a + 3];
      }
    }
    return Object.assign(Object.create(Tree.prototype) as Tree, this, moved);
  }

  private whole: { low: Vec3; high: Vec3 } | null = null;

  /** The box of all nodes' balls; null if there is no node. */
  box(): { low: Vec3; high: Vec3 } | null {
    if (this.count === 0 || this.whole !== null) return this.whole;
    const low: Vec3 = [Infinity, Infinity, Infinity],
      high: Vec3 = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.count; ++i)
      for (let a = 0; a < 3; ++a) {
        low[a] = Math.min(low[a], this.centre[3 * i + a] - this.radius[i]);
        high[a] = Math.max(high[a], this.centre[3 * i + a] + this.radius[i]);
      }
    return (this.whole = { low, high });
  }

  /** Branches in the order of a walk from the roots, each with its depth. */
  outline(): { branch: number; depth: number }[] {
    const children = this.branches.map((): number[] => []),
      result: { branch: number; depth: number }[] = [];
    const roots: number[] = [];
    for (const b of this.branches) (b.parentBranch < 0 ? roots : children[b.parentBranch]).push(b.index);
    const stack = roots.reverse().map(branch => ({ branch, depth: 0 }));
    for (let top = stack.pop(); top !== undefined; top = stack.pop()) {
      result.push(top);
      for (const branch of children[top.branch].reverse()) stack.push({ branch, depth: top.depth + 1 });
    }
    return result;
  }
}
