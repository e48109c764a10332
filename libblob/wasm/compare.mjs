// SPDX-License-Identifier: Apache-2.0
// Holds blob.wasm to the native library: compare.mjs BLOB.wasm MODEL.lumen QUERIES, the last written by
// query_samples. Exit code 1 if any number of a one-evaluation query differs by a bit, or a distance refined by
// Newton's method by more than 1e-12 mm.
import { readFileSync } from "node:fs";
import { Flags, load } from "./blob.mjs";

const [wasm, lumen, queries] = process.argv.slice(2).map(file => readFileSync(file));
// of each query: flags (as a double), point, value, gradient, distance, normal, node, state
const kNumbers = 14;
const native = new Float64Array(queries.buffer, queries.byteOffset, queries.length / 8);
const blob = await load(wasm);
const model = blob.open(lumen);
const count = native.length / kNumbers;

let different = 0, refinedDiffer = 0, greatest = 0, inside = 0;
const same = (/** @type {number} */ a, /** @type {number} */ b) => Object.is(a, b);
for (const flags of new Set(Array.from({ length: count }, (_, i) => native[i * kNumbers]))) {
  const rows = [...Array(count).keys()].filter(i => native[i * kNumbers] === flags);
  const batch = model.batch(rows.length);
  const points = batch.points;
  rows.forEach((row, i) => points.set(native.subarray(row * kNumbers + 1, row * kNumbers + 4), 3 * i));
  batch.query(flags);
  rows.forEach((row, i) => {
    const s = batch.sample(i);
    const ours = [s.value, ...s.gradient, s.distance, ...s.normal, s.node, s.state];
    const theirs = native.subarray(row * kNumbers + 4, (row + 1) * kNumbers);
    const equal = ours.every((x, k) => same(x, theirs[k]));
    if (flags & Flags.DISTANCE_EXACT) refinedDiffer += Number(!equal);
    else different += Number(!equal);
    greatest = Math.max(greatest, Math.abs(s.distance - theirs[4]));
    inside += Number(s.inside);
  });
  batch.free();
}
const { nodeCount } = model.describe();
model.close();
console.log(`${count} queries of ${nodeCount} nodes, ${inside} inside: ${different} differ, and of the ` +
  `refined ones ${refinedDiffer}, by up to ${greatest} mm`);
let refusal = "";
try { blob.open(new Uint8Array(100)); } catch (error) { refusal = String(error); }
console.log(refusal);
process.exit(different === 0 && greatest < 1e-12 && count > 0 && inside > 0 && inside < count && refusal !== "" ? 0 : 1);
