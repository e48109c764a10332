// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { niceLength } from "./over";
import { namesApart } from "./vessel_names";

describe("niceLength", () => {
  it("isOneTwoOrFive", () => {
    expect(
      [niceLength(0.1, 100), niceLength(0.03, 100), niceLength(0.7, 100)].map(x => Number(x.toPrecision(3))),
    ).toEqual([10, 2, 50]);
  });
});

describe("namesApart", () => {
  const wide = (text: string): number => 10 * text.length;
  it("keepsTheFirstOfThoseThatMeet", () => {
    const names = [
      { text: "ica", x: 0, y: 0 },
      { text: "mca", x: 20, y: 5 },
      { text: "aca", x: 31, y: 5 },
      { text: "pca", x: 0, y: 14 },
    ];
    expect(namesApart(names, wide).map(n => n.text)).toEqual(["ica", "aca", "pca"]);
  });
  it("endsAtItsMost", () => {
    const many = Array.from({ length: 200 }, (_, i) => ({ text: "a", x: 0, y: 20 * i }));
    expect(namesApart(many, wide).length).toBe(80);
  });
});
