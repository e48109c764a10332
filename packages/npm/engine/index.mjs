// SPDX-License-Identifier: Apache-2.0
// @ts-check
// The engine for pages and workers: lumen.wasm is fetched from beside this module.
import { Engine } from "./engine.mjs";

export { Case, Engine, LumenError } from "./engine.mjs";

/** @type {Promise<Engine> | undefined} */
let engine;

/** The engine, compiled once. Rejects if lumen.wasm cannot be fetched.
 * @param {string | URL} [file] lumen.wasm, where it is not beside this module; only the first call counts */
export function loadEngine(file = new URL("./lumen.wasm", import.meta.url)) {
  engine ??= WebAssembly.compileStreaming(fetch(file))
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
