// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { mapColour } from "../base/colour";
import { deviationOf, deviationText, kDeviationMap, sharedRange, type Deviation } from "./deviation";
import { makePack, Pack } from "./pack";

const pack = (distance: number[], figures: Record<string, unknown>): Pack =>
  new Pack(
    makePack(
      { figures },
      { distance_mm: { type: "f32", shape: [distance.length], data: Float32Array.from(distance) } },
    ),
  );
const made = (name: string, distance: number[]): Deviation =>
  deviationOf(pack(distance, { median_mm: 0.123, percentile90_mm: 12.34 }), name, distance.length);

describe("deviationOf", () => {
  it("takesDistancesAndFigures", () => {
    const deviation = made("wall.stl", [-1, 0.5]);
    expect(Array.from(deviation.distance)).toEqual([-1, 0.5]);
    expect(deviationText(deviation)).toBe("median 0.12 mm, 90 % within 12.3 mm");
  });
  it("refusesThoseOfAnotherMeshAndFiguresThatAreNone", () => {
    const good = { median_mm: 1, percentile90_mm: 2 };
    expect(() => deviationOf(pack([1, 2], good), "wall.stl", 3)).toThrow(/wall\.stl/);
    expect(() => deviationOf(pack([1], { ...good, median_mm: null }), "wall.stl", 1)).toThrow(/wall\.stl/);
  });
});

describe("sharedRange", () => {
  it("isSymmetricAndHoldsAllMeshes", () => {
    const [low, high] = sharedRange([made("a", [-0.5, 0.1, 0.2]), made("b", [-0.1, 2, 1])]);
    expect(low).toBe(-2);
    expect(high).toBe(2);
  });
  it("isARangeForAMeshOnTheWallAsWell", () => {
    const [low, high] = sharedRange([made("a", [0, 0])]);
    expect(high).toBeGreaterThan(low);
    expect(low).toBe(-high);
  });
});

describe("the map of deviations", () => {
  // G. Machado et al., 2009: what people with deuteranopia see, in linear sRGB
  const kDeuteranopia = [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ];
  const seen = (share: number): number[] => {
    const rgb = mapColour(kDeviationMap, share).map(x =>
      x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4,
    );
    return kDeuteranopia.map(row => row.reduce((sum, x, i) => sum + x * rgb[i], 0));
  };
  const lightness = (share: number): number => {
    const [r, g, b] = seen(share);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  it("tellsInsideFromOutsideWithDeuteranopia", () => {
    for (const share of [0, 0.1, 0.2, 0.3]) {
      const inside = seen(share),
        outside = seen(1 - share);
      expect(inside[2] - inside[0]).toBeGreaterThan(0.1); // bluish
      expect(outside[0] - outside[2]).toBeGreaterThan(0.1); // yellowish
    }
  });
  it("isLightestOnTheWallAndDarkerTheFartherFromIt", () => {
    for (let i = 0; i < 5; ++i) {
      expect(lightness(i / 10)).toBeLessThan(lightness((i + 1) / 10));
      expect(lightness(1 - i / 10)).toBeLessThan(lightness(1 - (i + 1) / 10));
    }
  });
});
