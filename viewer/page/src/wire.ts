// SPDX-License-Identifier: Apache-2.0
/** A guidewire in the lumen by position-based dynamics (M. Mueller et al., 2007): links keep their length, three points
 * in a row keep their bend, and no point leaves the lumen, which libblob tells for all points at once. */
import type { Batch, Model } from "../../../libblob/wasm/blob.mjs";
import type { Vec3 } from "./types";
import { across, add, along, cross, dot, rotate, scale, sub, unit } from "./vec";

export interface WireOptions {
  count: number;      // points
  spacing: number;    // mm between them
  radius: number;     // mm
  stiffness: number;  // 0 to 1: share of a bend that is taken out in an iteration
  tipAngle: number;   // radians by which the tip is bent as a whole
  tipLength: number;  // points of the bent tip
}

export const kWire: WireOptions = { count: 200, spacing: 0.5, radius: 0.18, stiffness: 0.6, tipAngle: 0.7, tipLength: 12 };

const kIterations = 14; // of links and bends in a step
const kWallEvery = 7; // iterations after which the wall is asked; it is also asked last
const kDamping = 0.6; // share of a step's movement that goes on: a wire in blood does not swing
const kMostMove = 0.45; // of the spacing, that a point moves at most by a step's momentum

export class Wire {
  readonly x: Float64Array;
  private readonly before: Float64Array;
  private readonly batch: Batch;
  /** mm beyond the entry. */
  inserted: number;
  /** Radians that the wire is turned about itself. */
  turned = 0;
  /** Points that touched the wall in the last step, and the deepest that a point was in it before it was put back, mm. */
  contacts = 0;
  deepest = 0;

  /** Enters at `entry` in `direction`; point 0 is the tip. Close it when done. */
  constructor(model: Model, readonly entry: Vec3, readonly direction: Vec3, readonly node: number, readonly options: WireOptions = kWire) {
    this.x = new Float64Array(3 * options.count);
    this.before = new Float64Array(3 * options.count);
    this.batch = model.batch(options.count);
    this.inserted = 4 * options.spacing;
    this.batch.cursors.fill(node);
    for (let i = 0; i < options.count; ++i) this.x.set(this.onGuide(i), 3 * i);
    this.before.set(this.x);
  }
  close(): void { this.batch.free(); }

  /** Points that are beyond the entry; the others lie on a straight guide behind it. */
  get free(): number { return Math.min(this.options.count, Math.max(0, Math.ceil(this.inserted / this.options.spacing))); }
  get tip(): Vec3 { return [this.x[0], this.x[1], this.x[2]]; }
  get tipNode(): number { return this.batch.cursors[0]; }
  private onGuide(i: number): Vec3 { return along(this.entry, this.direction, this.inserted - i * this.options.spacing); }

  /** Pushes by `push` mm, turns by `turn` radians, and lets the wire settle for one step. */
  step(push: number, turn: number): void {
    const { count, spacing } = this.options, x = this.x, before = this.before;
    this.turned += turn;
    this.inserted = Math.min((count - 1) * spacing, Math.max(2 * spacing, this.inserted + push));
    const free = this.free, most = kMostMove * spacing;
    for (let i = 0; i < 3 * free; ++i) {
      const v = Math.min(most, Math.max(-most, kDamping * (x[i] - before[i])));
      before[i] = x[i];
      x[i] += v;
    }
    // what is on the guide, and with it the points about to leave it, goes where it is pushed
    for (let i = Math.max(0, free - 1); i < count; ++i) { x.set(this.onGuide(i), 3 * i); before.set(this.onGuide(i), 3 * i); }
    this.deepest = 0;
    for (let k = 1; k <= kIterations; ++k) {
      this.bends(free);
      this.tipBend(free);
      this.links(free);
      if (k % kWallEvery === 0) this.wall(free, k === kIterations);
    }
  }

