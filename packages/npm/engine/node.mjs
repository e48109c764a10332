// SPDX-License-Identifier: Apache-2.0
// @ts-check
// The engine for Node: lumen.wasm is read from beside this module.
import { readFile } from "node:fs/promises";
import { webcrypto } from "node:crypto";
import { Engine } from "./engine.mjs";

export { Case, Engine, LumenError } from "./engine.mjs";

globalThis.crypto ??= /** @type {any} */ (webcrypto); // Node 18 has it as a module alone

/** @type {Promise<Engine> | undefined} */
let engine;

/** The engine, compiled once for each thread. Rejects if lumen.wasm cannot be read.
 * @param {string | URL} [file] lumen.wasm, where it is not beside this module; only the first call counts */
export function loadEngine(file = new URL("./lumen.wasm", import.meta.url)) {
  engine ??= readFile(file)
    .then((bytes) => WebAssembly.compile(bytes))
    .then((module) => new Engine(module))
    .catch((error) => {
      engine = undefined; // a later call tries again
      throw error;
    });
  return engine;
}

/** Engine.caseOf() of the engine that is loaded.
 * @param {import("./index.js").Source} source
 * @param {import("./index.js").Inputs} [inputs] */
export async function caseOf(source, inputs) {
  return (await loadEngine()).caseOf(source, inputs);
}
