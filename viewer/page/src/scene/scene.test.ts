// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { dot, sub } from "../base/vec";
import { locate, makeFlightPath, pointAt } from "./flight";
import { marchTetrahedra } from "./local_model";

describe("marchTetrahedra", () => {
  it("givesABallsAreaAndKeepsToItsSurface", () => {
    const n = 25,
      step = 0.25,
      value = new Float64Array(n ** 3),
      r = 2;
    for (let k = 0, at = 0; k < n; ++k)
      for (let j = 0; j < n; ++j)
        for (let i = 0; i < n; ++i, ++at)
          value[at] = Math.hypot(-3 + i * step, -3 + j * step, -3 + k * step) - r;
    const p = marchTetrahedra(value, n, [-3, -3, -3], step);
    let off = 0;
    for (let i = 0; i < p.length; i += 3)
      off = Math.max(off, Math.abs(Math.hypot(p[i], p[i + 1], p[i + 2]) - r));
    expect(off).toBeLessThan(0.02);
    let area = 0;
    for (let i = 0; i < p.length; i += 9) {
      const [a, b, c] = [0, 3, 6].map(
          o => [p[i + o], p[i + o + 1], p[i + o + 2]] as [number, number, number],
        ),
        u = sub(b, a),
        v = sub(c, a);
      area += 0.5 * Math.sqrt(dot(u, u) * dot(v, v) - dot(u, v) ** 2);
    }
    expect(Math.abs(area / (4 * Math.PI * r * r) - 1)).toBeLessThan(0.02);
  });
});

describe("makeFlightPath", () => {
  it("findsPointsByLength", () => {
    const path = makeFlightPath(
      [
        [0, 0, 0],
        [1, 0, 0],
        [2, 0, 0],
        [3, 0, 0],
      ],
      [0, 1, 2, 3],
    );
    expect(pointAt(path, 1.25)).toEqual([1.25, 0, 0]);
    expect(locate(path, 99)).toEqual({ i: 2, share: 1 });
  });
});
