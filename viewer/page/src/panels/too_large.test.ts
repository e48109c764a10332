// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { holdsVoxels, neededBytes, slicesIn } from "./too_large";

describe("neededBytes", () => {
  it("countsTheFileItsVoxelsAndTheWorkOnThem", () => {
    expect(neededBytes([100, 10, 10], 2, 500)).toBe(500 + 16 * 10_000);
  });
});

describe("holdsVoxels", () => {
  it("leavesAFileThatIsTooShortForItsHeaderToTheEngine", () => {
    const header = {
      size: [100, 100, 100] as number[],
      type: "int16" as const,
      begin: 352,
      packing: "none" as const,
    };
    expect(holdsVoxels(header, 2_000_352)).toBe(true);
    expect(holdsVoxels(header, 2_000_351)).toBe(false);
    expect(holdsVoxels({ ...header, packing: "all" }, 2000)).toBe(true);
    expect(holdsVoxels({ ...header, packing: "voxels" }, 1000)).toBe(false);
  });
});

describe("slicesIn", () => {
  it("readsTwoNumbersThatPeopleCountFromOne", () => {
    expect(slicesIn("1-40", 80)).toEqual({ first: 0, last: 39 });
    expect(slicesIn(" 3 – 80 ", 80)).toEqual({ first: 2, last: 79 });
    for (const words of ["", "5", "0-4", "9-2", "1-81", "a-b"]) expect(slicesIn(words, 80)).toBeNull();
  });
});
