// SPDX-License-Identifier: Apache-2.0
/** A guidewire in the lumen, as libblob/examples/catheter has it: points at equal spacing with energies of bending and
 * stretching, an implicit step by Newton's method on their positions, and the wall's planes from libblob for all points
 * at once. Contact forces are multipliers that carry over, so a wire at rest does not sink into the wall. The tip has a
 * bend of its own, which turns with the wire. Units: mm, s, N, hence tonnes. */
import type { Batch, Model } from "../../../libblob/wasm/blob.mjs";
import { kBand, solveBanded } from "./banded";
import type { Vec3 } from "./types";
import { across, along, dot, rotate, scale, sub, unit } from "./vec";

export interface WireOptions {
  count: number; // points
  spacing: number; // mm between them
  radius: number; // mm
  young: number; // N/mm^2, of the shaft; the tip is softer
  tipAngle: number; // radians by which the tip is bent as a whole
  tipLength: number; // points of the bent tip
}

export const kWire: WireOptions = {
  count: 200,
  spacing: 0.5,
  radius: 0.15,
  young: 1e5,
  tipAngle: 0.8,
  tipLength: 10,
};

const kIterations = 3; // Newton steps in a step, each with the wall as it is there
const kDensity = 6.5e-9; // t/mm^3: steel and a coil
const kTimeStep = 1 / 60; // s
const kSoft = 0.12,
  kSoftPoints = 24; // share of the stiffness at the tip, and points over which it grows to 1
const kContact = 10; // stiffness of contact in bending stiffnesses: settles within few iterations, whatever the wire
const kMostMove = 0.25; // spacings that a point moves at most in an iteration

export class Wire {
  readonly x: Float64Array;
  private readonly batch: Batch;
  private readonly lower: Float64Array;
  private readonly gradient: Float64Array;
  private readonly velocity: Float64Array;
  private readonly inertial: Float64Array;
  private readonly anchor: Float64Array;
  private readonly distance: Float64Array;
  private readonly normal: Float64Array;
  private readonly force: Float64Array;
  private readonly active: Uint8Array;
  private readonly bend: Float64Array; // second differences at rest
  /** mm beyond the entry. */
  inserted: number;
  /** Radians that the wire is turned about itself. */
  turned = 0;
  /** Points that press on the wall. */
  contacts = 0;

  /** Enters at `entry` in `direction`; point 0 is the tip. Close it when done. */
  constructor(
    model: Model,
    readonly entry: Vec3,
    readonly direction: Vec3,
    readonly node: number,
    readonly options: WireOptions = kWire,
  ) {
    const n = options.count,
      numbers = (k: number): Float64Array => new Float64Array(k * n);
    [this.x, this.lower, this.gradient, this.velocity, this.inertial, this.anchor, this.normal, this.bend] = [
      numbers(3),
      numbers(3 * kBand),
      numbers(3),
      numbers(3),
      numbers(3),
      numbers(3),
      numbers(3),
      numbers(3),
    ];
    [this.distance, this.force, this.active] = [numbers(1), numbers(1), new Uint8Array(n)];
    this.batch = model.batch(n);
    this.inserted = 6 * options.spacing;
    this.batch.cursors.fill(node);
    for (let i = 0; i < n; ++i) this.x.set(this.onGuide(i), 3 * i);
  }
  close(): void {
    this.batch.free();
  }

  /** Points that are beyond the entry; the others lie on a straight guide behind it. */
  get free(): number {
    return Math.min(this.options.count - 2, Math.max(1, Math.ceil(this.inserted / this.options.spacing)));
  }
  at(i: number): Vec3 {
    return [this.x[3 * i], this.x[3 * i + 1], this.x[3 * i + 2]];
  }
  get tip(): Vec3 {
    return this.at(0);
  }
  cursorOf(i: number): number {
    return this.batch.cursors[i];
  }
  private onGuide(i: number): Vec3 {
    return along(this.entry, this.direction, this.inserted - i * this.options.spacing);
  }
  private stiffness(i: number): number {
    const { young, radius, spacing } = this.options,
      share = Math.min(1, kSoft + ((1 - kSoft) * i) / kSoftPoints);
    return (share * young * Math.PI * radius ** 4) / (4 * spacing ** 3);
  }

