// SPDX-License-Identifier: Apache-2.0
/** Smaller copies of a volume that is too large for the memory at hand, made as its file is read: never more of it is in memory
 * than two slices and the copy. */
import { arrayOf, unpacked, type VolumeHeader } from "./volume_header";

/** Parts of one length, after `skip` bytes. The last may be missing where the file breaks off. */
async function* parts(
  stream: ReadableStream<Uint8Array>,
  skip: number,
  length: number,
): AsyncGenerator<Uint8Array> {
  const reader = stream.getReader();
  let part = new Uint8Array(length),
    filled = -skip;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    for (let at = 0; at < value.length; ) {
      if (filled < 0) {
        const passed = Math.min(-filled, value.length - at);
        filled += passed;
        at += passed;
        continue;
      }
      const taken = value.subarray(at, at + length - filled);
      part.set(taken, filled);
      filled += taken.length;
      at += taken.length;
      if (filled < length) continue;
      yield part;
      part = new Uint8Array(length);
      filled = 0;
    }
  }
}

function slices(file: globalThis.Blob, header: VolumeHeader): AsyncGenerator<Uint8Array> {
  const { size, begin, packing } = header,
    length = size[0] * size[1] * arrayOf(header.type).BYTES_PER_ELEMENT;
  if (packing === "all") return parts(unpacked(file), begin, length);
  const voxels = file.slice(begin);
  return parts(packing === "voxels" ? unpacked(voxels) : voxels.stream(), 0, length);
}

/** Between the order of bytes of the header and that of this machine, which is little-endian. */
function turn(bytes: Uint8Array, { type, isLittleEndian }: VolumeHeader): void {
  const width = arrayOf(type).BYTES_PER_ELEMENT;
  if (!isLittleEndian)
    for (let at = 0; at < bytes.length; at += width) bytes.subarray(at, at + width).reverse();
}

/** The voxels of a slice as numbers. */
function numbers(bytes: Uint8Array, header: VolumeHeader): ArrayLike<number> {
  turn(bytes, header);
  return new (arrayOf(header.type))(bytes.buffer as ArrayBuffer);
}

/** The voxels in the order of bytes that the header states. */
function inOrder(array: { buffer: ArrayBufferLike }, header: VolumeHeader): BlobPart {
  const bytes = new Uint8Array(array.buffer as ArrayBuffer);
  turn(bytes, header);
  return bytes as BlobPart;
}

/** Adds each voxel of a slice to that of the coarser one that it lies in. */
function addHalved(sums: Float64Array, slice: ArrayLike<number>, nx: number, [hx, hy]: number[]): void {
  for (let j = 0; j < 2 * hy; ++j)
    for (let i = 0; i < 2 * hx; ++i) sums[(j >> 1) * hx + (i >> 1)] += slice[j * nx + i];
}

/** Voxels of twice the edges, each the mean of eight; of an odd number the last are left out. Every axis has two voxels or
 * more. Throws where the file breaks off. */
export async function halved(file: globalThis.Blob, header: VolumeHeader): Promise<globalThis.Blob> {
  const half = header.size.map(n => n >> 1),
    Kind = arrayOf(header.type),
    isWhole = header.type !== "float" && header.type !== "double",
    sums = new Float64Array(half[0] * half[1]),
    made: BlobPart[] = [];
  let k = 0;
  for await (const bytes of slices(file, header)) {
    addHalved(sums, numbers(bytes, header), header.size[0], half);
    if (++k % 2 === 1) continue;
    made.push(inOrder(new Kind(sums.map(sum => (isWhole ? Math.round(sum / 8) : sum / 8))), header));
    sums.fill(0);
    if (made.length === half[2]) break;
  }
  if (made.length < half[2]) throw new Error("the file breaks off");
  return new globalThis.Blob([header.changed(half, [2, 2, 2], [0.5, 0.5, 0.5]) as BlobPart, ...made]);
}

/** Slices from `first` to `last`, both included, from 0. Throws where the file breaks off. */
export async function cropped(
  file: globalThis.Blob,
  header: VolumeHeader,
  first: number,
  last: number,
): Promise<globalThis.Blob> {
  const made: BlobPart[] = [];
  let k = -1;
  for await (const bytes of slices(file, header)) {
    if (++k >= first) made.push(bytes as BlobPart);
    if (k === last) break;
  }
  if (k < last) throw new Error("the file breaks off");
  const size = [header.size[0], header.size[1], last - first + 1];
  return new globalThis.Blob([header.changed(size, [1, 1, 1], [0, 0, first]) as BlobPart, ...made]);
}
