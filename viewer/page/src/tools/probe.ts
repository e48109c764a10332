// SPDX-License-Identifier: Apache-2.0
/** The probe at a point: libblob's answer and the volume's value. */
import { Flags, NOWHERE, State, type Batch, type Model } from "../../../../libblob/wasm/blob.mjs";
import { labelAt } from "../model/label_look";
import type { View } from "../model/model";
import type { Label, Vec3 } from "../base/types";
import { along } from "../base/vec";

export interface Answer {
  position: Vec3;
  /** Intensity, or NaN where there is no voxel. */
  value: number;
  /** Intensity of the volume beside the first, or NaN. */
  second: number;
  /** Of the label map; null where it has none. */
  label: Label | null;
  /** Null without a model, and at a time of the motion: libblob answers for the case at rest. */
  wall: Wall | null;
}

/** The wall as libblob answers it. */
export interface Wall {
  /** To the wall, mm; negative in the lumen. */
  distance: number;
  /** Outwards. */
  normal: Vec3;
  node: number;
  inside: boolean;
  /** The search for the wall's nearest point came to its end. */
  converged: boolean;
}

let batch: Batch | null = null;

function batchOf(model: Model): Batch {
  if (batch?.model !== model) batch = model.batch(1);
  return batch;
}

/** One query; `cursor` is the node that the point belongs to, if that is known. 0.01 ms or so. */
function ask(model: Model, p: Vec3, cursor = NOWHERE, flags = 0): Wall {
  const one = batchOf(model);
  one.points.set(p);
  one.cursors[0] = cursor;
  one.query(flags);
  const s = one.sample(0);
  return {
    distance: s.distance,
    normal: Array.from(s.normal) as Vec3,
    node: s.node,
    inside: s.inside,
    converged: (s.state & State.NOT_CONVERGED) === 0,
  };
}

/** Distance and normal are those of the nearest point of the wall: the form of one evaluation is for contacts, and is
 * wrong by a tenth of the radius near an axis. */
export function probe(view: Pick<View, "document" | "motion">, p: Vec3, cursor = NOWHERE): Answer {
  return {
    position: p,
    value: view.document.volume?.sample(p) ?? NaN,
    second: view.document.second?.sample(p) ?? NaN,
    label: labelAt(view.document, p),
    wall:
      view.document.blob === null || view.motion.time !== null
        ? null
        : ask(view.document.blob, p, cursor, Flags.DISTANCE_EXACT),
  };
}

/** Distance from a point in the lumen to the wall along a direction, in mm; `most` if there is no wall before.
 * The sign of the distance changes at the wall: halving between samples a quarter of the radius apart. */
export function toWall(
  model: Model,
  from: Vec3,
  direction: Vec3,
  node: number,
  radius: number,
  most: number,
  flags = 0,
): number {
  let low = 0,
    cursor = node,
    high = most;
  const step = Math.max(radius / 4, most / 200);
  for (let t = step; ; t += step) {
    const s = ask(model, along(from, direction, Math.min(t, most)), cursor, flags);
    if (!s.inside) {
      high = Math.min(t, most);
      break;
    }
    if (t >= most) return most;
    low = t;
    cursor = s.node;
  }
  const kHalvings = 16;
  for (let i = 0; i < kHalvings; ++i) {
    const t = (low + high) / 2;
    if (ask(model, along(from, direction, t), cursor, flags).inside) low = t;
    else high = t;
  }
  return (low + high) / 2;
}

export { Flags };
