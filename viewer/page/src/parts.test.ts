// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { holdsSeeds } from "./actions";
import { branchColour, fromHex, mapColour, toHex, usualRange } from "./colour";
import { locate, pointAt, makeFlightPath } from "./flight";
import { marchTetrahedra } from "./local_model";
import { findPlaces } from "./narrowing";
import { requestFor } from "./one_source";
import { distanceText } from "./probe_line";
import { niceLength } from "./slice_overlay";
import { fromBase64 } from "./source_embedded";
import { Store } from "./store";
import { straighten } from "./straightened";
import { sampleTree } from "./sample_tree";
import { isCursorShown } from "./selection";
import { vertexNormals } from "./surface";
import { circle, dot, sub } from "./vec";

describe("findPlaces", () => {
  const s = Array.from({ length: 81 }, (_, i) => i / 2),
    at = (radius: (s: number) => number): ReturnType<typeof findPlaces> => findPlaces(s, s.map(radius));
  it("marksAStenosisWithTheShareThatIsMissing", () => {
    const places = at(x => (Math.abs(x - 20) < 1.1 ? 1 : 2));
    expect(places.map(p => p.kind)).toEqual(["stenosis"]);
    expect(places[0].share).toBeCloseTo(0.5, 6);
    expect([s[places[0].from], s[places[0].to]]).toEqual([19, 21]);
  });
  it("marksADilation", () => {
    expect(at(x => (Math.abs(x - 20) < 2 ? 4 : 2)).map(p => p.kind)).toEqual(["dilation"]);
  });
  it("marksNothingThatDiffersByLessThanAVoxel", () => {
    const r = s.map(x => (Math.abs(x - 20) < 1.1 ? 0.2 : 0.4));
    expect(findPlaces(s, r, 0.3).map(p => p.kind)).toEqual(["stenosis"]);
    expect(findPlaces(s, r, 0.5)).toEqual([]);
  });
  it("doesNotMarkATaper", () => {
    expect(at(x => 3 - 0.05 * x)).toEqual([]);
  });
  it("doesNotMarkAnEndThatPetersOut", () => {
    expect(at(x => (x > 38.4 ? 0.5 : 2))).toEqual([]);
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
describe("circle", () => {
  it("isClosedAndLiesInItsPlane", () => {
    const line = circle([1, 2, 3], 2, [1, 0, 0], [0, 0, 1]);
    expect(line[0][0]).toBeCloseTo(3, 9);
    expect(line.at(-1)![2]).toBeCloseTo(line[0][2], 9);
    for (const p of line) {
      expect(p[1]).toBe(2);
      expect(Math.hypot(p[0] - 1, p[2] - 3)).toBeCloseTo(2, 9);
    }
  });
});
describe("distanceText", () => {
  it("showsAllDigitsOfADistanceThatIsFound", () => {
    expect(distanceText({ distance: -3.99128, converged: true })).toBe("−3.991 mm");
    expect(distanceText({ distance: 0.5, converged: true })).toBe("+0.500 mm");
  });
  it("showsTwoOfOneThatIsNot", () => {
    expect(distanceText({ distance: -3.53, converged: false })).toBe("about −3.5 mm");
  });
});
describe("isCursorShown", () => {
  const tree = sampleTree(),
    at = tree.position(1);
  it("isTrueInTheLumenOfTheCursorsNode", () => {
    expect(isCursorShown({ posed: null, tree, node: 1, crosshair: at })).toBe(true);
  });
  it("isFalseBesideItAndWithoutACursor", () => {
    const beside: [number, number, number] = [at[0] + 1.1 * tree.radius[1], at[1], at[2]];
    expect(isCursorShown({ posed: null, tree, node: 1, crosshair: beside })).toBe(false);
    expect(isCursorShown({ posed: null, tree, node: -1, crosshair: at })).toBe(false);
    expect(isCursorShown({ posed: null, tree: null, node: 1, crosshair: at })).toBe(false);
  });
});
describe("requestFor", () => {
  const files = [
    { id: 4, kind: "volume", name: "a.nrrd", changed: false, named: true },
    { id: 7, kind: "case", name: "b.lumen", changed: false, named: true },
  ];
  it("closesTheFileOfTheAnswer", () => {
    expect(requestFor("volume", { files })).toEqual({ op: "closeFile", id: 4 });
    expect(requestFor("case", { files })).toEqual({ op: "closeFile", id: 7 });
    expect(requestFor("accept", { files })).toEqual({ op: "acceptVolume" });
  });
  it("asksForNothingWithoutAnAnswer", () => {
    expect(requestFor(null, { files })).toBeNull();
    expect(requestFor("case", { files: files.slice(0, 1) })).toBeNull();
  });
});
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
    for (let i = 0; i < p.length; i += 3)
      expect(Math.abs(Math.hypot(p[i], p[i + 1], p[i + 2]) - r)).toBeLessThan(0.02);
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
describe("vertexNormals", () => {
  it("pointOutOfATetrahedron", () => {
    const normal = vertexNormals(
      new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]),
      new Uint32Array([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]),
    );
    expect(Array.from(normal.slice(0, 3))).toEqual([-1, -1, -1]);
  });
});
describe("straighten", () => {
  it("stepsEvenlyWithASideThatStaysAcross", () => {
    const tree = sampleTree(),
      straight = straighten(tree, 0, 21);
    expect(straight.at.at(-1)).toBe(10);
    expect(straight.path[5][2]).toBeCloseTo(2.5, 9);
    for (const side of straight.side) {
      expect(side[2]).toBeCloseTo(0, 9);
      expect(dot(side, straight.side[0])).toBeCloseTo(1, 9);
    }
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
describe("niceLength", () => {
  it("isOneTwoOrFive", () => {
    expect(
      [niceLength(0.1, 100), niceLength(0.03, 100), niceLength(0.7, 100)].map(x => Number(x.toPrecision(3))),
    ).toEqual([10, 2, 50]);
  });
});
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
});
describe("fromBase64", () => {
  it("givesTheBytes", () => {
    expect(Array.from(fromBase64("AAEC/w=="))).toEqual([0, 1, 2, 255]);
  });
  it("passesOverWhiteSpace", () => {
    expect(Array.from(fromBase64("AAEC\n/w=="))).toEqual([0, 1, 2, 255]);
  });
});
describe("Store", () => {
  it("callsOnlyWatchersOfTheKey", () => {
    const store = new Store({ a: 1, b: 1 }),
      seen: string[] = [];
    store.watch(["a"], v => seen.push(`a${v.a}`));
    store.watch(["b"], v => seen.push(`b${v.b}`));
    store.set({ a: 2, b: 1 });
    expect(seen).toEqual(["a1", "b1", "a2"]);
  });
  it("letsWatchersSetAndEnds", () => {
    const store = new Store({ a: 0, b: 0 });
    store.watch(["a"], v => store.set({ b: 2 * v.a }));
    const stop = store.watch(["b"], () => undefined);
    store.set({ a: 4 });
    expect(store.get().b).toBe(8);
    stop();
  });
  it("throwsWhereWatchersNeverEnd", () => {
    const store = new Store({ a: 0 });
    store.watch(["a"], v => {
      if (v.a > 0) store.set({ a: v.a + 1 });
    });
    expect(() => store.set({ a: 1 })).toThrow(/without end/);
  });
});
