// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { aboutOthers, aboutSeries } from "./series_dialog";
import type { DicomSeries } from "./types";

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
