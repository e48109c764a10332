// SPDX-License-Identifier: Apache-2.0
/** The smoothed curve of a vessel's axis, as far as lengths along it need it: that of the server
 * (converters/judge/measure/smooth_axis.cpp), without the torsion in the correction of the curvature, which changes lengths by
 * less than a micrometre. */
import type { Vec3 } from "../base/types";
import { add, cross, scale, sub } from "../base/vec";

const kSmoothingRadii = 6, // half-width of the smoothing window, in local radii
  kMostTerms = 6, // of a polynomial of fifth degree
  kFewestNodes = 15, // nodes of a window
  kGridRadii = 0.3, // step of the table of arc lengths, in local radii
  kMostPieces = 16, // of that table between two nodes
  kLeastWeight = 1e-6, // of the nodes at the rims of a short window
  kCurvatureLoss = 6.4e-4, // share that the fit takes away, over (half-width x curvature)^4
  kMostCorrection = 0.1;

/** As the server rounds it: a window of half a vessel reaches to its last node or not by the last digit, and then has another degree. */
const length = ([x, y, z]: Vec3): number => Math.sqrt(x * x + (y * y + z * z));
const distance = (a: Vec3, b: Vec3): number => length(sub(a, b));
const biweight = (x: number): number => Math.max(0, 1 - x * x) ** 2;
const clamp = (x: number, low: number, high: number): number => Math.min(Math.max(x, low), high);

