// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from "three";
import { expect, test } from "vitest";
import { sampleTree } from "../case/sample_tree";
import { cylinders, placeCylinders, type Cylinders } from "./node_cylinders";

const corners = ({ geometry }: Cylinders): Vector3[] =>
  Array.from(geometry.index!.array, v => new Vector3().fromBufferAttribute(geometry.attributes.position, v));

test("each branch has the cylinders of its nodes, which face outwards and have the radii and heights of these", () => {
  const tree = sampleTree(),
    meshes = cylinders(tree, 8);
  expect(meshes.map(m => m.userData.branch)).toEqual([0, 1, 2]);
  expect(meshes.map(m => m.geometry.index!.count)).toEqual([11, 5, 4].map(nodes => nodes * 8 * 6));
  const trunk = corners(meshes[0]);
  for (const p of trunk) expect(Math.hypot(p.x, p.y)).toBeCloseTo(1, 6);
  expect(trunk.map(p => p.z).reduce((a, b) => Math.min(a, b))).toBeCloseTo(-0.5, 6);
  expect(trunk.map(p => p.z).reduce((a, b) => Math.max(a, b))).toBeCloseTo(10.5, 6);
  for (let i = 0; i < trunk.length; i += 3) {
    const [a, b, c] = trunk.slice(i, i + 3),
      facing = b.clone().sub(a).cross(c.clone().sub(a));
    expect(facing.x * a.x + facing.y * a.y).toBeGreaterThan(0);
    expect(facing.z).toBeCloseTo(0, 6);
  }
  const { normal } = meshes[0].geometry.attributes;
  expect(Math.hypot(normal.getX(3), normal.getY(3), normal.getZ(3))).toBeCloseTo(1, 2);
});

test("cylinders follow their nodes, as do the spheres by which they are ordered", () => {
  const tree = sampleTree(),
    meshes = cylinders(tree, 6);
  expect(meshes[0].geometry.boundingSphere!.center.toArray()).toEqual([0, 0, 5]);
  expect(meshes[0].geometry.boundingSphere!.radius).toBeCloseTo(5, 6);
  for (let i = 0; i < tree.count; ++i) tree.centre[3 * i] += 2;
  placeCylinders(meshes, tree);
  expect(meshes[0].geometry.boundingSphere!.center.toArray()).toEqual([2, 0, 5]);
  for (const p of corners(meshes[0])) expect(Math.hypot(p.x - 2, p.y)).toBeCloseTo(1, 6);
});

test("a tree without nodes has none", () => {
  expect(cylinders(Object.assign(sampleTree(), { branches: [], count: 0 }), 6)).toEqual([]);
});
