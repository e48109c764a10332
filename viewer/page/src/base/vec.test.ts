// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { across, circle, cross, dot, length, orientation, rotate } from "./vec";

describe("orientation", () => {
  it("namesPatientSides", () => {
    expect(["L", "R", "P", "A", "S", "I"]).toEqual(
      [
        [1, 0, 0],
        [-1, 0, 0],
        [0, 1, 0],
        [0, -1, 0],
        [0, 0, 1],
        [0, 0, -1],
      ].map(d => orientation(d as [number, number, number])),
    );
  });
  it("namesTheLargestFirstAndLeavesOutTheSmall", () => {
    expect(orientation([0.8, 0, -0.6])).toBe("LI");
    expect(orientation([0.98, 0.2, 0])).toBe("L");
  });
});
describe("rotate", () => {
  it("turnsAboutTheAxis", () => {
    rotate([1, 0, 0], [0, 0, 1], Math.PI / 2).forEach((x, i) => expect(x).toBeCloseTo([0, 1, 0][i], 12));
  });
});
describe("across", () => {
  it("isAUnitVectorAcross", () => {
    for (const d of [
      [1, 0, 0],
      [0, 0.6, 0.8],
      [0.577, 0.577, 0.577],
    ] as [number, number, number][]) {
      expect(length(across(d))).toBeCloseTo(1, 12);
      expect(dot(across(d), d)).toBeCloseTo(0, 12);
    }
  });
});
describe("cross", () => {
  it("isRightHanded", () => {
    expect(cross([1, 0, 0], [0, 1, 0])).toEqual([0, 0, 1]);
  });
});

describe("circle", () => {
  it("isClosedAndLiesInItsPlane", () => {
    const line = circle([1, 2, 3], 2, [1, 0, 0], [0, 0, 1]);
    expect(line[0][0]).toBeCloseTo(3, 9);
    expect(line.at(-1)![2]).toBeCloseTo(line[0][2], 9);
    for (const p of line) {
      expect(p[1]).toBe(2);
      expect(Math.hypot(p[0] - 1, p[2] - 3)).toBeCloseTo(2, 9);
    }
  });
});
