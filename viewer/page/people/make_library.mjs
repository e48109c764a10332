// SPDX-License-Identifier: Apache-2.0
// Libraries as spec/library.md has them, of cases that are made up: what a case is called and measures is given, what its files hold
// is not looked at by pages.
import { createHash } from "node:crypto";
import { mkdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { deflateSync } from "node:zlib";

const kMedia = {
  lumen: "application/octet-stream",
  png: "image/png",
  html: "text/html",
  glb: "model/gltf-binary",
  xml: "application/xml",
};
const sha256 = bytes => createHash("sha256").update(bytes).digest("hex");

/** The checksum of PNG (ISO 3309). */
function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

/** A PNG of one colour, [red, green, blue]. */
export function png(colour, width = 50, height = 40) {
  const row = Buffer.concat([Buffer.from([0]), Buffer.concat(Array(width).fill(Buffer.from(colour)))]);
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]),
      head = Buffer.alloc(4),
      end = Buffer.alloc(4);
    head.writeUInt32BE(data.length);
    end.writeUInt32BE(crc32(body));
    return Buffer.concat([head, body, end]);
  };
  const size = Buffer.alloc(8);
  size.writeUInt32BE(width, 0);
  size.writeUInt32BE(height, 4);
  return Buffer.concat([
    Buffer.from("\x89PNG\r\n\x1a\n", "latin1"),
    chunk("IHDR", Buffer.concat([size, Buffer.from([8, 2, 0, 0, 0])])),
    chunk("IDAT", deflateSync(Buffer.concat(Array(height).fill(row)))),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}

const place = (label, i) => ({ position: [i, -2.5 * i, 10], direction: [0, 0, 1], radius: 1.5, ...label });

/** A record of `given`: {id, title, ...}, any key of a record. `files`: {path: {role, target, bytes}}. */
function recordOf(given, files) {
  const { labels = ["root"], ...keys } = given;
  return {
    format: "lumen-library-case",
    formatVersion: 1,
    version: 1,
    date: "2026-11-22",
    description: "",
    anatomy: { text: "", codes: [] },
    laterality: "unknown",
    modality: "other",
    synthetic: true,
    licence: "CC-BY-4.0",
    attribution: "",
    doi: "",
    origin: "",
    consent: "",
    deidentification: "",
    units: "mm",
    frame: "LPS",
    bounds: { min: [0, 0, 0], max: [10, 20, 30] },
    figures: {
      branches: 1,
      aneurysms: 0,
      nodes: 10,
      length_mm: 10,
      radius_mm: { min: 1, mean: 1.5, max: 2 },
      fit_error_mm: null,
      reachable_mm: null,
    },
    insertions: labels.map((label, i) => place({ label }, i)),
    ends: [
      place({ name: "inlet", kind: "inlet" }, 0),
      ...labels.map((label, i) => place({ name: `outlet-${label}`, kind: "outlet" }, i)),
    ],
    provenance: { case_sha256: sha256("case"), generator: "lumen 0.1.0", source: null, steps: [] },
    ...keys,
    files: Object.entries(files)
      .sort(([a], [b]) => (a < b ? -1 : 1))
      .map(([path, { role, target, bytes }]) => ({
        path,
        role,
        ...(target === undefined ? {} : { target }),
        media: kMedia[path.split(".").at(-1)] ?? "application/octet-stream",
        bytes: bytes.length,
        sha256: sha256(bytes),
      })),
  };
}

/** Writes a library of `cases` (as recordOf takes them, and `files` in each) and of `about`, keys of library.json. */
export function writeLibrary(folder, cases, about = {}) {
  const entries = cases.map(given => {
    const { files = {}, ...keys } = given,
      all = { "case.lumen": { role: "case", bytes: Buffer.from(`case ${given.id}`) }, ...files };
    const home = join(folder, "data", given.id),
      text = JSON.stringify(recordOf(keys, all), null, 2);
    for (const [path, { bytes }] of Object.entries(all)) {
      mkdirSync(dirname(join(home, path)), { recursive: true });
      writeFileSync(join(home, path), bytes);
    }
    writeFileSync(join(home, "record.json"), text);
    return {
      id: given.id,
      version: given.version ?? 1,
      title: given.title,
      record: { bytes: Buffer.byteLength(text), sha256: sha256(text) },
      files: Object.keys(all).length,
      bytes: Object.values(all).reduce((sum, file) => sum + file.bytes.length, 0),
    };
  });
  entries.sort((a, b) => (a.id < b.id ? -1 : 1));
  mkdirSync(join(folder, "data"), { recursive: true });
  writeFileSync(join(folder, "data/ro-crate-metadata.json"), "{}");
  writeFileSync(
    join(folder, "library.json"),
    JSON.stringify(
      {
        format: "lumen-library",
        formatVersion: 1,
        id: "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4",
        revision: 1,
        previous: null,
        title: "Cases",
        description: "",
        publisher: "",
        licence: "CC-BY-4.0",
        date: "2026-11-22",
        generator: "lumen 0.1.0",
        ...about,
        cases: entries,
      },
      null,
      2,
    ),
  );
}

/** `n` cases that differ in everything the gallery tells apart, by rules a person can follow: case i (from 0). */
export function manyCases(n) {
  const anatomies = ["carotid siphon", "coronary arteries", "thoracic aorta"],
    sides = ["left", "right", "midline"],
    modalities = ["XA", "CT", "MR", "synthetic"];
  return Array.from({ length: n }, (_, i) => ({
    id: `case-${String(i).padStart(5, "0")}`,
    title: `${i % 2 === 0 ? "Study" : "Pièce"} ${i + 1}`,
    anatomy: {
      text: anatomies[i % 3],
      codes: [{ system: "FMA", code: String(7000 + (i % 3)), name: anatomies[i % 3] }],
    },
    laterality: sides[i % 3],
    modality: modalities[i % 4],
    synthetic: i % 4 === 3,
    licence: i % 5 === 0 ? "CC0-1.0" : "CC-BY-4.0",
    consent: "Written consent.",
    deidentification: "No identifiers were in the source.",
    labels: ["root", `branch${i}`],
    figures: {
      branches: 1 + (i % 7),
      aneurysms: i % 6 === 0 ? 1 : 0,
      nodes: 100 + i,
      length_mm: 100 + i,
      radius_mm: { min: 0.5 + (i % 4) / 10, mean: 1.5, max: 2 + (i % 10) },
      fit_error_mm: null,
      reachable_mm: 100 + i,
      // every third case comes from a version that did not measure
      ...(i % 3 === 1
        ? {}
        : {
            geometry: {
              path_tortuosity: i / 100,
              path_turning_deg_per_cm: 30,
              take_off_deg: null,
              nascet_percent: i % 2 === 0 ? i : null,
              aneurysm_reach_mm: i % 6 === 0 ? 3 + i / 10 : null,
              aneurysm_neck_mm: i % 6 === 0 ? 3 : null,
            },
          }),
    },
    files: { "picture.png": { role: "picture", bytes: png([200 - (i % 7) * 20, 60, 60]) } },
  }));
}
