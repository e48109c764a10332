// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { sampleTree } from "./sample_tree";

describe("Tree", () => {
  const tree = sampleTree();
  it("measuresABranchAlongItsOwnNodes", () => {
    expect(tree.branches.map(b => b.length_mm)).toEqual([10, 4, 3]);
  });
  it("knowsParents", () => {
    expect(tree.branches.map(b => b.parentBranch)).toEqual([-1, 0, -1]);
  });
  it("listsBranchesBelowTheirParents", () => {
    expect(tree.outline()).toEqual([
      { branch: 0, depth: 0 },
      { branch: 1, depth: 1 },
      { branch: 2, depth: 0 },
    ]);
  });
  it("leadsFromTheRootToAnEnd", () => {
    expect(tree.pathTo(1)).toEqual([0, 1, 2, 3, 4, 5, 11, 12, 13, 14, 15]);
  });
  it("findsTheNearestNodeByPower", () => {
    expect(tree.nearest([0.2, 0, 3.1])).toBe(3);
    expect(tree.nearest([4.2, 0, 5])).toBe(14);
  });
  it("hasABoxOfBalls", () => {
    expect(tree.box()).toEqual({ low: [-1, -1, -1], high: [5.5, 2.25, 11.5] });
  });
});
