// SPDX-License-Identifier: Apache-2.0
export * from "./blob.mjs";
import type { Blob } from "./blob.mjs";

/**
 * The library, compiled once for each page, worker or thread.
 * @param place address (browsers, workers) or file (Node) of blob.wasm, where it is not beside the module; only the
 * first call counts
 */
export function loadBlob(place?: string | URL): Promise<Blob>;
