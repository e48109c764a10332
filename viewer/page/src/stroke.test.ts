// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { sampleTree } from "./sample_tree";
import { branchesAt, pushed, type Stroke } from "./stroke";
import type { Vec3 } from "./types";

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
