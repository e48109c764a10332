// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { branchColour, fromHex, kSystems, mapColour, systemColour, toHex, usualRange } from "./colour";

describe("colours", () => {
  it("comeBackFromHex", () => {
    expect(toHex(fromHex("#1668c7"))).toBe("#1668c7");
  });
  it("differBetweenNeighbours", () => {
    for (let i = 0; i < 40; ++i)
      expect(Math.hypot(...[0, 1, 2].map(k => branchColour(i)[k] - branchColour(i + 1)[k]))).toBeGreaterThan(
        0.15,
      );
  });
  it("differBetweenNearPlacesOfTheListWithDeuteranopiaToo", () => {
    const linear = (x: number): number => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4),
      times = (m: number[][], v: number[]): number[] =>
        m.map(row => row.reduce((sum, x, i) => sum + x * v[i], 0));
    const kDeuteranopia = [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.01182, 0.04294, 0.968881],
      ],
      kLms = [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
      ],
      kLab = [
        [0.2104542553, 0.793617785, -0.0040720468],
        [1.9779984951, -2.428592205, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.808675766],
      ];
    const lab = (rgb: number[]): number[] => times(kLab, times(kLms, rgb).map(Math.cbrt)),
      seen = (rgb: number[]): number[] => times(kDeuteranopia, rgb).map(x => Math.min(1, Math.max(0, x)));
    const least = (eye: (rgb: number[]) => number[], places: number): number => {
      const all = Array.from({ length: 24 }, (_, i) => lab(eye(branchColour(i).map(linear))));
      return Math.min(
        ...all.flatMap((a, i) =>
          all.slice(i + 1, i + 1 + places).map(b => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2])),
        ),
      );
    };
    expect(least(rgb => rgb, 4)).toBeGreaterThan(0.14);
    expect(least(rgb => rgb, 12)).toBeGreaterThan(0.06);
    expect(least(seen, 4)).toBeGreaterThan(0.08);
  });
  it("beginAndEndAsTheMap", () => {
    expect(mapColour("sequential", -1)).toEqual([0.267, 0.005, 0.329]);
    expect(mapColour("sequential", 2)).toEqual([0.993, 0.906, 0.144]);
  });
});

describe("usualRange", () => {
  it("leavesOutNoNumbersAndExtremes", () => {
    expect(usualRange([...Array.from({ length: 200 }, (_, i) => i), NaN, 1e9])).toEqual([2, 198]);
  });
  it("isSymmetricIfAsked", () => {
    expect(usualRange([-1, 0, 3], true)).toEqual([-3, 3]);
  });

  it("gives systems hues of their own, and unknown ones none", () => {
    expect(systemColour("unknown", 3)).toBeNull();
    expect(systemColour(undefined, 3)).toBeNull();
    const [artery, vein] = ["artery", "vein"].map(name => systemColour(name, 1)!);
    expect(artery[0]).toBeGreaterThan(artery[2] + 0.3); // red
    expect(vein[2]).toBeGreaterThan(vein[0] + 0.3); // blue
    for (const [i, a] of kSystems.slice(1).entries())
      for (const b of kSystems.slice(i + 2))
        expect(
          Math.hypot(...[0, 1, 2].map(k => systemColour(a, 2)![k] - systemColour(b, 2)![k])),
        ).toBeGreaterThan(0.2);
  });
});
