// SPDX-License-Identifier: Apache-2.0
// @ts-check
// Cases of vessels by lumen.wasm. Each call works in an instance of its own, whose memory goes with it; a case keeps one.
import { Instance, LumenError } from "./instance.mjs";

export { LumenError };

/** Parts of the inputs that are files, by their numbers in the module. */
const kParts = /** @type {const} */ ({ seeds: 1, corrected: 2, labelMap: 3, labelTable: 4, centerline: 5 });
const kTypes = { Int16Array: 0, Uint8Array: 1, Uint16Array: 2, Float32Array: 3 };
const kNone = 0xffffffff;

/** @param {ArrayBufferView | ArrayBuffer} bytes */
function asBytes(bytes) {
  if (bytes instanceof ArrayBuffer) return new Uint8Array(bytes);
  if (ArrayBuffer.isView(bytes)) return new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  throw new LumenError("usage", `the bytes are ${typeof bytes}; expected a Uint8Array or an ArrayBuffer`);
}

/** Lets `work` have options in the module's memory.
 * @template T
 * @param {Instance} instance
 * @param {import("./index.js").Options} options by their names in the help, or in camel case
 * @param {(options: number) => T} work */
function withOptions(instance, options, work) {
  const held = instance.make(undefined, "lumen_create_options");
  try {
    for (const [key, given] of Object.entries(options ?? {})) {
      const name = key.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);
      for (const value of Array.isArray(given) ? given : [given]) {
        const texts = [instance.putText(name), instance.putText(String(value))];
        try {
          instance.make(undefined, "lumen_set_option", held, texts[0], texts[1]);
        } finally {
          for (const text of texts) instance.free(text);
        }
      }
    }
    return work(held);
  } finally {
    instance.call("lumen_free_options", held);
  }
}

/** Lets `work` have a source in the module's memory; the copies of its inputs are gone by then.
 * @param {Instance} instance
 * @param {import("./index.js").Source} source
 * @param {import("./index.js").Inputs} inputs
 * @param {number} options */
function loaded(instance, source, inputs, options) {
  const from = instance.call("lumen_create_inputs");
  const held = [from];
  const put = (/** @type {Uint8Array} */ bytes) => held[held.push(instance.put(bytes)) - 1];
  const putText = (/** @type {string} */ text) => put(new TextEncoder().encode(`${text}\0`));
  try {
    if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) {
      const bytes = asBytes(source);
      if (!inputs.name) throw new LumenError("usage", 'the bytes have no name; expected one such as "head.nii.gz", whose ending names the format');
      instance.call("lumen_set_file", from, 0, putText(inputs.name), put(bytes), bytes.length);
    } else {
      const { data, size, affine } = source;
      const type = kTypes[/** @type {keyof typeof kTypes} */ (data?.constructor?.name)];
      if (type === undefined)
        throw new LumenError("usage", `the voxels are ${data?.constructor?.name ?? typeof data}; expected one of ${Object.keys(kTypes).join(", ")}`);
      if (!(size?.length === 3 && size[0] * size[1] * size[2] === data.length))
        throw new LumenError("usage", `the size is ${size} for ${data.length} voxels; expected three numbers with that product`);
      if (affine?.length !== 3 || affine.some((row) => row.length !== 4))
        throw new LumenError("usage", "the affine is no array of three rows of four numbers, mm, LPS");
      const numbers = put(new Uint8Array(Float64Array.from(affine.flat()).buffer));
      instance.call("lumen_set_volume", from, putText(inputs.name ?? "volume"), put(asBytes(data)), type, ...size, numbers);
    }
    for (const [part, number] of Object.entries(kParts)) {
      const file = inputs[/** @type {keyof typeof kParts} */ (part)];
      if (!file) continue;
      const bytes = asBytes(file.bytes);
      instance.call("lumen_set_file", from, number, putText(file.name), put(bytes), bytes.length);
    }
    return instance.make(inputs, "lumen_load", from, options);
  } finally {
    for (const at of held) instance.free(at);
  }
}

/** The tree of vessels, points on their walls, and models. */
export class Case {
  #instance;
  #value;

  /** @param {Instance} instance
   * @param {number} value */
  constructor(instance, value) {
    this.#instance = instance;
    this.#value = value;
  }

