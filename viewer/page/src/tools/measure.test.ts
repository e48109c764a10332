// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { sampleTree } from "../case/sample_tree";
import { gaps, lengthBetween, sectionFigures } from "./measure";

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
