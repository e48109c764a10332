// SPDX-License-Identifier: Apache-2.0
/** The planes of the three linked slices. */
import type { Tree } from "../case/tree";
import type { Vec3 } from "../base/types";
import { cross, dot, scale, sub, unit, type Frame } from "../base/vec";

export const kSliceNames = ["axial", "coronal", "sagittal"] as const;
export type SliceName = (typeof kSliceNames)[number];

/** The frame of a slice. The plane of the shared frame is the axial slice. */
export function frameOf(name: SliceName, shared: Frame): Frame {
  const { right, up, normal } = shared; // patient: right = L, up = A, normal = I (towards the viewer, who is at the feet)
  if (name === "axial") return shared;
  const head = scale(normal, -1);
  if (name === "coronal") return { right, up: head, normal: cross(right, head) };
  return { right: scale(up, -1), up: head, normal: cross(scale(up, -1), head) };
}

export interface Pixel {
  x: number;
  y: number;
  depth: number; // mm in front of the plane
}

/** A slice as drawings over it see it. */
export interface SliceProjection {
  readonly name: SliceName;
  readonly frame: Frame;
  readonly mmPerPixel: number;
  /** The point in the middle of the view. */
  centre(): Vec3;
  toPixel(p: Vec3): Pixel;
  /** `toPixel` as an affine map, for many points. */
  toPixels(): Record<keyof Pixel, { by: Vec3; offset: number }>;
}

/** The shared frame at a node of a tree: the axial plane is its cross-section. */
export function vesselFrame(tree: Tree, node: number): Frame {
  const axis = unit(tree.axis(node)),
    normal = scale(axis, axis[2] > 0 ? -1 : 1); // seen from the feet
  // up is as near as possible to the patient's front, so neighbouring sections have nearly the same turn
  let up = sub([0, -1, 0], scale(normal, dot([0, -1, 0], normal)));
  if (Math.hypot(...up) < 0.3) up = sub([0, 0, 1], scale(normal, dot([0, 0, 1], normal)));
  up = unit(up);
  return { right: cross(up, normal), up, normal };
}
