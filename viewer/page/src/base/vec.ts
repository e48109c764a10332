// SPDX-License-Identifier: Apache-2.0
/** Vectors of three numbers as plain tuples; mm in LPS unless noted otherwise. */
import type { Vec3 } from "./types";

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const along = (a: Vec3, b: Vec3, s: number): Vec3 => [
  a[0] + s * b[0],
  a[1] + s * b[1],
  a[2] + s * b[2],
];
export const mix = (a: Vec3, b: Vec3, s: number): Vec3 => along(scale(a, 1 - s), b, s);
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const length = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);
export const distance = (a: Vec3, b: Vec3): number => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
/** The zero vector stays what it is. */
export const unit = (a: Vec3): Vec3 => scale(a, 1 / (length(a) || 1));
export const at = (values: ArrayLike<number>, i: number): Vec3 => [
  values[3 * i],
  values[3 * i + 1],
  values[3 * i + 2],
];

/** A unit vector across `d`. */
export function across(d: Vec3): Vec3 {
  const least =
    Math.abs(d[0]) <= Math.abs(d[1]) && Math.abs(d[0]) <= Math.abs(d[2])
      ? 0
      : Math.abs(d[1]) <= Math.abs(d[2])
        ? 1
        : 2;
  const axis: Vec3 = [0, 0, 0];
  axis[least] = 1;
  return unit(cross(d, axis));
}

/** `v` turned by `angle` (radians) about the unit vector `axis` (Rodrigues). */
export function rotate(v: Vec3, axis: Vec3, angle: number): Vec3 {
  const c = Math.cos(angle),
    s = Math.sin(angle);
  return add(along(scale(v, c), cross(axis, v), s), scale(axis, dot(axis, v) * (1 - c)));
}

/** A right-handed frame: right, up, and towards the viewer. */
export interface Frame {
  right: Vec3;
  up: Vec3;
  normal: Vec3;
}

const kSides: [string, string][] = [
  ["R", "L"],
  ["A", "P"],
  ["I", "S"],
];

/** Patient orientation of a direction: its largest component first, and others of more than half of it. */
export function orientation(d: Vec3): string {
  const order = [0, 1, 2].sort((i, j) => Math.abs(d[j]) - Math.abs(d[i]));
  return order
    .filter(i => Math.abs(d[i]) > 0.5 * Math.abs(d[order[0]]) - 1e-9 && Math.abs(d[i]) > 1e-6)
    .map(i => kSides[i][d[i] > 0 ? 1 : 0])
    .join("");
}

/** A closed line around a centre, in the plane of two unit vectors at right angles. */
export function circle(centre: Vec3, radius: number, right: Vec3, up: Vec3): Vec3[] {
  const kPoints = 48;
  return Array.from({ length: kPoints + 1 }, (_, i) => {
    const angle = (2 * Math.PI * i) / kPoints,
      x = radius * Math.cos(angle),
      y = radius * Math.sin(angle);
    return [0, 1, 2].map(a => centre[a] + x * right[a] + y * up[a]) as Vec3;
  });
}