/** The first place of an ascending list, from `first` to `last`, whose number is above x, or with `orEqual` not below it. */
function firstAbove(
  list: readonly number[],
  x: number,
  first: number,
  last: number,
  orEqual = false,
): number {
  let low = first,
    high = last;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (orEqual ? list[middle] < x : list[middle] <= x) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** A place of a list of steps: the number of the step's end, and the share of the step. */
function stepAt(list: readonly number[], x: number): [end: number, share: number] {
  const end = firstAbove(list, x, 1, list.length - 1),
    span = list[end] - list[end - 1];
  return [end, span > 0 ? clamp((x - list[end - 1]) / span, 0, 1) : 0];
}

/** Solves a system with a symmetric positive definite matrix, row by row, for three right sides. Changes both. */
function solve(a: number[][], right: number[][]): void {
  const n = a.length;
  for (let k = 0; k < n; ++k)
    for (let i = k + 1; i < n; ++i) {
      const f = a[i][k] / a[k][k];
      for (let j = k; j < n; ++j) a[i][j] -= f * a[k][j];
      for (let c = 0; c < 3; ++c) right[i][c] -= f * right[k][c];
    }
  for (let k = n; k-- > 0; )
    for (let c = 0; c < 3; ++c) {
      for (let j = k + 1; j < n; ++j) right[k][c] -= a[k][j] * right[j][c];
      right[k][c] /= a[k][k];
    }
}

interface Place {
  position: Vec3;
  curvature: number; // 1/mm
}

export class SmoothAxis {
  private readonly chord: number[] = [0]; // along the nodes, mm: the parameter of the fits
  private readonly half: number[]; // half-width at each node, mm
  private readonly grid: number[] = [0]; // parameters and their arc lengths
  private readonly arc: number[] = [0];

  /** Needs at least two nodes at different places, mm. */
  constructor(
    private readonly position: readonly Vec3[],
    private readonly radius: readonly number[],
  ) {
    for (let i = 1; i < position.length; ++i)
      this.chord.push(this.chord[i - 1] + distance(position[i - 1], position[i]));
    this.half = position.map((_, i) => this.halfOf(i));
    this.findArcs();
  }

  /** mm */
  get length(): number {
    return this.arc.at(-1)!;
  }
  /** Arc length at a node, mm. */
  alongOf(node: number): number {
    const [end, share] = stepAt(this.grid, this.chord[node]);
    return this.arc[end - 1] + share * (this.arc[end] - this.arc[end - 1]);
  }
  /** The place at an arc length, mm. */
  at(along: number): Vec3 {
    const [end, share] = stepAt(this.arc, along);
    return this.placeAt(this.grid[end - 1] + share * (this.grid[end] - this.grid[end - 1])).position;
  }

  /** Half-widths follow the mean radius within one window of the node. */
  private halfOf(i: number): number {
    const { chord, radius } = this,
      reach = kSmoothingRadii * radius[i],
      side = (kFewestNodes >> 1) + 1;
    let sum = radius[i],
      weights = 1;
    for (const by of [1, -1])
      for (let k = i + by; k >= 0 && k < chord.length && Math.abs(chord[k] - chord[i]) < reach; k += by) {
        const w = biweight((chord[k] - chord[i]) / reach);
        sum += w * radius[k];
        weights += w;
      }
    const enough = Math.min(
      i >= side ? chord[i] - chord[i - side] : 0,
      i + side < chord.length ? chord[i + side] - chord[i] : 0,
    );
    return Math.max(
      Math.min(Math.max((kSmoothingRadii * sum) / weights, enough), chord.at(-1)! / 2),
      Number.MIN_VALUE,
    );
  }

  /** The half-width of a window, which grows to the other side where an end cuts it off. */
  private halfAt(chord: number): number {
    const [end, share] = stepAt(this.chord, chord),
      half = (1 - share) * this.half[end - 1] + share * this.half[end],
      missing = Math.max(0, half - chord, half - (this.chord.at(-1)! - chord));
    return half + Math.min(missing, half);
  }

  private placeAt(chord: number): Place {
    const half = this.halfAt(chord),
      first = firstAbove(this.chord, chord - half, 0, this.chord.length, true),
      last = firstAbove(this.chord, chord + half, first, this.chord.length),
      terms = clamp((last - first + 1) >> 1, 2, kMostTerms),
      origin = this.position[first],
      a = Array.from({ length: terms }, () => new Array<number>(terms).fill(0)),
      c = Array.from({ length: Math.max(terms, 3) }, (): Vec3 => [0, 0, 0]); // coefficients, in units of the half-width
    for (let k = first; k < last; ++k) {
      const x = (this.chord[k] - chord) / half,
        w = Math.max(biweight(x), kLeastWeight),
        row = [1];
      for (let i = 1; i < terms; ++i) row.push(row[i - 1] * x);
      for (let i = 0; i < terms; ++i) {
        for (let j = 0; j < terms; ++j) a[i][j] += w * row[i] * row[j];
        for (let axis = 0; axis < 3; ++axis)
          c[i][axis] += w * row[i] * (this.position[k][axis] - origin[axis]);
      }
    }
    solve(a, c);
    const d1 = scale(c[1], 1 / half),
      d2 = scale(c[2], 2 / half ** 2),
      speed = length(d1),
      curvature = speed > 0 ? length(cross(d1, d2)) / speed ** 3 : 0,
      loss = kCurvatureLoss * (half * curvature) ** 4;
    return {
      position: add(c[0], origin),
      curvature: curvature * (1 + Math.min(loss, kMostCorrection)),
    };
  }

  /** Chords of the curve, each lengthened to the arc of its curvature. */
  private findArcs(): void {
    const { chord, radius } = this;
    let before = this.placeAt(0);
    for (let i = 1; i < chord.length; ++i) {
      const span = chord[i] - chord[i - 1],
        step = kGridRadii * Math.min(radius[i - 1], radius[i]),
        pieces = clamp(Math.ceil(span / step), 1, kMostPieces);
      for (let k = 1; span > 0 && k <= pieces; ++k) {
        const at = chord[i - 1] + (span * k) / pieces,
          place = this.placeAt(at),
          straight = distance(place.position, before.position),
          bend = 0.5 * (place.curvature + before.curvature) * straight;
        this.grid.push(at);
        this.arc.push(this.arc.at(-1)! + straight * (1 + Math.min(bend * bend, 1) / 24));
        before = place;
      }
    }
  }
}
