// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { instantAt, Motion, poseMatrix, slerp } from "./motion";
import { makePack, Pack } from "./pack";

const kHalf = Math.SQRT1_2; // of a quarter turn

/** Node 4 goes 2 mm along x, doubles and turns a quarter about z within half a second; node 7 stays in its place. */
function motion(period: number | null, factor = [1, 1, 2, 1]): Motion {
  const f32 = (shape: number[], data: number[]) => ({
    type: "f32" as const,
    shape,
    data: new Float32Array(data),
  });
  return Motion.of(
    new Pack(
      makePack(
        { motion: { times_s: [0.1, 0.6], period_s: period } },
        {
          motion_node: { type: "u32", shape: [2], data: new Uint32Array([4, 7]) },
          motion_centre: f32([4, 3], [0, 0, 0, 5, 5, 5, 2, 0, 0, 5, 5, 5]),
          motion_rotation: f32([4, 4], [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, kHalf, kHalf, 0, 0, 0, -1]),
          motion_factor: f32([factor.length], factor),
        },
      ),
    ),
  )!;
}

describe("instantAt", () => {
  it("liesBetweenTwoTimes", () => {
    const { from, to, share } = instantAt([0, 1, 3], null, 2.5);
    expect([from, to, share]).toEqual([1, 2, 0.75]);
  });
  it("holdsTheFirstAndTheLastWithoutAPeriod", () => {
    expect(instantAt([0, 1, 3], null, -1)).toEqual({ from: 0, to: 0, share: 0 });
    expect(instantAt([0, 1, 3], null, 3.5)).toEqual({ from: 2, to: 2, share: 0 });
  });
  it("goesBackToTheFirstWithinAPeriod", () => {
    expect(instantAt([0, 1, 3], 4, 3.5)).toEqual({ from: 2, to: 0, share: 0.5 });
    expect(instantAt([0, 1, 3], 4, 8.5)).toEqual({ from: 0, to: 1, share: 0.5 });
    expect(instantAt([0, 1, 3], 4, -0.5)).toEqual({ from: 2, to: 0, share: 0.5 });
  });
  it("isTheOnlyTimeOfAMotionWithOne", () => {
    expect(instantAt([2], null, 5)).toEqual({ from: 0, to: 0, share: 0 });
    expect(instantAt([2], 1, 2.25)).toEqual({ from: 0, to: 0, share: 0.25 });
  });
});

describe("slerp", () => {
  it("turnsAtConstantSpeed", () => {
    const [x, y, z, w] = slerp([0, 0, 0, 1], [0, 0, kHalf, kHalf], 1 / 3); // 30 degrees
    expect([x, y]).toEqual([0, 0]);
    expect(z).toBeCloseTo(Math.sin(Math.PI / 12), 12);
    expect(w).toBeCloseTo(Math.cos(Math.PI / 12), 12);
  });
  it("takesTheShorterArc", () => {
    const [, , z, w] = slerp([0, 0, 0, 1], [0, 0, -kHalf, -kHalf], 0.5);
    expect(z).toBeCloseTo(Math.sin(Math.PI / 8), 12);
    expect(w).toBeCloseTo(Math.cos(Math.PI / 8), 12);
  });
  it("staysWhereNothingTurns", () => {
    expect(slerp([0, 0, 0, 1], [0, 0, 0, 1], 0.3)).toEqual([0, 0, 0, 1]);
    expect(slerp([0, 0, 0, 1], [0, 0, 0, -1], 0.3).map(x => x + 0)).toEqual([0, 0, 0, 1]);
  });
});

describe("poseMatrix", () => {
  it("carriesPointsAsThePoseDoes", () => {
    const m = poseMatrix(
        { centre: [10, 0, 0], rotation: [0, 0, kHalf, kHalf], factor: 2 }, // x becomes y
        [1, 1, 1],
      ),
      p = [2, 1, 1.5];
    const moved = [0, 4, 8].map(a => m[a] * p[0] + m[a + 1] * p[1] + m[a + 2] * p[2] + m[a + 3]);
    [10, 2, 1].forEach((x, a) => expect(moved[a]).toBeCloseTo(x, 12));
  });
});

describe("Motion", () => {
  it("goesAlongLinesAndArcsBetweenItsTimes", () => {
    const pose = motion(null).at(0.35).get(4)!;
    expect(pose.centre[0]).toBeCloseTo(1, 6);
    expect(pose.factor).toBeCloseTo(1.5, 6);
    expect(pose.rotation[2]).toBeCloseTo(Math.sin(Math.PI / 8), 6);
  });
  it("hasPosesOfMovingNodesOnly", () => {
    expect([...motion(null).at(0.35).keys()]).toEqual([4, 7]);
  });
  it("keepsTimesBetweenItsBeginAndItsEnd", () => {
    expect([motion(null).begin, motion(null).end]).toEqual([0.1, 0.6]);
    expect([-1, 0.3, 9].map(t => motion(null).within(t))).toEqual([0.1, 0.3, 0.6]);
    expect(motion(0.8).end).toBeCloseTo(0.9, 12);
    expect(motion(0.8).within(1.75)).toBeCloseTo(0.15, 9);
    expect(motion(0.8).within(-0.2)).toBeCloseTo(0.6, 9);
    expect(motion(0.8).at(0.75).get(4)!.centre[0]).toBeCloseTo(1, 6);
  });
  it("isNoneOfACaseThatDoesNotMove", () => {
    expect(Motion.of(new Pack(makePack({}, {})))).toBe(null);
  });
  it("refusesArraysThatDoNotFit", () => {
    expect(() => motion(null, [1, 1, 2])).toThrow(/one pose for each/);
  });
});
