// SPDX-License-Identifier: Apache-2.0
// DICOM out of a phantom's volume: one file for each slice, explicit little-endian, as a scanner writes them.
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";

/** Voxels of 16 bits, size, spacing and origin of an NRRD that lumen wrote, along the axes of the patient. */
export function readNrrd(path) {
  const bytes = readFileSync(path),
    end = bytes.indexOf("\n\n") + 2,
    header = bytes.subarray(0, end).toString("latin1");
  const field = name => new RegExp(`^${name}: (.*)$`, "m").exec(header)[1];
  const numbers = text => text.match(/-?[\d.]+(e-?\d+)?/g).map(Number),
    rows = numbers(field("space directions"));
  const voxels = field("encoding") === "gzip" ? gunzipSync(bytes.subarray(end)) : bytes.subarray(end);
  return {
    size: numbers(field("sizes")),
    spacing: [rows[0], rows[4], rows[8]],
    origin: numbers(field("space origin")),
    voxels,
  };
}

function element(group, number, type, value) {
  const isLong = ["OW", "OB", "SQ", "UN"].includes(type),
    padded = value.length % 2 === 0 ? value : Buffer.concat([value, Buffer.from(type === "UI" ? "\0" : " ")]),
    head = Buffer.alloc(isLong ? 12 : 8);
  head.writeUInt16LE(group, 0);
  head.writeUInt16LE(number, 2);
  head.write(type, 4, "latin1");
  if (isLong) head.writeUInt32LE(padded.length, 8);
  else head.writeUInt16LE(padded.length, 6);
  return Buffer.concat([head, padded]);
}
const text = (group, number, type, value) => element(group, number, type, Buffer.from(value, "latin1"));
function word(group, number, value) {
  const bytes = Buffer.alloc(2);
  bytes.writeUInt16LE(value, 0);
  return element(group, number, "US", bytes);
}

const kStorage = "1.2.840.10008.5.1.4.1.1.2",
  kExplicit = "1.2.840.10008.1.2.1";

/** The slices of a volume as files: { name, bytes }. `every`: one slice of so many. */
export function dicomSlices(volume, { uid, description, modality = "CT", every = 1 }) {
  const { size, spacing, origin, voxels } = volume,
    plane = size[0] * size[1] * 2,
    files = [];
  for (let k = 0; k < size[2]; k += every) {
    const instance = `${uid}.${k + 1}`,
      place = [origin[0], origin[1], origin[2] + k * spacing[2]];
    const meta = Buffer.concat([
      text(2, 2, "UI", kStorage),
      text(2, 3, "UI", instance),
      text(2, 0x10, "UI", kExplicit),
    ]);
    const length = Buffer.alloc(4);
    length.writeUInt32LE(meta.length, 0);
    const data = [
      text(8, 0x16, "UI", kStorage),
      text(8, 0x18, "UI", instance),
      text(8, 0x60, "CS", modality),
      text(8, 0x103e, "LO", description),
      text(0x10, 0x10, "PN", "Nobody^Real"),
      text(0x20, 0xd, "UI", "1.2.3"),
      text(0x20, 0xe, "UI", uid),
      text(0x20, 0x13, "IS", String(k + 1)),
      text(0x20, 0x32, "DS", place.map(x => x.toFixed(6)).join("\\")),
      text(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0"),
      word(0x28, 2, 1),
      text(0x28, 4, "CS", "MONOCHROME2"),
      word(0x28, 0x10, size[1]),
      word(0x28, 0x11, size[0]),
      text(0x28, 0x30, "DS", `${spacing[1]}\\${spacing[0]}`),
      word(0x28, 0x100, 16),
      word(0x28, 0x101, 16),
      word(0x28, 0x102, 15),
      word(0x28, 0x103, 1),
      element(0x7fe0, 0x10, "OW", voxels.subarray(k * plane, (k + 1) * plane)),
    ];
    files.push({
      name: `IM${String(k + 1).padStart(4, "0")}`,
      bytes: Buffer.concat([
        Buffer.alloc(128),
        Buffer.from("DICM"),
        element(2, 0, "UL", length),
        meta,
        ...data,
      ]),
    });
  }
  return files;
}
