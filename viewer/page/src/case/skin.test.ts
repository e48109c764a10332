// SPDX-License-Identifier: Apache-2.0
import { Ray, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { Pose, Poses } from "./motion";
import { makePack, Pack } from "./pack";
import { sampleTree } from "./sample_tree";
import { Surface } from "./surface";

const kHalf = Math.SQRT1_2; // of a quarter turn
const kCentre = new Float32Array([0, 0, 0, 4, 0, 0]); // of nodes 0, which rests, and 1

/** Node 1 rises by 2 mm, doubles and turns a quarter about x: z becomes -y. */
const kPose: Pose = { centre: [4, 0, 2], rotation: [kHalf, 0, 0, kHalf], factor: 2 };
const kPoses: Poses = new Map([[1, kPose]]);

/** A triangle at z = 0 whose corners hang on what rests, on both and on node 1. */
function surface(joint = [0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0]): Surface {
  const weight = [65535, 0, 0, 0, 32768, 32767, 0, 0, 65535, 0, 0, 0];
  return new Surface(
    new Pack(
      makePack(
        { parts: [{ name: "a", branch: 0, first: 0, count: 1 }] },
        {
          position: { type: "f32", shape: [3, 3], data: new Float32Array([0, 0, 0, 4, 0, 0, 4, 1, 0]) },
          triangle: { type: "u32", shape: [1, 3], data: new Uint32Array([0, 1, 2]) },
          node: { type: "u32", shape: [3], data: new Uint32Array(3) },
          radius_mm: { type: "f32", shape: [3], data: new Float32Array(3).fill(1) },
          joint_node: { type: "i32", shape: [2], data: new Int32Array([-1, 1]) },
          joint: { type: "u16", shape: [3, 4], data: new Uint16Array(joint) },
          weight: { type: "u16", shape: [3, 4], data: new Uint16Array(weight) },
        },
      ),
    ),
  );
}

const expectNear = (found: ArrayLike<number>, wanted: number[]): void => {
  expect(found.length).toBe(wanted.length);
  wanted.forEach((x, i) => expect(found[i]).toBeCloseTo(x, 4));
};

describe("Surface with a skin", () => {
  it("movesVerticesWithTheNodesThatTheyHangOn", () => {
    const one = surface();
    one.pose(kPoses, kCentre);
    // (4, 0, 0) is the node's centre, half of which goes along; (4, 1, 0) goes to (4, 0, 2) + 2 R (0, 1, 0)
    expectNear(one.position, [0, 0, 0, 4, 0, 1, 4, 0, 4]);
  });
  it("turnsNormalsWithThem", () => {
    const one = surface();
    one.pose(kPoses, kCentre);
    const normal = [...one.parts[0].geometry.getAttribute("normal").array];
    expect(normal.slice(0, 3)).toEqual([0, 0, 127]);
    expect(normal.slice(8, 11)).toEqual([0, -127, 0]);
  });
  it("liesAtRestAgainAsBefore", () => {
    const one = surface(),
      before = [...one.position],
      normal = [...one.parts[0].geometry.getAttribute("normal").array];
    one.pose(kPoses, kCentre);
    one.pose(kPoses, kCentre); // from rest, not from where it is
    expectNear(one.position.slice(6), [4, 0, 4]);
    one.rest();
    expect([...one.position]).toEqual(before);
    expect([...one.parts[0].geometry.getAttribute("normal").array]).toEqual(normal);
  });
  it("isPickedAndCutWhereItIs", () => {
    const one = surface(),
      ray = new Ray(new Vector3(3.5, 10, 1.5), new Vector3(0, -1, 0)),
      all = (): boolean => true;
    expect(one.pick(ray, all)).toBe(null); // it lies at z = 0, along the ray
    one.pose(kPoses, kCentre);
    expectNear(one.pick(ray, all)!.point, [3.5, 0, 1.5]);
    expectNear(
      one.cut(one.parts[0], [1, 0, 0], [3.5, 0, 0]).filter((_, i) => i % 3 === 1),
      [0, 0],
    );
    one.rest();
    expect(one.pick(ray, all)).toBe(null);
    expect(one.cut(one.parts[0], [0, 0, 1], [0, 0, 1])).toEqual([]);
  });
  it("refusesAJointThatDoesNotExist", () => {
    expect(() => surface([0, 0, 0, 0, 0, 2, 0, 0, 1, 0, 0, 0])).toThrow(/joint/);
  });
});

describe("Tree at a time", () => {
  it("hasNodesWherePosesCarryThem", () => {
    const tree = sampleTree(),
      posed = tree.posed(new Map([[3, { ...kPose, centre: [7, 8, 9] }]]));
    expect(posed.position(3)).toEqual([7, 8, 9]);
    expectNear(posed.axis(3), [0, -1, 0]);
    expect(posed.radius[3]).toBe(2);
    expect(posed.position(4)).toEqual(tree.position(4));
    expect(tree.position(3)).toEqual([0, 0, 3]);
    expect(posed.branches).toBe(tree.branches);
    expect(posed.box()!.high[0]).toBe(9); // 7 + 2
  });
});
