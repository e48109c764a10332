// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { DicomSeries } from "../base/types";
import { aboutOthers, aboutSeries } from "./series_dialog";
import { found } from "./library_panel";
import { kPresets, presetOf, windowOf } from "./volume_panel";
import { requestFor } from "./one_source";
import { kWidths, widthOf } from "./panel_width";
import { distanceText, inAxes, parsePosition } from "./probe_line";
import { aboutUnsaved } from "./recover";

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
  length_mm: 2,
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
  spacing_mm: [0.5, 0.5, 1.25],
  fault: null,
};

describe("aboutSeries", () => {
  it("statesModalitySlicesSpacingAndSize", () => {
    expect(aboutSeries(series)).toBe("CT, 40 slices, 0.50 × 0.50 × 1.25 mm, 512 × 256 pixels");
    expect(aboutSeries({ ...series, modality: "", files: 1, spacing_mm: null })).toBe(
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

describe("distanceText", () => {
  it("showsAllDigitsOfADistanceThatIsFound", () => {
    expect(distanceText({ distance: -3.99128, converged: true })).toBe("−3.991 mm");
    expect(distanceText({ distance: 0.5, converged: true })).toBe("+0.500 mm");
  });
  it("showsTwoOfOneThatIsNot", () => {
    expect(distanceText({ distance: -3.53, converged: false })).toBe("about −3.5 mm");
  });
});

describe("widthOf", () => {
  it("isWhatWasLeftWithinItsLimits", () => {
    expect(widthOf("411.6")).toBe(412);
    expect(widthOf("10")).toBe(kWidths.least);
    expect(widthOf("4000")).toBe(kWidths.most);
  });
  it("isTheUsualOneForNoNumber", () => {
    for (const text of [null, "", " ", "wide", "NaN"]) expect(widthOf(text)).toBe(kWidths.usual);
  });
});

describe("requestFor", () => {
  const files = [
    { id: 4, kind: "volume", name: "a.nrrd", changed: false, named: true },
    { id: 7, kind: "case", name: "b.lumen", changed: false, named: true },
  ];
  it("closesTheFileOfTheAnswer", () => {
    expect(requestFor("volume", { files })).toEqual({ op: "close_file", id: 4 });
    expect(requestFor("case", { files })).toEqual({ op: "close_file", id: 7 });
    expect(requestFor("accept", { files })).toEqual({ op: "accept_volume" });
  });
  it("asksForNothingWithoutAnAnswer", () => {
    expect(requestFor(null, { files })).toBeNull();
    expect(requestFor("case", { files: files.slice(0, 1) })).toBeNull();
  });
});

describe("coordinates", () => {
  it("areTurnedBetweenTheAxesAndBack", () => {
    expect(inAxes([1, -2, 3], "RAS")).toEqual([-1, 2, 3]);
    expect(inAxes([0, 0, 3], "RAS")).toEqual([0, 0, 3]);
    expect(inAxes([1, -2, 3], "LPS")).toEqual([1, -2, 3]);
  });
  it("areReadWithBlanksCommasOrSemicolons", () => {
    expect(parsePosition(" 1.5  -2, 3e1;")).toBeNull();
    expect(parsePosition(" 1.5  -2, 3e1")).toEqual([1.5, -2, 30]);
    for (const text of ["", "1 2", "1 2 3 4", "1 2 x"]) expect(parsePosition(text)).toBeNull();
  });
});

describe("aboutUnsaved", () => {
  it("saysWhichOfBothIsNewer", () => {
    const file = { name: "a.unsaved.lumen", written_ms: 0, newer: true };
    expect(aboutUnsaved(file, "a.lumen")).toContain("after a.lumen");
    expect(aboutUnsaved({ ...file, newer: false }, "a.lumen")).toContain(
      "a.lumen has been written since and is newer",
    );
  });
});
