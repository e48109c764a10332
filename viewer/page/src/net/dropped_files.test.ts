// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { divide, holdsSeeds, isDicom, isLabelMap, isVolume } from "./dropped_files";

const marked = (name: string): File => new File([new Uint8Array(128), "DICM", "more"], name);
const plain = (name: string): File => new File(["x".repeat(200)], name);

describe("isDicom", () => {
  it("goesByTheMarkOrTheEnding", async () => {
    expect(await isDicom(marked("IM0001"))).toBe(true);
    expect(await isDicom(plain("IM0001"))).toBe(false);
    expect(await isDicom(plain("a.DCM"))).toBe(true);
    expect(await isDicom(new File(["DICM"], "short"))).toBe(false);
  });
});

describe("divide", () => {
  const names = (files: File[]): string[] => files.map(f => f.name);
  it("leavesFilesThatWereDroppedByThemselvesApart", async () => {
    const { dicom, others } = await divide({ files: [marked("a"), plain("case.lumen")], inFolders: [] });
    expect(names(dicom)).toEqual(["a"]);
    expect(names(others)).toEqual(["case.lumen"]);
  });
  it("takesAllFilesOfAFolderThatHoldsDicom", async () => {
    const { dicom, others } = await divide({ files: [], inFolders: [plain("README"), marked("a")] });
    expect(names(dicom)).toEqual(["README", "a"]);
    expect(others).toEqual([]);
  });
  it("leavesAFolderWithoutDicomToTheOthers", async () => {
    const { dicom, others } = await divide({ files: [], inFolders: [plain("wall.stl")] });
    expect(dicom).toEqual([]);
    expect(names(others)).toEqual(["wall.stl"]);
  });
});

describe("holdsSeeds", () => {
  it("knowsSeedsByTheirNameOrTheirFirstText", () => {
    expect(holdsSeeds("F.mrk.json", "")).toBe(true);
    expect(holdsSeeds("F.FCSV", "")).toBe(true);
    expect(holdsSeeds("seeds.json", '{"branches": [')).toBe(true);
    expect(holdsSeeds("case.lumen.json", '{"format": "lumen", "tree": {"branches": [')).toBe(false);
    expect(holdsSeeds("volume.nrrd", '"branches":')).toBe(false);
  });
});

describe("isVolume", () => {
  it("goesByTheNameOfAFile", () => {
    for (const name of ["a.nrrd", "a.nii", "a.nii.gz", "A.MHA"]) expect(isVolume(name)).toBe(true);
    for (const name of ["a.lumen", "a.gz", "nrrd", "a.vtp"]) expect(isVolume(name)).toBe(false);
  });
});

describe("isLabelMap", () => {
  it("goesByWordsOfTheName", () => {
    for (const name of ["ct.seg.nrrd", "Labels.nii.gz", "sub-1_dseg.nii.gz", "SEGMENTATION.nii", "mask.mha"])
      expect(isLabelMap(name)).toBe(true);
    for (const name of ["ct.nrrd", "segou.nii", "labels.csv", "dseg.tsv", "stent-ct.nrrd"])
      expect(isLabelMap(name)).toBe(false);
  });
});