  /** Pushes by `push` mm, turns by `turn` radians, and moves the wire by one step of 1/60 s. */
  step(push: number, turn: number): void {
    const { count, spacing } = this.options,
      before = Float64Array.from(this.x);
    this.turned += turn;
    this.inserted = Math.min((count - 3) * spacing, Math.max(3 * spacing, this.inserted + push));
    const free = this.free;
    for (let i = 0; i < count; ++i)
      if (i >= free) {
        this.x.set(this.onGuide(i), 3 * i);
        this.velocity.fill(0, 3 * i, 3 * i + 3);
        this.force[i] = this.active[i] = 0;
      }
    for (let i = 0; i < 3 * free; ++i) this.inertial[i] = before[i] + kTimeStep * this.velocity[i];
    this.shapeTip(free);
    for (let k = 0; k < kIterations; ++k) {
      this.askWall(free);
      this.newton(free);
    }
    for (let i = 0; i < 3 * free; ++i) this.velocity[i] = (this.x[i] - before[i]) / kTimeStep;
  }

  /** The bend that the tip has at rest, in the plane that the wire is turned to. */
  private shapeTip(free: number): void {
    const { tipLength, tipAngle, spacing } = this.options,
      n = Math.min(tipLength, free - 1),
      each = 2 * Math.sin(tipAngle / (2 * Math.max(tipLength, 1))) * spacing;
    this.bend.fill(0);
    for (let i = 1; i <= n; ++i) {
      const d = unit(sub(this.at(i - 1), this.at(i + 1))),
        side = this.carried(i, d);
      this.bend.set(scale(rotate(side, d, this.turned), each), 3 * i);
    }
  }

  /** A vector across the wire at point i, carried there from the entry without turning about the wire. */
  private carried(i: number, d: Vec3): Vec3 {
    let u = across(this.direction);
    const kEvery = 3;
    for (let k = this.free; k > i; k -= kEvery) {
      const e = unit(sub(this.at(Math.max(i, k - kEvery)), this.at(k))),
        v = along(u, e, -dot(u, e));
      if (dot(v, v) > 1e-6) u = unit(v);
    }
    const v = along(u, d, -dot(u, d));
    return dot(v, v) > 1e-6 ? unit(v) : across(d);
  }

  private askWall(free: number): void {
    const { batch, x } = this,
      count = this.options.count;
    batch.points.set(x);
    batch.query();
    // 9 numbers for each point: value, gradient, distance, normal, node and state
    const answers = new Float64Array(batch.buffer, batch.address + count * 24, 9 * count);
    for (let i = 0; i < free; ++i) {
      this.distance[i] = answers[9 * i + 4];
      for (let a = 0; a < 3; ++a) {
        this.normal[3 * i + a] = answers[9 * i + 5 + a];
        this.anchor[3 * i + a] = x[3 * i + a];
      }
    }
  }

  /** Adds scale * (I + share * n n^T) between points i >= j. */
  private add(
    free: number,
    i: number,
    j: number,
    s: number,
    share = 0,
    n: ArrayLike<number> = kZero,
    at = 0,
  ): void {
    if (i >= free || j >= free) return;
    for (let a = 0; a < 3; ++a)
      for (let b = 0; b < (i === j ? a + 1 : 3); ++b)
        this.lower[kBand * (3 * i + a) + kBand - 1 - (3 * (i - j) + a - b)] +=
          s * ((a === b ? 1 : 0) + share * n[at + a] * n[at + b]);
  }

  private addInertia(free: number): void {
    const { radius, spacing } = this.options,
      mass = (kDensity * Math.PI * radius ** 2 * spacing) / kTimeStep ** 2;
    for (let i = 0; i < free; ++i) {
      for (let a = 3 * i; a < 3 * i + 3; ++a) this.gradient[a] += mass * (this.x[a] - this.inertial[a]);
      this.add(free, i, i, mass);
    }
  }

