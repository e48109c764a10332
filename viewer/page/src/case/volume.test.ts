// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { makePack, Pack } from "./pack";
import { reduce, Volume } from "./volume";

/** 4 x 3 x 2 voxels of 2 x 1 x 0.5 mm whose stored number is 100 k + 10 j + i. */
function volume(direction = [1, 0, 0, 0, 1, 0, 0, 0, 1]): Volume {
  const data = Uint16Array.from(
    { length: 24 },
    (_, n) => 100 * Math.floor(n / 12) + 10 * (Math.floor(n / 4) % 3) + (n % 4),
  );
  return new Volume(
    new Pack(
      makePack(
        {
          size: [4, 3, 2],
          spacing_mm: [2, 1, 0.5],
          origin: [10, 20, 30],
          direction,
          source_size: [4, 3, 2],
          reduction: [1, 1, 1],
          scale: 2,
          offset: -5,
          window: [0, 100],
          name: "v",
        },
        { voxel: { type: "u16", shape: [2, 3, 4], data } },
      ),
    ),
  );
}

describe("Volume", () => {
  it("samplesTrilinearlyInIntensities", () => {
    expect(volume().sample([10 + 2 * 1.5, 20 + 0.25, 30 + 0.5 * 0.5])).toBeCloseTo(
      2 * (1.5 + 10 * 0.25 + 100 * 0.5) - 5,
      10,
    );
  });
  it("isNotANumberOutside", () => {
    expect(volume().sample([9.9, 20, 30])).toBeNaN();
    expect(volume().sample([10, 22.1, 30])).toBeNaN();
  });
  it("reachesItsLastVoxels", () => {
    expect(volume().sample([16, 22, 30.5])).toBe(2 * 123 - 5);
  });
  it("findsIndicesThroughTurnedAxes", () => {
    const turned = volume([0, -1, 0, 1, 0, 0, 0, 0, 1]); // first axis along +y, second along -x
    expect(turned.index(turned.position([3, 2, 1])).map(x => Number(x.toFixed(9)))).toEqual([3, 2, 1]);
    expect(turned.position([1, 0, 0])).toEqual([10, 22, 30]);
  });
  it("toTextureTakesCornersToZeroAndOne", () => {
    const v = volume([0, -1, 0, 1, 0, 0, 0, 0, 1]),
      m = v.toTexture();
    const at = (p: number[]): number[] =>
      [0, 1, 2].map(r => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
    at(v.position([-0.5, -0.5, -0.5])).forEach(x => expect(x).toBeCloseTo(0, 9));
    at(v.position([3.5, 2.5, 1.5])).forEach(x => expect(x).toBeCloseTo(1, 9));
  });
  it("refusesASizeThatDoesNotFit", () => {
    expect(
      () =>
        new Volume(
          new Pack(
            makePack(
              { size: [4, 3, 3], spacing_mm: [1, 1, 1] },
              { voxel: { type: "u8", shape: [24], data: new Uint8Array(24) } },
            ),
          ),
        ),
    ).toThrow(/does not fit/);
  });
  it("countsEachVoxelOnce", () => {
    expect(
      volume()
        .histogram(8)
        .counts.reduce((a, b) => a + b, 0),
    ).toBe(24);
  });
});
describe("reduce", () => {
  it("keepsTheGreatestOfEachCell", () => {
    const r = reduce(volume(), 2, -5, 2 * 255 - 5); // stored 0 to 255 become 0 to 255
    expect(r.size).toEqual([2, 2, 2]);
    expect(Array.from(r.data)).toEqual([11, 13, 21, 23, 111, 113, 121, 123]);
    expect(Array.from(r.blocks.data)).toEqual([123]);
  });
});
