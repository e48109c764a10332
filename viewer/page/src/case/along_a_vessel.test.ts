// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { dot } from "../base/vec";
import { findPlaces } from "./narrowing";
import { sampleTree } from "./sample_tree";
import { straighten } from "./straightened";

describe("findPlaces", () => {
  const s = Array.from({ length: 81 }, (_, i) => i / 2),
    at = (radius: (s: number) => number): ReturnType<typeof findPlaces> => findPlaces(s, s.map(radius));
  it("marksAStenosisWithTheShareThatIsMissing", () => {
    const places = at(x => (Math.abs(x - 20) < 1.1 ? 1 : 2));
    expect(places.map(p => p.kind)).toEqual(["stenosis"]);
    expect(places[0].share).toBeCloseTo(0.5, 6);
    expect([s[places[0].from], s[places[0].to]]).toEqual([19, 21]);
  });
  it("marksADilation", () => {
    expect(at(x => (Math.abs(x - 20) < 2 ? 4 : 2)).map(p => p.kind)).toEqual(["dilation"]);
  });
  it("marksNothingThatDiffersByLessThanAVoxel", () => {
    const r = s.map(x => (Math.abs(x - 20) < 1.1 ? 0.2 : 0.4));
    expect(findPlaces(s, r, 0.3).map(p => p.kind)).toEqual(["stenosis"]);
    expect(findPlaces(s, r, 0.5)).toEqual([]);
  });
  it("doesNotMarkATaper", () => {
    expect(at(x => 3 - 0.05 * x)).toEqual([]);
  });
  it("doesNotMarkAnEndThatPetersOut", () => {
    expect(at(x => (x > 38.4 ? 0.5 : 2))).toEqual([]);
  });
});

describe("straighten", () => {
  it("beginsWhereTheVesselLeavesItsParentsLumen", () => {
    const tree = sampleTree(),
      first = tree.branches[1].first_node;
    tree.rootDistance.set([5, 5.5, 6.5, 7.5, 8.5], first); // half of the second edge lies in the parent
    expect(tree.alongOf(tree.branches[1])).toEqual([0, 0.5, 1.5, 2.5, 3.5]);
    expect(straighten(tree, 1, 8).path.map(p => p[0])).toEqual([1, 2, 2.5, 3, 3.5, 4, 4.5, 5]);
    tree.rootDistance.set([5.5, 6.5, 7.5, 8.5, 9.5], first); // it begins half a millimetre beyond the parent's wall
    expect(straighten(tree, 1, 10).path.map(p => p[0])).toEqual([0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5]);
  });
  it("stepsEvenlyWithASideThatStaysAcross", () => {
    const tree = sampleTree(),
      straight = straighten(tree, 0, 21);
    expect(straight.path.at(-1)![2]).toBe(10);
    expect(straight.path[5][2]).toBeCloseTo(2.5, 9);
    for (const side of straight.side) {
      expect(side[2]).toBeCloseTo(0, 9);
      expect(dot(side, straight.side[0])).toBeCloseTo(1, 9);
    }
  });
});
