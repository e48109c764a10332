// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { DicomSeries } from "./types";
import { aboutOthers, aboutSeries } from "./series_dialog";
import { found } from "./library_panel";
import { kPresets, presetOf, windowOf } from "./volume_panel";
import { namesApart } from "./vessel_names";

describe("windowOf", () => {
  it("spansTheWidthAboutTheCentre", () => {
    expect(windowOf("brain")).toEqual([0, 80]);
    expect(windowOf("lung")).toEqual([-1350, 150]);
    expect(windowOf("other")).toBe(null);
  });
  it("isFoundAgainByItsNumbers", () => {
    for (const { name } of kPresets) expect(presetOf(windowOf(name)!)).toBe(name);
    expect(presetOf([0, 81])).toBe("");
  });
});

const cases = ["head/Left ICA.lumen", "head/right ica.lumen", "aorta.lumen"].map(name => ({
  name,
  branches: 1,
  length: 2,
  error: null,
}));

describe("found", () => {
  it("givesAllForNothing", () => {
    expect(found(cases, " ").map(([index]) => index)).toEqual([0, 1, 2]);
  });
  it("wantsEveryWordInAnyCaseAndKeepsPlaces", () => {
    expect(found(cases, "ICA right").map(([index]) => index)).toEqual([1]);
    expect(found(cases, "ica aorta")).toEqual([]);
  });
});

const series: DicomSeries = {
  description: "Angio",
  modality: "CT",
  files: 40,
  size: [512, 256, 40],
  spacing: [0.5, 0.5, 1.25],
  fault: null,
};

describe("aboutSeries", () => {
  it("statesModalitySlicesSpacingAndSize", () => {
    expect(aboutSeries(series)).toBe("CT, 40 slices, 0.50 × 0.50 × 1.25 mm, 512 × 256 pixels");
    expect(aboutSeries({ ...series, modality: "", files: 1, spacing: null })).toBe(
      "no modality, 40 slices, 1 file, 512 × 256 pixels",
    );
  });
});

describe("aboutOthers", () => {
  const list = { folder: "", list: [], faults: [] };
  it("countsFilesThatBelongToNoSeries", () => {
    expect(aboutOthers({ ...list, faulty: 1, others: 2 })).toBe(
      "1 file cannot be read; 2 files are no images",
    );
    expect(aboutOthers({ ...list, faulty: 0, others: 0 })).toBe("");
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
