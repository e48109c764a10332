// SPDX-License-Identifier: Apache-2.0
/** Poses of a case's nodes over time: see "Motion" in ../../../spec/lumen.md. */
import type { Pack } from "./pack";

/** Two of a motion's times by their indices, and the share of the way from the first to the second. */
interface Instant {
  from: number;
  to: number;
  share: number;
}

/** The instant of a time, s, among ascending times; without a period the first and the last pose are held. */
export function instantAt(times: readonly number[], period: number | null, time: number): Instant {
  const last = times.length - 1,
    begin = times[0];
  let at = time;
  if (period !== null) {
    const passed = time - begin,
      within = passed - period * Math.floor(passed / period);
    at = begin + (within < period ? Math.max(within, 0) : 0);
    if (at >= times[last])
      return { from: last, to: 0, share: Math.min((at - times[last]) / (begin + period - times[last]), 1) };
  }
  if (!(at > begin)) return { from: 0, to: 0, share: 0 };
  if (at >= times[last]) return { from: last, to: last, share: 0 };
  const to = times.findIndex(t => t > at);
  return { from: to - 1, to, share: (at - times[to - 1]) / (times[to] - times[to - 1]) };
}

type Quaternion = [number, number, number, number];

/** The rotation at a share of the shorter arc from one unit quaternion (x, y, z, w) to another. */
export function slerp(a: Quaternion, b: Quaternion, share: number): Quaternion {
  const product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3],
    sign = product < 0 ? -1 : 1;
  const apart = Math.hypot(...a.map((x, i) => sign * b[i] - x)),
    together = Math.hypot(...a.map((x, i) => sign * b[i] + x));
  const angle = 2 * Math.atan2(apart, together),
    sine = Math.sin(angle);
  const from = sine > 0 ? Math.sin((1 - share) * angle) / sine : 1 - share,
    to = sign * (sine > 0 ? Math.sin(share * angle) / sine : share);
  return a.map((x, i) => from * x + to * b[i]) as Quaternion;
}

/** A pose carries the point X of a node whose centre at rest is O to centre + factor R (X - O). */
export interface Pose {
  centre: [number, number, number];
  rotation: Quaternion;
  factor: number;
}

/** The pose as the rows of a 3 x 4 matrix that carries points at rest; `centre` is that of the node at rest. */
export function poseMatrix(pose: Pose, centre: ArrayLike<number>): number[] {
  const [x, y, z, w] = pose.rotation,
    s = pose.factor;
  const rows = [
    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
  ];
  return rows.flatMap((row, a) => {
    const [p, q, r] = row.map(value => s * value);
    return [p, q, r, pose.centre[a] - (p * centre[0] + q * centre[1] + r * centre[2])];
  });
}

/** Poses of moving nodes, by their node. */
export type Poses = ReadonlyMap<number, Pose>;

export class Motion {
  private constructor(
    /** s, ascending. */
    readonly times: readonly number[],
    /** s; null: the motion does not repeat. */
    readonly period: number | null,
    private readonly node: Uint32Array,
    private readonly centre: Float32Array,
    private readonly rotation: Float32Array,
    private readonly factor: Float32Array,
  ) {}

  /** That of a case's pack; null if it has none. Throws where the arrays do not fit together. */
  static of(pack: Pack): Motion | null {
    const about = (pack.meta.motion ?? null) as { times_s: number[]; period_s: number | null } | null;
    if (about === null) return null;
    const node = pack.get("motion_node", "u32"),
      centre = pack.get("motion_centre", "f32"),
      rotation = pack.get("motion_rotation", "f32"),
      factor = pack.get("motion_factor", "f32"),
      poses = node.length * about.times_s.length;
    if (
      about.times_s.length === 0 ||
      centre.length !== 3 * poses ||
      rotation.length !== 4 * poses ||
      factor.length !== poses
    )
      throw new Error("The case's motion has not one pose for each moving node and time.");
    return new Motion(about.times_s, about.period_s, node, centre, rotation, factor);
  }

  /** The first time, s. */
  get begin(): number {
    return this.times[0];
  }
  /** The time at which the motion has come to its end, or begins again, s. */
  get end(): number {
    return this.period === null ? this.times[this.times.length - 1] : this.begin + this.period;
  }
  /** The time from begin to end that has the poses of any time. */
  within(time: number): number {
    if (this.period === null) return Math.min(Math.max(time, this.begin), this.end);
    if (time === this.end) return time;
    const passed = time - this.begin;
    return this.begin + passed - this.period * Math.floor(passed / this.period);
  }

  /** Poses of the moving nodes at a time, s: centres and factors go along lines, rotations along the shorter arc. */
  at(time: number): Poses {
    const { from, to, share } = instantAt(this.times, this.period, time),
      count = this.node.length,
      poses = new Map<number, Pose>();
    this.node.forEach((node, k) => {
      const a = from * count + k,
        b = to * count + k,
        mix = (values: Float32Array, p: number, q: number): number =>
          values[p] + share * (values[q] - values[p]);
      const turn = (i: number): Quaternion => [
        this.rotation[4 * i],
        this.rotation[4 * i + 1],
        this.rotation[4 * i + 2],
        this.rotation[4 * i + 3],
      ];
      poses.set(node, {
        centre: [
          mix(this.centre, 3 * a, 3 * b),
          mix(this.centre, 3 * a + 1, 3 * b + 1),
          mix(this.centre, 3 * a + 2, 3 * b + 2),
        ],
        rotation: slerp(turn(a), turn(b), share),
        factor: mix(this.factor, a, b),
      });
    });
    return poses;
  }
}
