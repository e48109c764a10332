// SPDX-License-Identifier: Apache-2.0
import { gunzipSync, gzipSync } from "node:zlib";
import { describe, expect, it } from "vitest";
import { cropped, halved } from "./smaller_volume";
import { readVolumeHeader } from "./volume_header";

/** 4 x 4 x 5 voxels, each with 100 k + 10 j + i, of 1 x 2 x 3 mm from (10, 20, 30). */
const voxels = Int16Array.from({ length: 80 }, (_, n) => 100 * (n >> 4) + 10 * ((n >> 2) & 3) + (n & 3));

function nrrd(encoding: "raw" | "gzip"): File {
  const bytes = new Uint8Array(voxels.buffer);
  return new File(
    [
      "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 4 4 5\nendian: little\n" +
        `encoding: ${encoding}\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (10,20,30)\n\n`,
      encoding === "gzip" ? gzipSync(bytes) : bytes,
    ],
    "a.nrrd",
  );
}

function nifti(little: boolean, isPacked: boolean): File {
  const bytes = new Uint8Array(352 + 160),
    view = new DataView(bytes.buffer);
  view.setInt32(0, 348, little);
  [3, 4, 4, 5, 1].forEach((n, i) => view.setInt16(40 + 2 * i, n, little));
  view.setInt16(70, 4, little);
  [1, 1, 2, 3].forEach((n, i) => view.setFloat32(76 + 4 * i, n, little));
  view.setFloat32(108, 352, little);
  view.setFloat32(264, 1, little); // half a turn about z
  [10, 20, 30].forEach((n, i) => {
    view.setFloat32(268 + 4 * i, n, little);
    view.setFloat32(292 + 16 * i, n, little);
    view.setFloat32(280 + 20 * i, [-1, -2, 3][i], little);
  });
  voxels.forEach((value, n) => view.setInt16(352 + 2 * n, value, little));
  return new File([isPacked ? gzipSync(bytes) : bytes], isPacked ? "a.nii.gz" : "a.nii");
}

const means = [0, 2, 20, 22, 200, 202, 220, 222].map(first => Math.round(first + 55.5));

describe("halved", () => {
  it.each(["raw", "gzip"] as const)("takesMeansOfEightAndMovesTheFirstVoxelOfNrrd%s", async encoding => {
    const file = nrrd(encoding),
      header = (await readVolumeHeader(file.name, file))!;
    const text = await (await halved(file, header)).text();
    expect(text).toContain("sizes: 2 2 2\n");
    expect(text).toContain("encoding: raw\n");
    expect(text).toContain("space directions: (2,0,0) (0,4,0) (0,0,6)\nspace origin: (10.5,21,31.5)\n");
    const bytes = new Uint8Array(await (await halved(file, header)).arrayBuffer());
    expect([...new Int16Array(bytes.slice(-16).buffer)]).toEqual(means);
  });
  it.each([true, false])("keepsTheOrderOfBytesAndBothPlacesOfNifti%s", async little => {
    const file = nifti(little, little),
      header = (await readVolumeHeader(file.name, file))!;
    const bytes = new Uint8Array(await (await halved(file, header)).arrayBuffer()),
      view = new DataView(bytes.buffer),
      number = (at: number): number => view.getFloat32(at, little);
    expect([42, 44, 46].map(at => view.getInt16(at, little))).toEqual([2, 2, 2]);
    expect([80, 84, 88].map(number)).toEqual([2, 4, 6]);
    expect([268, 272, 276].map(number)).toEqual([9.5, 19, 31.5]);
    expect([292, 308, 324].map(number)).toEqual([9.5, 19, 31.5]);
    expect([280, 300, 320].map(number)).toEqual([-2, -4, 6]);
    expect(means.map((_, n) => view.getInt16(352 + 2 * n, little))).toEqual(means);
  });
});

describe("cropped", () => {
  it("keepsTheSlicesAndTheirPlace", async () => {
    const file = nifti(true, true),
      header = (await readVolumeHeader(file.name, file))!;
    const bytes = new Uint8Array(await (await cropped(file, header, 1, 3)).arrayBuffer()),
      view = new DataView(bytes.buffer);
    expect([42, 44, 46].map(at => view.getInt16(at, true))).toEqual([4, 4, 3]);
    expect(view.getFloat32(276, true)).toBe(33);
    expect([...new Int16Array(bytes.slice(352).buffer)]).toEqual([...voxels.slice(16, 64)]);
  });
  it("reportsAFileThatBreaksOff", async () => {
    const whole = gunzipSync(new Uint8Array(await nifti(true, true).arrayBuffer())),
      file = new File([whole.subarray(0, 352 + 100)], "a.nii"),
      header = (await readVolumeHeader(file.name, file))!;
    await expect(cropped(file, header, 1, 4)).rejects.toThrow("breaks off");
  });
});

describe("readVolumeHeader", () => {
  it("leavesOtherFilesToTheEngine", async () => {
    for (const file of [
      new File(["NRRD0004\nsizes: 4\n\n"], "a.nrrd"),
      new File(["no"], "a.nii.gz"),
      new File(["x".repeat(400)], "a.nii"),
      new File([], "a.mha"),
    ])
      expect(await readVolumeHeader(file.name, file)).toBeNull();
  });
});
