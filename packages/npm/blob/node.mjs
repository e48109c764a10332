// SPDX-License-Identifier: Apache-2.0
// @ts-check
// libblob for Node: blob.wasm is read from beside this module.
import { readFile } from "node:fs/promises";
import { load } from "./blob.mjs";

export * from "./blob.mjs";

/** @type {Promise<import("./blob.mjs").Blob> | undefined} */
let library;

/** The library, compiled once for each thread. Rejects if blob.wasm cannot be read.
 * @param {string | URL} [file] blob.wasm, where it is not beside this module; only the first call counts
 * @returns {Promise<import("./blob.mjs").Blob>} */
export function loadBlob(file = new URL("./blob.wasm", import.meta.url)) {
  library ??= readFile(file)
    .then(load)
    .catch((error) => {
      library = undefined; // a later call tries again
      throw error;
    });
  return library;
}
