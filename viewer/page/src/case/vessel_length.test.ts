// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { BranchRecord, Vec3 } from "../base/types";
import { SmoothAxis } from "./smooth_axis";
import { edgeLengths, type Nodes } from "./vessel_length";

const record = (first: number, count: number, parent = -1, kind = "vessel"): BranchRecord => ({
  label: String(first),
  kind,
  parent_node: parent,
  first_node: first,
  node_count: count,
  stop_reason: "unknown",
  confidence: null,
  length_mm: 0,
});

/** Nodes of branches whose first node is the child of another one. */
function nodesOf(branches: BranchRecord[], centre: Vec3[], radius: (node: number) => number): Nodes {
  const of = (node: number): number =>
    branches.findIndex(b => node >= b.first_node && node < b.first_node + b.node_count);
  return {
    centre: new Float32Array(centre.flat()),
    radius: new Float32Array(centre.map((_, i) => radius(i))),
    parent: new Int32Array(
      centre.map((_, i) => (branches[of(i)].first_node === i ? branches[of(i)].parent_node : i - 1)),
    ),
    branch: new Uint32Array(centre.map((_, i) => of(i))),
  };
}

const sum = (values: Float64Array, from = 0, to = values.length): number =>
  values.subarray(from, to).reduce((a, b) => a + b, 0);

describe("SmoothAxis", () => {
  it("hasTheLengthOfACircleThroughItsNodes", () => {
    const points = Array.from(
        { length: 61 },
        (_, i): Vec3 => [20 * Math.cos(i / 20), 20 * Math.sin(i / 20), 0],
      ),
      axis = new SmoothAxis(
        points,
        points.map(() => 1.5),
      );
    expect(axis.length / 60).toBeCloseTo(1, 3);
    expect(axis.alongOf(30) / 30).toBeCloseTo(1, 3);
    expect(Math.hypot(...axis.at(axis.length / 2))).toBeCloseTo(20, 2);
  });
  it("isNotLengthenedByNoise", () => {
    const points = Array.from({ length: 81 }, (_, i): Vec3 => [i / 2, i % 2 === 0 ? 0.15 : -0.15, 0]);
    expect(
      new SmoothAxis(
        points,
        points.map(() => 2),
      ).length,
    ).toBeCloseTo(40, 1); // 46.6 along the nodes
  });
});

/** A thin helix with noise, whose nodes lie far apart. */
function thinHelix(): SmoothAxis {
  const points = Array.from(
    { length: 41 },
    (_, i): Vec3 => [
      4 * Math.cos(i / 6) + 0.05 * Math.sin(37 * i),
      4 * Math.sin(i / 6) + 0.05 * Math.cos(53 * i),
      0.3 * i + 0.05 * Math.sin(71 * i),
    ],
  );
  return new SmoothAxis(
    points,
    points.map((_, i) => 0.15 + 0.001 * i),
  );
}

/** Of 1.8 turns, with a radius of 2 mm, of a vessel of some radius. */
function tightCircle(radius: number): SmoothAxis {
  const points = Array.from(
    { length: 61 },
    (_, i): Vec3 => [2 * Math.cos(0.19 * i), 2 * Math.sin(0.19 * i), 0],
  );
  return new SmoothAxis(
    points,
    points.map(() => radius),
  );
}

describe("lengths of SmoothAxis", () => {
  it("areWhatTheyWere", () => {
    expect(thinHelix().length).toBeCloseTo(29.19769117317273, 6);
    expect(tightCircle(0.9).length).toBeCloseTo(22.741708569533785, 6);
    expect(tightCircle(1.5).length).toBeCloseTo(22.824943270799608, 6);
  });
});

describe("edgeLengths", () => {
  const trunk = Array.from({ length: 41 }, (_, i): Vec3 => [0, 0, i - 20]);
  it("countsFromWhereAVesselLeavesItsParentsLumen", () => {
    const child = Array.from({ length: 31 }, (_, i): Vec3 => [i, 0, 0]),
      branches = [record(0, 41), record(41, 31, 20)],
      edge = edgeLengths(
        nodesOf(branches, [...trunk, ...child], i => (i < 41 ? 3.25 : 1)),
        branches,
      );
    expect(sum(edge, 0, 41)).toBeCloseTo(40, 6);
    expect(sum(edge, 41)).toBeCloseTo(30 - 3.25, 3);
    expect([...edge.subarray(41, 45)]).toEqual([0, 0, 0, 0]);
  });
  it("countsFromTheParentsBallWhereTheFirstNodeLiesOutside", () => {
    const child = Array.from({ length: 31 }, (_, i): Vec3 => [5 + i, 0, 0]),
      branches = [record(0, 41), record(41, 31, 20)],
      edge = edgeLengths(
        nodesOf(branches, [...trunk, ...child], i => (i < 41 ? 3.25 : 1)),
        branches,
      );
    expect(edge[41]).toBeCloseTo(5 - 3.25, 6);
    expect(sum(edge, 41)).toBeCloseTo(35 - 3.25, 6);
  });
  it("isZeroForAVesselThatNeverLeavesItsParent", () => {
    const child: Vec3[] = [
        [0, 0, 0],
        [1, 0, 0],
        [2, 0, 0],
      ],
      branches = [record(0, 41), record(41, 3, 20)],
      edge = edgeLengths(
        nodesOf(branches, [...trunk, ...child], i => (i < 41 ? 3.25 : 1)),
        branches,
      );
    expect(sum(edge, 41)).toBe(0);
  });
  it("leavesOutNodesThatAreATenthOfARadiusFromTheOneBefore", () => {
    const near = trunk.flatMap(([x, y, z]): Vec3[] => [
        [x, y, z],
        [0.09, 0, z + 0.1],
      ]),
      branches = [record(0, 82)],
      edge = edgeLengths(
        nodesOf(branches, near, () => 2),
        branches,
      );
    expect(edge[1]).toBe(0);
    expect(sum(edge)).toBeCloseTo(40.1, 1);
  });
  it("addsEdgesOfAneurysmsAndOfOneNode", () => {
    const branches = [record(0, 41), record(41, 2, 20, "aneurysm"), record(43, 1, 40)],
      edge = edgeLengths(
        nodesOf(branches, [...trunk, [4, 0, 0], [6, 0, 0], [0, 5, 20]], i => (i < 41 ? 3 : 1)),
        branches,
      );
    expect([...edge.subarray(41)]).toEqual([1, 2, 2]);
  });
});
