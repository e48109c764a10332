// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { readView, takeView } from "./kept_view";
import { kInitial } from "./model";
import { kMostSamples, kNoSlabs, pickInSlab, samplesOf, throughOf } from "./slab";
import type { Vec3 } from "../base/types";
import type { Volume } from "../case/volume";

const frame = { right: [1, 0, 0] as Vec3, up: [0, -1, 0] as Vec3, normal: [0, 0, -1] as Vec3 };

/** Brightness 100 - |z - 3| and nothing beyond 10 mm. */
const volume = {
  spacing: [1, 1, 0.5],
  sample: (p: Vec3) => (Math.abs(p[2]) > 10 ? NaN : 100 - Math.abs(p[2] - 3)),
} as unknown as Volume;

describe("slabs", () => {
  it("take what is drawn: the brightest of a maximum and of a mean, the darkest of a minimum", () => {
    for (const kind of ["max", "mean"] as const)
      expect(pickInSlab(volume, { kind, mm: 8 }, [1, 2, 0], frame.normal)[2]).toBeCloseTo(3, 6);
    expect(pickInSlab(volume, { kind: "min", mm: 8 }, [1, 2, 0], frame.normal)).toEqual([1, 2, -4]);
  });
  it("take the place itself in a plane, beyond their thickness, and outside of the volume", () => {
    expect(pickInSlab(volume, { kind: "off", mm: 8 }, [1, 2, 0], frame.normal)).toEqual([1, 2, 0]);
    expect(pickInSlab(volume, { kind: "max", mm: 4 }, [1, 2, 0], frame.normal)[2]).toBeCloseTo(2, 6);
    expect(pickInSlab(volume, { kind: "max", mm: 4 }, [1, 2, 50], frame.normal)).toEqual([1, 2, 50]);
  });
  it("are sampled twice a voxel, and not more often than a picture may take", () => {
    expect(samplesOf({ kind: "max", mm: 4 }, [1, 1, 0.5])).toBe(17);
    expect(samplesOf({ kind: "off", mm: 4 }, [1, 1, 0.5])).toBe(1);
    expect(samplesOf({ kind: "mean", mm: 200 }, [1, 1, 0.5])).toBe(kMostSamples);
    expect(throughOf({ kind: "max", mm: 4 }, frame)).toEqual([0, 0, -2]);
  });
  it("are kept with the view, and older view files and foreign kinds do no harm", () => {
    const kept = takeView({
      ...kInitial,
      slices: { ...kInitial.slices, slabs: { ...kNoSlabs, axial: { kind: "min", mm: 7 } } },
    });
    expect(readView(JSON.stringify(kept)).slabs.axial).toEqual({ kind: "min", mm: 7 });
    expect(readView(JSON.stringify({ ...kept, slabs: undefined })).slabs).toEqual(kNoSlabs);
    const foreign = { ...kNoSlabs, axial: { kind: "median", mm: 7 } };
    expect(() => readView(JSON.stringify({ ...kept, slabs: foreign }))).toThrow(/slabs/);
  });
});
