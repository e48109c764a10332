// SPDX-License-Identifier: Apache-2.0
// @ts-check
// libblob's query on a graphics processor: gpu.mjs with its shader.
import { GpuVessels } from "./gpu.mjs";
import { shader } from "./query_wgsl.mjs";

export * from "./gpu.mjs";
export { shader };

/** Models of one library as vessels 0, 1, ... on a device. Throws a RangeError where the device cannot bind so many bytes.
 * @param {any} device a GPUDevice
 * @param {import("./blob.mjs").Model[]} models at least one; they may be closed afterwards */
export function gpuVessels(device, models) {
  return new GpuVessels(device, shader, models[0].blob.pack(models));
}
