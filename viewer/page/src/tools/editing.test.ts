// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Tree } from "../case/tree";
import type { Vec3 } from "../base/types";
import { branchesAt, pushed, type Stroke } from "../model/stroke";
import { onward } from "./track_on";
import { sampleTree } from "../case/sample_tree";

const outwards: Stroke = { node: 5, at: [0, 1, 5], by: [0, 0.5, 0], radius: 2 },
  centre: Vec3 = [0, 0, 5],
  axis: Vec3 = [0, 0, 1];

describe("a stroke of the brush", () => {
  it("movesTheWallInFullWhereItBegins", () => {
    expect(pushed([0, 1, 5], centre, axis, outwards)).toEqual([0, 1.5, 5]);
  });
  it("fadesTowardsTheRimOfTheBrush", () => {
    const [, y] = pushed([1, 1, 5], centre, axis, outwards); // half-way to the rim: (1 - 1/4)^2
    expect(y).toBeCloseTo(1 + 0.5 * 0.5625, 12);
    expect(pushed([0, 1, 7], centre, axis, outwards)).toEqual([0, 1, 7]);
  });
  it("leavesTheWallAroundItsAxis", () => {
    const [, y] = pushed([0, 1, 5], centre, axis, { ...outwards, by: [0, -3, 0] });
    expect(y).toBeCloseTo(0.25, 12);
  });
  it("movesTheVesselAndThoseThatItMeetsAlone", () => {
    const tree = sampleTree();
    expect([...branchesAt(tree, 5)].sort()).toEqual([0, 1]);
    expect([...branchesAt(tree, 12)].sort()).toEqual([0, 1]);
    expect([...branchesAt(tree, 17)]).toEqual([2]);
  });
});

/** Nodes of radius 1 at x = 0, 1, ..., 5, in one branch. */
function straight(parentNode: number): Tree {
  const position = (i: number): Vec3 => [i, 0, 0];
  return {
    branches: [{ first_node: 0, node_count: 6, label: "ica", parent_node: parentNode }],
    radius: new Float32Array(6).fill(1),
    position,
    axis: (): Vec3 => [1, 0, 0],
    nearest: (p: Vec3) => Math.max(0, Math.min(5, Math.round(p[0]))),
  } as unknown as Tree;
}

describe("a vessel is tracked on", () => {
  it("from the crosshair outside of it, as its child", () => {
    expect(onward(straight(-1), 0, [5, 3, 0])).toEqual({ from: [5, 3, 0], parent: "ica" });
  });
  it("beyond its last node where the crosshair is in it", () => {
    expect(onward(straight(-1), 0, [4, 0.2, 0])).toEqual({ from: [7, 0, 0], parent: "ica" });
  });
  it("before the first node of a root, as a root, if that is nearer", () => {
    expect(onward(straight(-1), 0, [1, 0.2, 0])).toEqual({ from: [-2, 0, 0], parent: null });
    expect(onward(straight(3), 0, [1, 0.2, 0])).toEqual({ from: [7, 0, 0], parent: "ica" });
  });
});
