// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { makePack, Pack } from "./pack";

const bytes = makePack(
  { kind: "closed" },
  {
    radius_mm: { type: "f32", shape: [3], data: new Float32Array([1, 2.5, 4]) },
    triangle: { type: "u32", shape: [1, 3], data: new Uint32Array([0, 1, 2]) },
  },
);

/** A pack whose only array is stored as `place` states. */
function coded(place: Record<string, unknown>, stored: Uint8Array): Uint8Array {
  const text = JSON.stringify({ arrays: { a: { ...place, offset: 0 } } }),
    header = Math.ceil((text.length + 4) / 8) * 8 - 4;
  const all = new Uint8Array(4 + header + stored.length).fill(32);
  new DataView(all.buffer).setUint32(0, header, true);
  all.set(new TextEncoder().encode(text), 4);
  all.set(stored, 4 + header);
  return all;
}

describe("Pack", () => {
  it("givesArraysAndOtherMembers", () => {
    const pack = new Pack(bytes);
    expect(Array.from(pack.get("radius_mm", "f32"))).toEqual([1, 2.5, 4]);
    expect(Array.from(pack.get("triangle", "u32"))).toEqual([0, 1, 2]);
    expect(pack.shape("triangle")).toEqual([1, 3]);
    expect(pack.meta.kind).toBe("closed");
  });
  it("beginsArraysAtMultiplesOfEightBytes", () => {
    const pack = new Pack(bytes);
    expect(pack.begin("radius_mm") % 8).toBe(0);
    expect(pack.begin("triangle") % 8).toBe(0);
  });
  it("refusesAnotherType", () => {
    expect(() => new Pack(bytes).get("radius_mm", "u32")).toThrow(/type f32, expected u32/);
  });
  it("refusesAnArrayThatEndsBeyondIt", () => {
    expect(() => new Pack(bytes.slice(0, bytes.length - 8)).get("triangle", "u32")).toThrow(/ends beyond/);
  });
  it("refusesAHeaderThatIsCutOff", () => {
    expect(() => new Pack(bytes.slice(0, 12))).toThrow(/cut off/);
  });
  it("refusesAHeaderOfAnImpossibleLength", () => {
    expect(() => new Pack(new Uint8Array([255, 255, 255, 255, 0, 0, 0, 0]))).toThrow(/cannot be/);
  });
  it("decodesDifferencesInStepsFromPlanesOfBytes", () => {
    // two columns of u16: 0 258 257 (modulo 65536) and 5 5 6
    const stored = new Uint8Array([0, 2, 255, 0, 1, 255, 5, 0, 1, 0, 0, 0]);
    const pack = new Pack(
      coded(
        { type: "f32", shape: [3, 2], stored: "u16", coding: "differences", low: [1, 0], step: [0.5, 2] },
        stored,
      ),
    );
    expect(Array.from(pack.get("a", "f32"))).toEqual([1, 10, 130, 10, 129.5, 12]);
    expect(pack.get("a", "f32")).toBe(pack.get("a", "f32"));
  });
  it("decodesTrianglesThatCountBack", () => {
    const values = [0, 0, 0, 2, 1, 0, 0xffffffff, 0, 5],
      columns = [0, 1, 2].map(c => values.filter((_, i) => i % 3 === c));
    const stored = new Uint8Array(
      columns.flatMap(column => [0, 8, 16, 24].flatMap(shift => column.map(v => (v >>> shift) & 255))),
    );
    const pack = new Pack(coded({ type: "u32", shape: [3, 3], stored: "u32", coding: "back" }, stored));
    expect(Array.from(pack.get("a", "u32"))).toEqual([0, 1, 2, 1, 2, 3, 5, 6, 2]);
  });
  it("refusesCodedBytesThatEndBeyondIt", () => {
    expect(() =>
      new Pack(
        coded({ type: "u32", shape: [3], stored: "u32", coding: "differences" }, new Uint8Array(8)),
      ).get("a", "u32"),
    ).toThrow(/ends beyond/);
  });
  it("doesNotTakeInheritedNamesForArrays", () => {
    expect(() => new Pack(bytes).any("constructor")).toThrow(/no array/);
  });
});
