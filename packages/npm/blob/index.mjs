// SPDX-License-Identifier: Apache-2.0
// @ts-check
// libblob for browsers and workers: blob.wasm lies beside this module, where bundlers find it, too.
import { load } from "./blob.mjs";

export * from "./blob.mjs";

/** @type {Promise<import("./blob.mjs").Blob> | undefined} */
let library;

/** The library, compiled once for each page or worker. Rejects if blob.wasm cannot be fetched.
 * @param {string | URL} [address] of blob.wasm, where it is not beside this module; only the first call counts
 * @returns {Promise<import("./blob.mjs").Blob>} */
export function loadBlob(address = new URL("./blob.wasm", import.meta.url)) {
  library ??= fetched(address).catch((error) => {
    library = undefined; // a later call tries again
    throw error;
  });
  return library;
}

/** @param {string | URL} address */
async function fetched(address) {
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`blob.wasm cannot be fetched: the server answers ${answer.status}`);
  return load(await answer.arrayBuffer());
}
