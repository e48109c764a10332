// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { kInitial } from "./model";
import { gaps, sectionFigures, lengthBetween } from "./measure";
import { sameVessels } from "./same_vessel";
import { sampleTree } from "./sample_tree";

describe("Tree", () => {
  const tree = sampleTree();
  it("measuresABranchAlongItsOwnNodes", () => {
    expect(tree.branches.map(b => b.length)).toEqual([10, 4, 3]);
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
describe("lengthBetween", () => {
  const tree = sampleTree();
  it("goesUpAndDownTheTree", () => {
    expect(lengthBetween(tree, 10, 15)).toBe(10);
    expect(lengthBetween(tree, 15, 10)).toBe(10);
  });
  it("isInfiniteBetweenTrees", () => {
    expect(lengthBetween(tree, 0, 17)).toBe(Infinity);
  });
});
describe("gaps", () => {
  it("findsVesselsThatAreNearButApartAlongTheTree", () => {
    const [gap, ...others] = gaps(sampleTree(), null, 10);
    expect(others).toEqual([]);
    expect([gap.a, gap.b]).toEqual([0, 2]);
    expect(gap.gap).toBeCloseTo(0.25, 6);
  });
});
describe("sectionFigures", () => {
  it("areThoseOfACircle", () => {
    const n = 72,
      outline = Array.from({ length: n }, (_, i): [number, number, number] => [
        2 * Math.cos((2 * Math.PI * i) / n),
        2 * Math.sin((2 * Math.PI * i) / n),
        0,
      ]);
    const f = sectionFigures(
      outline.map(() => 2),
      outline,
    );
    expect(f.area).toBeCloseTo(Math.PI * 4, 1);
    expect(f.diameter).toBeCloseTo(4, 2);
    expect([f.least, f.greatest]).toEqual([4, 4]);
    expect(f.perimeter).toBeCloseTo(2 * Math.PI * 2, 2);
  });
});
describe("sameVessels", () => {
  const before = sampleTree(),
    renamed = sampleTree(),
    nothing = { ...kInitial, ...sameVessels(kInitial, before), tree: before };
  renamed.branches[1] = { ...renamed.branches[1], label: "other" };
  it("followsAVesselThatWasRenamed", () => {
    expect(
      sameVessels({ ...nothing, selected: 1, node: 13, hidden: new Set(["child"]), solo: "child" }, renamed),
    ).toMatchObject({ selected: 1, node: 13, hidden: new Set(["other"]), solo: "other" });
  });
  it("leavesEveryVesselItsColour", () => {
    expect([...nothing.colourNumbers]).toEqual([
      ["trunk", 0],
      ["child", 1],
      ["<b>alone</b>", 2],
    ]);
    const more = sampleTree();
    more.branches[0] = { ...more.branches[0], label: "new", firstNode: 1 }; // the trunk is gone, another vessel is before the rest
    expect([...sameVessels(nothing, more).colourNumbers]).toEqual([
      ["child", 1],
      ["<b>alone</b>", 2],
      ["new", 0],
    ]);
  });
  it("showsTheRestWhenTheOneThatWasAloneIsGone", () => {
    const rest = sampleTree();
    rest.branches[1] = { ...rest.branches[1], label: "new", firstNode: 12 };
    expect(sameVessels({ ...nothing, selected: 1, node: 13, solo: "child" }, rest)).toMatchObject({
      selected: -1,
      node: -1,
      solo: null,
    });
  });
  it("isNoneWithoutATree", () => {
    expect(sameVessels({ ...nothing, selected: 1, node: 13 }, null)).toMatchObject({
      selected: -1,
      node: -1,
    });
  });
});
