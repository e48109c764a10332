// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import { isCaseFile, packOfCase } from "./case_file";
import { Pack } from "./pack";
import { Tree } from "./tree";

const kSignature = [0x8c, 0x4c, 0x55, 0x4d, 0x45, 0x4e, 0x0d, 0x0a, 0x1a, 0x0a];

/** The bytes of a file with these chunks, without checksums, which libblob looks at and the page does not. */
function fileOf(chunks: Record<string, ArrayBuffer | string>, encoding = 0): Uint8Array {
  const parts = Object.entries(chunks).map(([name, part]) => ({
    name,
    bytes: typeof part === "string" ? new TextEncoder().encode(part) : new Uint8Array(part),
  }));
  const file = new Uint8Array(
      64 * (1 + parts.length) + parts.reduce((sum, p) => sum + 64 * Math.ceil(p.bytes.length / 64), 0),
    ),
    view = new DataView(file.buffer);
  file.set([...kSignature, 1, 1, 1, 0]);
  view.setUint32(24, parts.length, true);
  let at = 64 * (1 + parts.length);
  parts.forEach(({ name, bytes }, i) => {
    const row = 64 * (1 + i);
    file.set(new TextEncoder().encode(name), row);
    file[row + 6] = 1;
    file[row + 7] = encoding;
    view.setBigUint64(row + 8, BigInt(at), true);
    view.setBigUint64(row + 16, BigInt(bytes.length), true);
    file.set(bytes, at);
    at += 64 * Math.ceil(bytes.length / 64);
  });
  return file;
}

/** Two vessels of two nodes along x and from (1, 0, 0) along y; radii 0.25. */
function twoVessels(): Record<string, ArrayBuffer | string> {
  const records = new DataView(new ArrayBuffer(48));
  for (const [i, [first, parent, label, size]] of [
    [0, -1, 0, 5],
    [2, 1, 5, 6],
  ].entries()) {
    records.setUint32(24 * i, first, true);
    records.setUint32(24 * i + 4, 2, true);
    records.setInt32(24 * i + 8, parent, true);
    records.setUint32(24 * i + 12, label, true);
    records.setUint16(24 * i + 16, size, true);
    records.setUint8(24 * i + 19, 3);
    records.setFloat32(24 * i + 20, i === 0 ? 0.75 : -1, true);
  }
  const floats = (...x: number[]): ArrayBuffer => new Float32Array(x).buffer;
  return {
    META: '{"coordinateSystem": "LPS", "units": "mm", "voxelSize": 0.5, "steps": []}',
    NCEN: floats(0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 2, 0),
    NDIR: floats(1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0),
    NRAD: floats(0.25, 0.25, 0.25, 0.25),
    NHEI: floats(1, 1, 1, 1),
    NPAR: new Int32Array([-1, 0, 1, 2]).buffer,
    NBRA: new Uint32Array([0, 0, 1, 1]).buffer,
    BREC: records.buffer,
    BLAB: "trunkbranch",
  };
}

test("a file's tree has the labels, lengths and numbers of lumen info", () => {
  const file = fileOf(twoVessels()),
    tree = new Tree(new Pack(packOfCase(file)));
  expect(isCaseFile(file)).toBe(true);
  expect(tree.branches.map(b => [b.label, b.length_mm, b.confidence, b.stop_reason])).toEqual([
    ["trunk", 1, 0.75, "left-volume"],
    ["branch", 1.75, null, "left-volume"], // 0.25 of the first edge lie in the trunk
  ]);
  expect([...tree.rootDistance]).toEqual([0, 1, 1.75, 2.75]);
  expect(tree.hasModels).toBe(false);
  expect(tree.voxelSize).toBe(0.5);
});

test("a file's lengths are those that lumen info states, to a hundred-thousandth of a millimetre", () => {
  const file = readFileSync(new URL("../../../../tests/data/cases-0.1.0/fork.lumen", import.meta.url)),
    tree = new Tree(new Pack(packOfCase(new Uint8Array(file))));
  expect(tree.branches[0].length_mm).toBeCloseTo(9.408174830349738, 5);
  expect(tree.branches[1].length_mm).toBeCloseTo(5.37740339837881, 5);
});

test("a file's branches have the system that most of their nodes have", () => {
  const file = fileOf({
      ...twoVessels(),
      META: '{"nodeArrays": [{"name": "A_b.c", "type": "f32", "components": 1}, {"name": "LUMEN_vessel.system", "type": "u32", "components": 1}]}',
    }),
    rows = file[24] + 1,
    arrays = [new Float32Array(4), new Uint32Array([2, 2, 4, 4])];
  expect(new Tree(new Pack(packOfCase(file))).systems).toEqual([]);
  // two chunks of one name, which fileOf() does not make
  const whole = new Uint8Array(file.length + 256),
    view = new DataView(whole.buffer);
  whole.set(file.subarray(0, 64 * rows));
  whole.set(file.subarray(64 * rows), 64 * rows + 128);
  for (let row = 1; row < rows; ++row)
    view.setBigUint64(64 * row + 8, view.getBigUint64(64 * row + 8, true) + 128n, true);
  arrays.forEach((array, i) => {
    const row = 64 * (rows + i),
      at = file.length + 128 + 64 * i;
    whole.set(new TextEncoder().encode("NARR"), row);
    view.setBigUint64(row + 8, BigInt(at), true);
    view.setBigUint64(row + 16, 16n, true);
    whole.set(new Uint8Array(array.buffer), at);
  });
  view.setUint32(24, rows + 1, true);
  const tree = new Tree(new Pack(packOfCase(whole)));
  expect(tree.branches.map(b => b.system)).toEqual(["vein", "false-lumen"]);
  expect(tree.systems).toEqual(["vein", "false-lumen"]);
});

test("a file that is cut off, compressed or of a later kind is refused with a sentence", () => {
  const whole = fileOf(twoVessels()),
    later = whole.slice();
  later[12] = 2;
  expect(() => packOfCase(whole.slice(0, whole.length - 64))).toThrow("cut off");
  expect(() => packOfCase(whole.slice(0, 40))).toThrow("no .lumen file");
  expect(() => packOfCase(later)).toThrow("newer reader");
  expect(() => packOfCase(fileOf(twoVessels(), 1))).toThrow("compressed");
});

test("indices beyond the case and chunks of a wrong size are refused", () => {
  for (const [name, bytes] of Object.entries({
    NPAR: new Int32Array([-1, 0, 1, 3]).buffer,
    NBRA: new Uint32Array([0, 0, 1, 2]).buffer,
    NCEN: new Float32Array(11).buffer,
    LINK: new Uint32Array([0, 4]).buffer,
    NRAD: new Float32Array(0).buffer,
  }))
    expect(() => packOfCase(fileOf({ ...twoVessels(), [name]: bytes })), name).toThrow();
});
