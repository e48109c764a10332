// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { inOrder } from "./named_files";

describe("inOrder", () => {
  const parts = (...names: string[]): string[] =>
    inOrder(names.map(name => ({ name }))).map(({ name, as }) => `${name} ${as}`);
  it("beginsWithVolumesAndEndsWithSeeds", () => {
    expect(parts("seeds.json", "wall.stl", "a.lumen", "ct.nii.gz")).toEqual([
      "ct.nii.gz auto",
      "a.lumen auto",
      "wall.stl auto",
      "seeds.json auto",
    ]);
  });
  it("makesASecondCaseTheTruthAndASecondVolumeTheSecond", () => {
    expect(parts("b.lumen.json", "mr.nrrd", "a.lumen", "ct.nrrd")).toEqual([
      "mr.nrrd auto",
      "ct.nrrd second",
      "b.lumen.json auto",
      "a.lumen truth",
    ]);
  });
});
