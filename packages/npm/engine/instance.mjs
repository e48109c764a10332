// SPDX-License-Identifier: Apache-2.0
// @ts-check
// One instance of lumen.wasm: its memory, the functions that it imports, and calls of those that it exports.

/** Kinds of failures, by the statuses of lumen/engine.h. @type {Record<number, import("./index.js").FaultKind>} */
const kKinds = { 1: "failed", 2: "usage", 3: "input", 4: "unsupported", 5: "memory", 130: "cancelled" };

const kBadDescriptor = 8; // errno of WASI
const kNotSupported = 52;

/** A failure, with one sentence for people as its message. */
export class LumenError extends Error {
  /** @param {import("./index.js").FaultKind} kind
   * @param {string} message
   * @param {unknown} [cause] */
  constructor(kind, message, cause) {
    super(message, cause === undefined ? undefined : { cause });
    this.name = "LumenError";
    this.kind = kind;
  }
}

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** The functions of WASI that the module imports: clocks, random bytes, no environment and no files.
 * @param {WebAssembly.Module} module
 * @param {() => DataView<ArrayBuffer>} view the module's memory */
function wasiOf(module, view) {
  /** @type {Record<string, (...values: any[]) => number>} */
  const wasi = {
    clock_time_get(clock, _precision, to) {
      const milliseconds = clock === 0 ? Date.now() : performance.now();
      view().setBigUint64(to, BigInt(Math.round(milliseconds * 1e6)), true);
      return 0;
    },
    clock_res_get(_clock, to) {
      view().setBigUint64(to, 1000n, true);
      return 0;
    },
    random_get(to, size) {
      const kMost = 65536; // of one call of getRandomValues()
      for (let at = 0; at < size; at += kMost)
        crypto.getRandomValues(new Uint8Array(view().buffer, to + at, Math.min(kMost, size - at)));
      return 0;
    },
    environ_sizes_get(count, size) {
      view().setUint32(count, 0, true);
      view().setUint32(size, 0, true);
      return 0;
    },
    environ_get: () => 0,
    fd_prestat_get: () => kBadDescriptor,
    proc_exit(code) {
      throw new Error(`the module exits with ${code}`);
    },
  };
  const names = WebAssembly.Module.imports(module).filter((i) => i.module.startsWith("wasi"));
  return Object.fromEntries(names.map((i) => [i.name, wasi[i.name] ?? (() => kNotSupported)]));
}

/** The module with a memory of its own, which is given back with this object. A call that ends in a trap leaves an instance
 * that takes no more calls. */
export class Instance {
  /** @param {WebAssembly.Module} module
   * @param {import("./index.js").Listener} listener
   * @param {Record<string, (...values: any[]) => number | void>} more functions that another module imports from "lumen" */
  static async create(module, listener, more = {}) {
    const made = new Instance();
    made.#listener = listener;
    const imports = {
      wasi_snapshot_preview1: wasiOf(module, () => new DataView(made.#memory.buffer)),
      lumen: {
        stage: (/** @type {number} */ name) => made.#hear(() => made.#listener.onStage?.(made.text(name))),
        progress: (/** @type {number} */ done) => made.#hear(() => made.#listener.onProgress?.(done)),
        warning: (/** @type {number} */ text) => made.#hear(() => made.#listener.onWarning?.(made.text(text))),
        is_cancelled: () => Number(made.#thrown !== undefined || made.#listener.signal?.aborted === true),
        ...more,
      },
    };
    const { exports } = await WebAssembly.instantiate(module, imports);
    made.#exports = /** @type {any} */ (exports);
    made.#memory = /** @type {WebAssembly.Memory} */ (exports.memory);
    made.#exports._initialize();
    return made;
  }

  /** @type {Record<string, (...values: number[]) => number>} */ #exports = {};
  /** @type {WebAssembly.Memory} */ #memory = /** @type {any} */ (undefined);
  /** @type {import("./index.js").Listener} */ #listener = {};
  /** @type {{error: unknown} | undefined} what the listener threw */ #thrown;
  /** @type {unknown} */ #trap;

  /** Calls the listener. An exception cannot pass through the module: the call is cancelled, and then throws it.
   * @param {() => void} call */
  #hear(call) {
    if (this.#thrown) return;
    try {
      call();
    } catch (error) {
      this.#thrown = { error };
    }
  }

  /** Result of an exported function. Throws LumenError.
   * @param {string} name
   * @param {number[]} values */
  call(name, ...values) {
    if (this.#trap !== undefined) throw new LumenError("failed", "the module has stopped in a call before", this.#trap);
    try {
      return this.#exports[name](...values) >>> 0;
    } catch (error) {
      this.#trap = error;
      throw new LumenError("failed", `the module stops: ${/** @type {Error} */ (error).message}`, error);
    }
  }

  /** Product of an exported function that returns a status. Throws LumenError, or what the listener threw.
   * @param {import("./index.js").Listener | undefined} listener heard during this call
   * @param {string} name
   * @param {number[]} values */
  make(listener, name, ...values) {
    const before = this.#listener;
    this.#listener = listener ?? before;
    this.#thrown = undefined;
    try {
      const status = this.call(name, ...values);
      if (this.#thrown !== undefined) throw (/** @type {{error: unknown}} */ (this.#thrown)).error;
      if (status !== 0) throw new LumenError(kKinds[status] ?? "failed", this.text(this.call("lumen_fault")));
      return this.call("lumen_made");
    } finally {
      this.#listener = before;
    }
  }

  /** Address of a copy of these bytes. @param {Uint8Array} bytes */
  put(bytes) {
    const at = this.call("malloc", Math.max(1, bytes.length));
    if (at === 0) throw new LumenError("memory", `the module has no room for ${bytes.length} bytes more`);
    this.write(at, bytes);
    return at;
  }
  /** Copies bytes to an address. @param {number} at
   * @param {Uint8Array} bytes */
  write(at, bytes) {
    new Uint8Array(this.#memory.buffer).set(bytes, at);
  }
  /** Address of a copy of this text. @param {string} text */
  putText(text) {
    return this.put(encoder.encode(`${text}\0`));
  }
  /** @param {number} at */
  free(at) {
    this.call("free", at);
  }

  /** The text at an address. @param {number} at */
  text(at) {
    const bytes = new Uint8Array(this.#memory.buffer);
    return decoder.decode(bytes.slice(at, bytes.indexOf(0, at)));
  }
  /** A copy of bytes. @param {number} at
   * @param {number} size */
  bytes(at, size) {
    return new Uint8Array(this.#memory.buffer).slice(at, at + size);
  }
  /** The copied numbers of a product of bytes, which is freed. @param {number} product */
  taken(product) {
    const bytes = this.bytes(this.call("lumen_bytes_data", product), this.call("lumen_bytes_size", product));
    this.call("lumen_free_bytes", product);
    return bytes;
  }
}