  /** Branches of the tree: name, and the number of the branch that it leaves, null for a root.
   * @returns {import("./index.js").Branch[]} */
  get branches() {
    const count = this.#instance.call("lumen_branch_count", this.#value);
    return Array.from({ length: count }, (_, b) => {
      const parent = this.#instance.call("lumen_branch_parent", this.#value, b);
      return { name: this.#instance.text(this.#instance.call("lumen_branch_name", this.#value, b)), parent: parent === kNone ? null : parent };
    });
  }

  /** The bytes of a file. Throws LumenError.
   * @param {string} format "lumen", "glb", "swc" and others
   * @param {import("./index.js").Options & import("./index.js").Listener} [given] options of surfaces and files, and the listener */
  encode(format, given = {}) {
    const { listener, options } = parted(given);
    return withOptions(this.#instance, options, (held) => {
      const name = this.#instance.putText(format);
      try {
        return this.#instance.taken(this.#instance.make(listener, "lumen_encode", this.#value, name, held));
      } finally {
        this.#instance.free(name);
      }
    });
  }

  /** The closed surface of the vessels, mm, LPS. Throws LumenError.
   * @param {import("./index.js").Options & import("./index.js").Listener} [given] options of surfaces, and the listener
   * @returns {import("./index.js").Surface} */
  surface(given = {}) {
    const { listener, options } = parted(given);
    const instance = this.#instance;
    return withOptions(instance, options, (held) => {
      const made = instance.make(listener, "lumen_surface_of", this.#value, held);
      const at = instance.call("lumen_mesh", made);
      const [vertices, position, normal, radius, branch, triangles, triangle, group, groups] = new Uint32Array(instance.bytes(at, 36).buffer);
      const floats = (/** @type {number} */ from, /** @type {number} */ count) => new Float32Array(instance.bytes(from, 4 * count).buffer);
      const numbers = (/** @type {number} */ from, /** @type {number} */ count) => new Uint32Array(instance.bytes(from, 4 * count).buffer);
      const surface = {
        positions: floats(position, 3 * vertices),
        normals: floats(normal, 3 * vertices),
        radii: floats(radius, vertices),
        branches: numbers(branch, vertices),
        triangles: numbers(triangle, 3 * triangles),
        groups: numbers(group, triangles),
        groupNames: Array.from({ length: groups }, (_, g) => instance.text(instance.call("lumen_group_name", made, g))),
      };
      instance.call("lumen_free_surface", made);
      return surface;
    });
  }
}

/** The listener and the options of an object that has both.
 * @param {Record<string, any>} given */
function parted(given) {
  const { onStage, onProgress, onWarning, signal, ...options } = given;
  return { listener: { onStage, onProgress, onWarning, signal }, options };
}

/** The engine over a compiled lumen.wasm. */
export class Engine {
  #module;

  /** @param {WebAssembly.Module} module */
  constructor(module) {
    this.#module = module;
  }

  /** Finds, tracks, names and fits the vessels of a source. The work is done in this thread, in one piece: seconds to
   * minutes, which a page leaves to a worker. Rejects with LumenError.
   * @param {import("./index.js").Source} source the bytes of a file, or voxels
   * @param {import("./index.js").Inputs} [inputs] */
  async caseOf(source, inputs = {}) {
    const instance = await Instance.create(this.#module, inputs);
    const bytes = withOptions(instance, inputs.options ?? {}, (options) => {
      const from = loaded(instance, source, inputs, options);
      const made = instance.make(inputs, "lumen_case_of", from, options);
      const format = instance.putText("lumen");
      return instance.taken(instance.make(inputs, "lumen_encode", made, format, 0));
    });
    return this.openCase(bytes); // the memory of the work, which never shrinks, is given back with its instance
  }

  /** The case in the bytes of a file, .lumen or .lumen.json, as it is. Rejects with LumenError.
   * @param {Uint8Array | ArrayBuffer} bytes
   * @param {string} [name] for messages; its ending names the encoding */
  async openCase(bytes, name = "case.lumen") {
    const instance = await Instance.create(this.#module, {});
    const held = asBytes(bytes);
    const file = instance.put(held);
    const made = instance.make(undefined, "lumen_open_case", instance.putText(name), file, held.length);
    instance.free(file);
    return new Case(instance, made);
  }

  /** All options, with their groups, defaults and help.
   * @returns {Promise<import("./index.js").OptionRow[]>} */
  async options() {
    const instance = await Instance.create(this.#module, {});
    return JSON.parse(new TextDecoder().decode(instance.taken(instance.make(undefined, "lumen_list_options"))));
  }

  /** The version of lumen, such as "0.2.0". */
  async version() {
    const instance = await Instance.create(this.#module, {});
    return instance.text(instance.call("lumen_version"));
  }
}
