// SPDX-License-Identifier: Apache-2.0
// @ts-check
// libblob's query by WebGPU: batches of points on a GPUDevice, by the shader query.wgsl. Typed by JSDoc.
// Units: mm, in the case's frame (LPS), as 32-bit floats. Distances are negative in the lumen.
import { Flags, NOWHERE, State } from "./blob.mjs";

const kGroup = 64, kMostGroups = 65535; // invocations of a workgroup; workgroups along one axis
// usages and modes of WebGPU's buffers, whose global names only browsers have
const kMapRead = 1, kCopySource = 4, kCopyTarget = 8, kUniform = 64, kStorage = 128, kRead = 1, kCompute = 4;
const kBindings = ["read-only-storage", "uniform", "read-only-storage", "storage", "storage", "storage", "storage"];

/** Vessels on a graphics processor. Call destroy() when done. */
export class GpuVessels {
  /** @param {any} device a GPUDevice
   * @param {string} shader text of query.wgsl
   * @param {Uint32Array} words of Blob.pack(); throws a RangeError where they exceed the device's largest binding */
  constructor(device, shader, words) {
    const most = device.limits.maxStorageBufferBindingSize;
    if (words.byteLength > most)
      throw new RangeError(`libblob: ${words.byteLength} bytes of vessels exceed the ${most} that the device binds`);
    this.device = device;
    /** Number of vessels. */
    this.count = words[3];
    this.buffer = device.createBuffer({ size: words.byteLength, usage: kStorage | kCopyTarget });
    device.queue.writeBuffer(this.buffer, 0, words);
    this.module = device.createShaderModule({ label: "libblob", code: shader });
    this.layout = device.createBindGroupLayout({
      entries: kBindings.map((type, binding) => ({ binding, visibility: kCompute, buffer: { type } })) });
    /** Compiled kernels by their names. @type {Map<string, any>} */
    this.pipelines = new Map();
    this.pipeline(0);
  }
  /** The kernel for flags, compiled when it is needed. @param {number} flags */
  pipeline(flags) {
    const entryPoint = flags & Flags.DISTANCE_EXACT ? "blob_query_exact_points" : "blob_query_points";
    let made = this.pipelines.get(entryPoint);
    if (made === undefined) {
      const { device, module } = this, layout = device.createPipelineLayout({ bindGroupLayouts: [this.layout] });
      made = device.createComputePipeline({ label: "libblob", layout, compute: { module, entryPoint } });
      this.pipelines.set(entryPoint, made);
    }
    return made;
  }
  /** Room for `count` points, at least one, and their answers, to be kept and used in every step. @param {number} count */
  batch(count) { return new GpuBatch(this, count); }
  destroy() { this.buffer.destroy(); }
}

/** Points, their cursors and answers. Call free() when done. */
export class GpuBatch {
  /** @param {GpuVessels} vessels @param {number} count */
  constructor(vessels, count) {
    this.vessels = vessels;
    this.count = count;
    /** x y z of each point, mm: write here. */
    this.points = new Float32Array(3 * count);
    /** Node of each point; follows it. */
    this.cursors = new Uint32Array(count).fill(NOWHERE);
    /** Distance, mm, and outward normal of each point. */
    this.answers = new Float32Array(4 * count);
    /** f, mm, and its gradient at each point. */
    this.values = new Float32Array(4 * count);
    this.states = new Uint32Array(count);
    const { device } = vessels, make = (/** @type {number} */ size, /** @type {number} */ usage) => device.createBuffer({ size, usage });
    this.uniform = make(16, kUniform | kCopyTarget);
    this.pointBuffer = make(12 * count, kStorage | kCopyTarget);
    /** Outputs of the shader: buffers of the device, with the array that each is read into. */
    this.outputs = [this.cursors, this.answers, this.values, this.states].map(array => (
      { array, buffer: make(array.byteLength, kStorage | kCopySource | kCopyTarget) }));
    this.copy = make(this.outputs.reduce((sum, o) => sum + o.array.byteLength, 0), kMapRead | kCopyTarget);
    const buffers = [vessels.buffer, this.uniform, this.pointBuffer, ...this.outputs.map(o => o.buffer)];
    this.group = device.createBindGroup({ layout: vessels.layout,
      entries: buffers.map((buffer, binding) => ({ binding, resource: { buffer } })) });
  }
  /** Sends points and cursors, and starts the shader; the answers stay in the device's buffers. The vessel is its index in
   * the buffer; throws a RangeError for none. @param {number} [flags] LOCAL, HOLD and DISTANCE_EXACT of Flags @param {number} [vessel] */
  dispatch(flags = 0, vessel = 0) {
    const { count } = this.vessels;
    if (!(vessel >= 0 && vessel < count)) throw new RangeError(`libblob: found vessel ${vessel}, expected less than ${count}`);
    const { device } = this.vessels, groups = Math.ceil(this.count / kGroup), along = Math.min(groups, kMostGroups);
    device.queue.writeBuffer(this.uniform, 0, new Uint32Array([vessel, flags, this.count, along]));
    device.queue.writeBuffer(this.pointBuffer, 0, this.points);
    device.queue.writeBuffer(this.outputs[0].buffer, 0, this.cursors);
    const encoder = device.createCommandEncoder(), pass = encoder.beginComputePass();
    pass.setPipeline(this.vessels.pipeline(flags));
    pass.setBindGroup(0, this.group);
    pass.dispatchWorkgroups(along, Math.ceil(groups / along));
    pass.end();
    device.queue.submit([encoder.finish()]);
  }
  /** Asks for all points and reads the answers; rejects as dispatch() throws, and where the device is lost. One query of a
   * batch runs at a time.
   * @param {number} [flags] LOCAL, HOLD and DISTANCE_EXACT of Flags @param {number} [vessel] its index in the buffer */
  async query(flags = 0, vessel = 0) {
    this.dispatch(flags, vessel);
    const { device } = this.vessels, encoder = device.createCommandEncoder();
    let at = 0;
    for (const { array, buffer } of this.outputs) {
      encoder.copyBufferToBuffer(buffer, 0, this.copy, at, array.byteLength);
      at += array.byteLength;
    }
    device.queue.submit([encoder.finish()]);
    await this.copy.mapAsync(kRead);
    const bytes = new Uint8Array(this.copy.getMappedRange());
    at = 0;
    for (const { array } of this.outputs) {
      new Uint8Array(array.buffer).set(bytes.subarray(at, at + array.byteLength));
      at += array.byteLength;
    }
    this.copy.unmap();
  }
  /** The answer for point i. @param {number} i */
  sample(i) {
    const { answers: a, values: v } = this, state = this.states[i];
    return { value: v[4 * i], gradient: v.slice(4 * i + 1, 4 * i + 4), distance: a[4 * i], normal: a.slice(4 * i + 1, 4 * i + 4),
      node: this.cursors[i], state, inside: (state & State.INSIDE) !== 0 };
  }
  /** Signed distances of all points, mm. @returns {Float32Array} */
  distances() { return Float32Array.from({ length: this.count }, (_, i) => this.answers[4 * i]); }
  free() { for (const buffer of [this.uniform, this.pointBuffer, this.copy, ...this.outputs.map(o => o.buffer)]) buffer.destroy(); }
}
