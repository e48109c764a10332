// SPDX-License-Identifier: Apache-2.0
// @ts-check
// libblob in WebAssembly, typed by JSDoc: TypeScript reads this file as it is. Works in browsers and node.
// Units: mm, in the case's frame (LPS). Distances are negative in the lumen. See blob.h.

/** Flags of queries, to be added up; 0 is the default. */
export const Flags = Object.freeze({ LOCAL: 1, DISTANCE_EXACT: 2, HOLD: 4 });
/** Bits of a state. */
export const State = Object.freeze({ INSIDE: 1, NOT_CONVERGED: 2 });
/** Some of the values of blob_status: why a model was not opened. */
export const Status = Object.freeze({ CHECKSUM: 5, ENCODING: 6, NO_MODELS: 7 });
/** A cursor that is not known: the query locates. */
export const NOWHERE = 0xffffffff;

const kPoint = 24, kSample = 72; // bytes: double[3]; blob_sample
const kOpenDef = 20, kInfo = 96, kMessage = 500; // blob_open_def, blob_model_info

/** Compiles and starts the library. @param {BufferSource} wasm the bytes of blob.wasm @returns {Promise<Blob>} */
export async function load(wasm) {
  const { instance } = await WebAssembly.instantiate(wasm), exports = /** @type {any} */ (instance.exports);
  exports._initialize?.();
  return new Blob(exports);
}

/** The library. */
export class Blob {
  /** @param {any} exports */
  constructor(exports) { this.exports = exports; }
  /** Valid until the next call that allocates. */
  get view() { return new DataView(this.exports.memory.buffer); }
  /** @param {number} size bytes @returns {number} address */
  allocate(size) {
    const address = this.exports.malloc(Math.max(size, 1));
    if (address === 0) throw new RangeError(`libblob: no memory for ${size} bytes`);
    return address;
  }
  /** @param {number} address @param {number} [most] @returns {string} zero-terminated UTF-8 there */
  text(address, most = Infinity) {
    const bytes = new Uint8Array(this.exports.memory.buffer, address);
    let size = 0;
    while (size < most && bytes[size] !== 0) ++size;
    return new TextDecoder().decode(bytes.slice(0, size));
  }
  /** Opens the bytes of a .lumen file; throws an Error that says what is wrong, with a number `status`.
   * @param {Uint8Array} bytes @returns {Model} */
  open(bytes) {
    const file = this.allocate(bytes.length), def = this.allocate(kOpenDef + 4 + kMessage);
    new Uint8Array(this.exports.memory.buffer).set(bytes, file);
    this.exports.blob_open_def_default(def);
    const out = def + kOpenDef, message = out + 4;
    this.view.setUint8(message, 0);
    this.view.setUint32(def + 8, message, true);
    this.view.setUint32(def + 12, kMessage, true);
    const status = this.exports.blob_model_open_bytes(file, bytes.length, def, out);
    const handle = this.view.getUint32(out, true);
    const why = this.text(message, kMessage) || this.text(this.exports.blob_status_text(status));
    this.exports.free(file);
    this.exports.free(def);
    if (status !== 0) throw Object.assign(new Error(`libblob: ${why}`), { status });
    return new Model(this, handle);
  }
  /** Models as one buffer of words, from which gpu.mjs answers on a graphics processor; blob_device.h states the layout.
   * @param {Model[]} models at least one @returns {Uint32Array} */
  pack(models) {
    const handles = this.allocate(4 * models.length);
    models.forEach((model, i) => this.view.setUint32(handles + 4 * i, model.handle, true));
    const size = this.exports.blob_device_pack(handles, models.length, 0, 0);
    if (size === 0) throw new RangeError("libblob: no model to pack, or no memory");
    const buffer = this.allocate(size), written = this.exports.blob_device_pack(handles, models.length, buffer, size);
    const words = new Uint32Array(this.exports.memory.buffer.slice(buffer, buffer + size));
    this.exports.free(buffer);
    this.exports.free(handles);
    if (written !== size) throw new RangeError(`libblob: no memory for ${size} bytes`);
    return words;
  }
}

/** A vessel tree. Call close() when done. */
export class Model {
  /** @param {Blob} blob @param {number} handle */
  constructor(blob, handle) { this.blob = blob; this.handle = handle; }
  close() { this.blob.exports.blob_model_close(this.handle); this.handle = 0; }
  /** @returns {{nodeCount: number, blobCount: number, isoLevel: number, low: number[], high: number[]}} mm */
  describe() {
    const info = this.blob.allocate(kInfo);
    this.blob.exports.blob_model_describe(info, this.handle);
    const v = this.blob.view, vector = (/** @type {number} */ at) => [0, 8, 16].map(i => v.getFloat64(at + i, true));
    const result = { nodeCount: v.getUint32(info, true), blobCount: v.getUint32(info + 4, true),
      isoLevel: v.getFloat64(info + 24, true), low: vector(info + 40), high: vector(info + 64) };
    this.blob.exports.free(info);
    return result;
  }
  /** Room for `count` points and their answers, to be kept and used in every step. @param {number} count */
  batch(count) { return new Batch(this, count); }
}

/** Points, their cursors and answers, in the library's memory. Getters give views without a copy; take them
 * anew after anything was opened or allocated. Call free() when done. */
export class Batch {
  /** @param {Model} model @param {number} count */
  constructor(model, count) {
    this.model = model;
    this.count = count;
    this.address = model.blob.allocate(count * (kPoint + kSample + 4));
    this.cursors.fill(NOWHERE);
  }
  get buffer() { return /** @type {ArrayBuffer} */ (this.model.blob.exports.memory.buffer); }
  /** x y z of each point, mm: write here. */
  get points() { return new Float64Array(this.buffer, this.address, 3 * this.count); }
  /** Node of each point; follows it. */
  get cursors() { return new Uint32Array(this.buffer, this.address + this.count * (kPoint + kSample), this.count); }
  /** @param {number} [flags] */
  query(flags = 0) {
    const points = this.address, samples = points + this.count * kPoint, { exports } = this.model.blob;
    exports.blob_query_many(this.model.handle, flags, this.count, points, samples + this.count * kSample, samples);
  }
  /** The answer for point i. @param {number} i */
  sample(i) {
    const at = this.address + this.count * kPoint + i * kSample, d = new Float64Array(this.buffer, at, 8);
    const [node, state] = new Uint32Array(this.buffer, at + 64, 2);
    return { value: d[0], gradient: d.slice(1, 4), distance: d[4], normal: d.slice(5, 8), node, state,
      inside: (state & State.INSIDE) !== 0 };
  }
  /** Signed distances of all points, mm. @returns {Float64Array} */
  distances() {
    const all = new Float64Array(this.buffer, this.address + this.count * kPoint, 9 * this.count);
    return Float64Array.from({ length: this.count }, (_, i) => all[9 * i + 4]);
  }
  free() { this.model.blob.exports.free(this.address); this.address = 0; }
}
