// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { makePack, Pack } from "./pack";

const bytes = makePack({ kind: "closed" }, {
  radius: { type: "f32", shape: [3], data: new Float32Array([1, 2.5, 4]) },
  triangle: { type: "u32", shape: [1, 3], data: new Uint32Array([0, 1, 2]) },
});

describe("Pack", () => {
  it("givesArraysAndOtherMembers", () => {
    const pack = new Pack(bytes);
    expect(Array.from(pack.get("radius", "f32"))).toEqual([1, 2.5, 4]);
    expect(Array.from(pack.get("triangle", "u32"))).toEqual([0, 1, 2]);
    expect(pack.shape("triangle")).toEqual([1, 3]);
    expect(pack.meta.kind).toBe("closed");
  });
  it("beginsArraysAtMultiplesOfEightBytes", () => {
    const pack = new Pack(bytes);
    expect(pack.begin("radius") % 8).toBe(0);
    expect(pack.begin("triangle") % 8).toBe(0);
  });
  it("refusesAnotherType", () => { expect(() => new Pack(bytes).get("radius", "u32")).toThrow(/type f32, expected u32/); });
  it("refusesAnArrayThatEndsBeyondIt", () => { expect(() => new Pack(bytes.slice(0, bytes.length - 8)).get("triangle", "u32")).toThrow(/ends beyond/); });
  it("refusesAHeaderThatIsCutOff", () => { expect(() => new Pack(bytes.slice(0, 12))).toThrow(/cut off/); });
  it("refusesAHeaderOfAnImpossibleLength", () => { expect(() => new Pack(new Uint8Array([255, 255, 255, 255, 0, 0, 0, 0]))).toThrow(/cannot be/); });
  it("doesNotTakeInheritedNamesForArrays", () => { expect(() => new Pack(bytes).any("constructor")).toThrow(/no array/); });
});
