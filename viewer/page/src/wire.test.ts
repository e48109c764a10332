// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Model } from "../../../libblob/wasm/blob.mjs";
import { kBand, solveBanded } from "./banded";
import { kWire, Wire } from "./wire";

const kRadius = 2,
  kBendRadius = 20; // mm of a tube that goes straight up z to 10 mm and then round a quarter circle to +x

/** Distance to that tube's wall and its normal. */
function tube(p: number[]): { distance: number; normal: number[] } {
  let away: number[];
  if (p[2] < 10) away = [p[0], p[1], 0];
  else {
    const x = p[0] - kBendRadius,
      z = p[2] - 10,
      ring = Math.hypot(x, z) || 1,
      f = 1 - kBendRadius / ring;
    away = [x * f, p[1], z * f];
  }
  const r = Math.hypot(...away) || 1e-9;
  return { distance: r - kRadius, normal: away.map(a => a / r) };
}

/** Functions of libblob that the wire uses, with the answers of that tube. */
function model(): Model {
  return {
    batch: (count: number) => {
      const buffer = new ArrayBuffer(count * 100),
        points = new Float64Array(buffer, 0, 3 * count),
        answers = new Float64Array(buffer, 24 * count, 9 * count);
      return {
        buffer,
        address: 0,
        points,
        cursors: new Uint32Array(count),
        free: () => undefined,
        query: () => {
          for (let i = 0; i < count; ++i) {
            const { distance, normal } = tube(Array.from(points.subarray(3 * i, 3 * i + 3)));
            answers.set([0, 0, 0, 0, distance, ...normal], 9 * i);
          }
        },
      };
    },
  } as unknown as Model;
}

describe("solveBanded", () => {
  it("solvesWhatItMultiplies", () => {
    const n = 12,
      lower = new Float64Array(n * kBand),
      full = Array.from({ length: n }, () => new Array<number>(n).fill(0)),
      x = Array.from({ length: n }, (_, i) => i - 4.5);
    for (let i = 0; i < n; ++i)
      for (let j = Math.max(0, i - 8); j <= i; ++j) {
        full[i][j] = full[j][i] = i === j ? 20 : Math.cos(i + 3 * j);
        lower[kBand * i + kBand - 1 - (i - j)] = full[i][j];
      }
    const b = Float64Array.from(full, row => row.reduce((sum, a, j) => sum + a * x[j], 0));
    expect(solveBanded(n, lower, b)).toBe(true);
    b.forEach((value, i) => expect(value).toBeCloseTo(x[i], 10));
  });
  it("refusesWhatIsNotPositiveDefinite", () => {
    expect(solveBanded(1, new Float64Array(kBand).fill(-1), new Float64Array(1))).toBe(false);
  });
});

describe("Wire", () => {
  const wire = new Wire(model(), [0, 0, 0], [0, 0, 1], 0, { ...kWire, count: 80, spacing: 0.5, radius: 0.2 });
  for (let i = 0; i < 240; ++i) wire.step(0.15, 0.01);

  it("followsABendWithoutLeavingTheLumen", () => {
    expect(wire.tip[0]).toBeGreaterThan(10);
    for (let i = 0; i < wire.free; ++i) expect(tube(wire.at(i)).distance).toBeLessThan(0);
  });
  it("keepsItsLength", () => {
    for (let i = 0; i + 1 < wire.free; ++i)
      expect(Math.hypot(...[0, 1, 2].map(a => wire.at(i)[a] - wire.at(i + 1)[a]))).toBeCloseTo(0.5, 2);
  });
  it("pressesOnTheWallOnlyWhereItTouches", () => {
    expect(wire.contacts).toBeGreaterThan(0);
    expect(wire.contacts).toBeLessThan(wire.free);
  });
  it("comesBackWhenPulled", () => {
    for (let i = 0; i < 200; ++i) wire.step(-0.15, 0);
    expect(wire.inserted).toBeLessThan(10);
    expect(wire.tip[2]).toBeLessThan(10);
  });
});
