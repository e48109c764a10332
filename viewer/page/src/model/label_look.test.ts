// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { labelAt, labelPalette, middleOf } from "./label_look";
import type { Label } from "../base/types";
import { systemColour } from "../base/colour";
import { Pack } from "../case/pack";
import { Volume } from "../case/volume";

const label = (value: number, name: string | null, role: string): Label => ({
    value,
    name,
    role,
    from: null,
    voxels: 1,
  }),
  kLabels = [label(3, "aorta", "artery"), label(40, null, "bone")];

/** 5 x 3 x 2 voxels of 2 mm from (10, 0, 0) on, with the place 1 at these indices, and 2 at the other. */
function places(first: number[], second: number): Volume {
  const voxel = Array.from({ length: 30 }, (_, i) => (first.includes(i) ? 1 : i === second ? 2 : 0));
  const header = JSON.stringify({
      size: [5, 3, 2],
      spacing_mm: [2, 2, 2],
      origin: [10, 0, 0],
      direction: [1, 0, 0, 0, 1, 0, 0, 0, 1],
      arrays: { voxel: { type: "u8", shape: [2, 3, 5], offset: 0 } },
    }),
    size = Math.ceil((4 + header.length) / 8) * 8,
    bytes = new Uint8Array(size + voxel.length).fill(32, 4);
  new DataView(bytes.buffer).setUint32(0, size - 4, true);
  bytes.set(new TextEncoder().encode(header), 4);
  bytes.set(voxel, size);
  return new Volume(new Pack(bytes));
}
test("labels of a system have its colour, and those that are hidden have none", () => {
  const palette = labelPalette(kLabels, new Set([40])),
    red = systemColour("artery", 1)!.map(x => Math.round(255 * x));
  expect([...palette.subarray(0, 4)]).toEqual([0, 0, 0, 0]);
  expect([...palette.subarray(4, 8)]).toEqual([...red, 255]);
  expect(palette[11]).toBe(0);
  expect(labelPalette(kLabels, new Set())[11]).toBe(255);
});

test("the label of a place is that of the voxel that holds it", () => {
  const labels = places([2], 3),
    at = (x: number, y = 0): Label | null =>
      labelAt({ labels, state: { labels: { name: "map", roles: [], list: kLabels } } }, [x, y, 0]);
  expect(at(14.9)).toBe(kLabels[0]);
  expect(at(15.1)).toBe(kLabels[1]);
  expect(at(12.9)).toBeNull();
  expect(at(14.9, -1.1)).toBeNull();
  expect(labelAt({ labels: null, state: { labels: null } }, [0, 0, 0])).toBeNull();
});

test("the middle of a label is in one of its voxels, also where it bends around its mean", () => {
  const labels = places([0, 1, 2, 7, 12, 11, 10], -1);
  expect(middleOf(labels, 1)).toEqual([14, 2, 0]);
  expect(middleOf(labels, 2)).toBeNull();
});
