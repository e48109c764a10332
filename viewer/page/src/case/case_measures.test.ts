// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { figuresOf, figureText, placeOf, splitColumn, titleOf, type MeasureRow } from "./case_measures";

const vessel: MeasureRow = {
  vessel: "left",
  place_mm: [1, 2, 3],
  smallest_radius_place_mm: [4, 5, 6],
  length_mm: { value: 12.3456, plus_minus: 0.21, absent: null },
  smallest_radius_mm: { value: 0.5, plus_minus: null, absent: null },
  taper_mm_per_mm: { value: null, plus_minus: null, absent: "a stub" },
};

describe("columns of measures", () => {
  it("are names with units", () => {
    expect(splitColumn("sum_of_angles_rad_per_cm")).toEqual({ name: "sum of angles", unit: "rad/cm" });
    expect(splitColumn("greatest_curvature_per_mm")).toEqual({ name: "greatest curvature", unit: "/mm" });
    expect(splitColumn("taper_mm_per_mm")).toEqual({ name: "taper", unit: "mm/mm" });
    expect(splitColumn("volume_mm3")).toEqual({ name: "volume", unit: "mm³" });
    expect(splitColumn("turns_over_90_deg")).toEqual({ name: "turns over 90°", unit: "" });
    expect(splitColumn("tortuosity")).toEqual({ name: "tortuosity", unit: "" });
  });
});

describe("a measure", () => {
  it("has as many digits as its interval lets mean something", () => {
    expect(figureText({ value: 12.3456, plus_minus: 0.21, absent: null }, "mm")).toBe("12.35 ± 0.21 mm");
    expect(figureText({ value: 1234.5, plus_minus: 60, absent: null }, "mm³")).toBe("1235 ± 60 mm³");
    expect(figureText({ value: 62.54, plus_minus: 10.93, absent: null }, "°")).toBe("63 ± 11°");
  });
  it("without an interval is a number alone", () => {
    expect(figureText({ value: 3, plus_minus: null, absent: null }, "")).toBe("3");
    expect(figureText({ value: 0.62037, plus_minus: null, absent: null }, "mm")).toBe("0.6204 mm");
  });
  it("that is not defined is its reason", () => {
    expect(figureText({ value: null, plus_minus: null, absent: "a stub" }, "mm")).toBe("a stub");
    expect(figureText({ value: 0.1, plus_minus: null, absent: null, at_most: 0.4329 }, "mm")).toBe(
      "≤ 0.43 mm",
    );
  });
});

describe("a row", () => {
  it("gives each measure its own place, or its row's", () => {
    expect(figuresOf(vessel).map(f => [f.name, f.place])).toEqual([
      ["length", [1, 2, 3]],
      ["smallest radius", [4, 5, 6]],
      ["taper", [1, 2, 3]],
    ]);
    expect(placeOf({ vessel: "left" })).toBeNull();
  });
  it("of a sac has measures without a place", () => {
    const sac = { ...vessel, place_mm: null, smallest_radius_place_mm: null };
    expect(figuresOf(sac).map(f => [f.name, f.place])).toEqual([
      ["length", null],
      ["smallest radius", null],
      ["taper", null],
    ]);
    expect(placeOf(sac)).toBeNull();
    expect(titleOf(sac)).toBe("left");
  });
  it("is named by its texts, each once", () => {
    expect(titleOf({ parent: "a", larger: "a", smaller: "b", place_mm: [0, 0, 0] })).toBe("a, b");
    expect(titleOf({ inlet: "a", end: "c", vessels: "a b c" })).toBe("a, c");
  });
});