  /** Energy k/2 |x[i-1] - 2 x[i] + x[i+1] - bend|^2. */
  private addBending(free: number): void {
    for (let i = 1; i <= free; ++i) {
      const k = this.stiffness(i),
        m = 3 * i;
      for (let a = 0; a < 3; ++a) {
        const second = k * (this.x[m - 3 + a] - 2 * this.x[m + a] + this.x[m + 3 + a] - this.bend[m + a]);
        this.gradient[m - 3 + a] += second;
        if (i < free) this.gradient[m + a] -= 2 * second;
        if (i + 1 < free) this.gradient[m + 3 + a] += second;
      }
      for (let p = 0; p < 3; ++p)
        for (let q = 0; q <= p; ++q) this.add(free, i + p - 1, i + q - 1, k * kSecond[p] * kSecond[q]);
    }
  }

  /** Energy k/2 (length - h)^2; under compression its Hessian's negative part is left out, so that it stays definite. */
  private addStretching(free: number): void {
    const { young, radius, spacing: h } = this.options,
      k = (young * Math.PI * radius ** 2) / h,
      n = [0, 0, 0];
    for (let i = 0; i < free; ++i) {
      for (let a = 0; a < 3; ++a) n[a] = this.x[3 * i + 3 + a] - this.x[3 * i + a];
      const length = Math.hypot(n[0], n[1], n[2]) || 1e-9;
      for (let a = 0; a < 3; ++a) {
        n[a] /= length;
        this.gradient[3 * i + a] -= k * (length - h) * n[a];
        if (i + 1 < free) this.gradient[3 * i + 3 + a] += k * (length - h) * n[a];
      }
      const sideways = Math.max(k * (1 - h / length), 1e-9 * k),
        share = (k - sideways) / sideways;
      this.add(free, i, i, sideways, share, n);
      this.add(free, i + 1, i + 1, sideways, share, n);
      this.add(free, i + 1, i, -sideways, share, n);
    }
  }

  /** Distance of a point in the wall's plane, mm. */
  private depth(i: number): number {
    let moved = 0;
    for (let a = 3 * i; a < 3 * i + 3; ++a) moved += this.normal[a] * (this.x[a] - this.anchor[a]);
    return this.distance[i] + this.options.radius + moved;
  }

  /** A point in the wall is held on its plane until the force that this takes would pull. */
  private addContacts(free: number, k: number): void {
    for (let i = 0; i < free; ++i) {
      const depth = this.depth(i);
      if (depth > 0) this.active[i] = 1;
      if (this.active[i] === 0) continue;
      const pressing = this.force[i] + k * depth,
        none = 1e-12 * k;
      for (let a = 3 * i; a < 3 * i + 3; ++a) this.gradient[a] += pressing * this.normal[a];
      this.add(free, i, i, none, k / none, this.normal, 3 * i);
    }
  }

  private newton(free: number): void {
    const size = 3 * free,
      g = this.gradient,
      k = kContact * this.stiffness(this.options.count);
    this.lower.fill(0, 0, kBand * size);
    g.fill(0, 0, size);
    this.addInertia(free);
    this.addBending(free);
    this.addStretching(free);
    this.addContacts(free, k);
    if (!solveBanded(size, this.lower, g)) return;
    let most = 0;
    for (let i = 0; i < size; ++i) most = Math.max(most, Math.abs(g[i]));
    const bound = kMostMove * this.options.spacing,
      share = most > bound ? bound / most : 1;
    this.contacts = 0;
    for (let i = 0; i < free; ++i) {
      if (this.active[i] !== 0) {
        this.force[i] +=
          share *
          k *
          (this.depth(i) -
            (this.normal[3 * i] * g[3 * i] +
              this.normal[3 * i + 1] * g[3 * i + 1] +
              this.normal[3 * i + 2] * g[3 * i + 2]));
        if (this.force[i] > 0) ++this.contacts;
        else this.force[i] = this.active[i] = 0;
      }
    }
    for (let i = 0; i < size; ++i) this.x[i] -= share * g[i];
  }
}

const kZero = [0, 0, 0],
  kSecond = [1, -2, 1];