  private links(free: number): void {
    const { spacing } = this.options, x = this.x, last = Math.min(free, this.options.count - 1);
    for (let i = last - 1; i >= 0; --i) { // from the entry to the tip, so that a push arrives there
      const a = 3 * i, b = a + 3, dx = x[a] - x[b], dy = x[a + 1] - x[b + 1], dz = x[a + 2] - x[b + 2];
      const d = Math.hypot(dx, dy, dz) || 1e-9, fixed = i + 1 >= free - 1, s = (spacing - d) / d, own = fixed ? s : 0.5 * s;
      x[a] += own * dx; x[a + 1] += own * dy; x[a + 2] += own * dz;
      if (!fixed) { x[b] -= own * dx; x[b + 1] -= own * dy; x[b + 2] -= own * dz; }
    }
  }

  private bends(free: number): void {
    const { stiffness, count } = this.options, x = this.x;
    for (let i = 1; i < Math.min(free, count - 1); ++i) {
      const m = 3 * i, a = m - 3, b = m + 3, fixed = i + 1 >= free - 1, w = stiffness * 0.25;
      for (let k = 0; k < 3; ++k) {
        const bend = x[a + k] + x[b + k] - 2 * x[m + k];
        x[a + k] -= w * bend;
        if (i < free - 1) x[m + k] += w * bend;
        if (!fixed) x[b + k] -= w * bend;
      }
    }
  }

  /** The shaped tip: each of its bends wants an angle, in the plane that the wire is turned to. */
  private tipBend(free: number): void {
    const { tipLength, tipAngle, spacing } = this.options, n = Math.min(tipLength, free - 2);
    if (n < 2 || tipAngle === 0) return;
    const at = (i: number): Vec3 => [this.x[3 * i], this.x[3 * i + 1], this.x[3 * i + 2]];
    const axis = unit(sub(at(n), at(n + 1))), side = rotate(this.reference(axis), axis, this.turned), each = tipAngle / n;
    let d = axis, p = at(n);
    for (let i = n - 1; i >= 0; --i) {
      d = unit(add(scale(d, Math.cos(each)), scale(side0(d, side), Math.sin(each))));
      p = along(p, d, spacing);
      const kPull = 0.12; // share of the way to its shape that the tip takes in an iteration: the wall is stronger
      for (let k = 0; k < 3; ++k) this.x[3 * i + k] += kPull * (p[k] - this.x[3 * i + k]);
    }
  }

  /** A vector across the wire that follows it without turning: carried from the entry along the points. */
  private reference(axis: Vec3): Vec3 {
    const first = across(this.direction), kEvery = 4;
    let d = this.direction, u = first;
    for (let i = this.free - 2; i > 0; i -= kEvery) {
      const j = Math.max(0, i - kEvery);
      const e = unit([this.x[3 * j] - this.x[3 * i], this.x[3 * j + 1] - this.x[3 * i + 1], this.x[3 * j + 2] - this.x[3 * i + 2]]);
      if (dot(e, e) > 0.5) { u = unit(sub(u, scale(e, dot(u, e)))); d = e; }
    }
    void d;
    return unit(sub(u, scale(axis, dot(u, axis))));
  }

  private wall(free: number, last: boolean): void {
    const { batch, x } = this, radius = this.options.radius, count = this.options.count;
    batch.points.set(x);
    batch.query();
    // 9 numbers for each point: value, gradient, distance, normal, node and state
    const answers = new Float64Array(batch.buffer, batch.address + count * 24, 9 * count);
    if (last) this.contacts = 0;
    for (let i = 0; i < Math.min(free, count); ++i) {
      const depth = answers[9 * i + 4] + radius;
      if (!(depth > 0)) continue;
      this.deepest = Math.max(this.deepest, depth);
      if (last) ++this.contacts;
      if (i >= free - 1) continue;
      for (let k = 0; k < 3; ++k) {
        x[3 * i + k] -= depth * answers[9 * i + 5 + k];
        // what moves into the wall stops there
        this.before[3 * i + k] += 0.5 * (x[3 * i + k] - this.before[3 * i + k]);
      }
    }
  }
}

/** The part of `side` across `d`. */
function side0(d: Vec3, side: Vec3): Vec3 {
  const s = sub(side, scale(d, dot(side, d)));
  return dot(s, s) < 1e-8 ? cross(d, across(d)) : unit(s);
}
