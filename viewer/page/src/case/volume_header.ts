// SPDX-License-Identifier: Apache-2.0
/** Headers of volumes in files: NIfTI-1 and NRRD with their voxels behind them. Others are unknown: null. */

/** Types of voxels, by their names in NRRD. */
const kArrays = {
  int8: Int8Array,
  uint8: Uint8Array,
  int16: Int16Array,
  uint16: Uint16Array,
  int32: Int32Array,
  uint32: Uint32Array,
  float: Float32Array,
  double: Float64Array,
};
export type VoxelType = keyof typeof kArrays;
export const arrayOf = (type: VoxelType): (typeof kArrays)[VoxelType] => kArrays[type];

export interface VolumeHeader {
  size: number[];
  type: VoxelType;
  isLittleEndian: boolean;
  /** Bytes before the voxels, of the file or, where `packing` is "all", of what is in it. */
  begin: number;
  packing: "none" | "voxels" | "all";
  /** The header of a part or a coarser copy, uncompressed: its size, the voxels of this one from voxel to voxel, and the place
   * of its first voxel among those of this one, voxels. */
  changed(size: number[], factor: number[], shift: number[]): Uint8Array;
}

const kNiftiTypes: Readonly<Record<number, VoxelType | undefined>> = {
  2: "uint8",
  4: "int16",
  8: "int32",
  16: "float",
  64: "double",
  256: "int8",
  512: "uint16",
  768: "uint32",
};

/** Columns of the matrix of NIfTI's quaternion, without the sizes of voxels. */
function rotation(view: DataView, little: boolean): number[][] {
  const [b, c, d] = [256, 260, 264].map(at => view.getFloat32(at, little)),
    a = Math.sqrt(Math.max(0, 1 - b * b - c * c - d * d)),
    q = view.getFloat32(76, little) < 0 ? -1 : 1;
  return [
    [a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)],
    [2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)],
    [2 * q * (b * d + a * c), 2 * q * (c * d - a * b), q * (a * a + d * d - b * b - c * c)],
  ];
}

function changedNifti(
  head: Uint8Array,
  little: boolean,
  size: number[],
  factor: number[],
  shift: number[],
): Uint8Array {
  const out = head.slice(),
    view = new DataView(out.buffer),
    get = (at: number): number => view.getFloat32(at, little),
    set = (at: number, value: number): void => view.setFloat32(at, value, little),
    columns = rotation(view, little);
  for (let r = 0; r < 3; ++r) {
    const move = [0, 1, 2].reduce((sum, a) => sum + columns[a][r] * get(80 + 4 * a) * shift[a], 0);
    set(268 + 4 * r, get(268 + 4 * r) + move);
    const row = 280 + 16 * r;
    set(row + 12, get(row + 12) + [0, 1, 2].reduce((sum, a) => sum + get(row + 4 * a) * shift[a], 0));
    for (let a = 0; a < 3; ++a) set(row + 4 * a, get(row + 4 * a) * factor[a]);
  }
  for (let a = 0; a < 3; ++a) {
    view.setInt16(42 + 2 * a, size[a], little);
    set(80 + 4 * a, get(80 + 4 * a) * factor[a]);
  }
  return out;
}

/** `head`: the first bytes, uncompressed. */
function niftiHeader(head: Uint8Array, packing: VolumeHeader["packing"]): VolumeHeader | null {
  const kSize = 348; // bytes, which the first number states
  if (head.length < kSize + 4) return null;
  const view = new DataView(head.buffer, head.byteOffset, head.byteLength),
    little = view.getInt32(0, true) === kSize;
  if (!little && view.getInt32(0, false) !== kSize) return null;
  const begin = view.getFloat32(108, little),
    type = kNiftiTypes[view.getInt16(70, little)],
    axes = view.getInt16(40, little),
    size = [42, 44, 46].map(at => view.getInt16(at, little));
  const isOne =
    axes === 3 || (axes > 3 && [48, 50, 52].every((at, i) => axes < 4 + i || view.getInt16(at, little) <= 1));
  if (type === undefined || !isOne || begin < kSize || begin > head.length || size.some(n => n < 1))
    return null;
  return {
    size,
    type,
    isLittleEndian: little,
    begin,
    packing,
    changed: (...how) => changedNifti(head.slice(0, begin), little, ...how),
  };
}

const kNrrdTypes: readonly [RegExp, VoxelType][] = [
  [/^(signed char|int8(_t)?)$/, "int8"],
  [/^(uchar|unsigned char|uint8(_t)?)$/, "uint8"],
  [/^(short|short int|signed short( int)?|int16(_t)?)$/, "int16"],
  [/^(ushort|unsigned short( int)?|uint16(_t)?)$/, "uint16"],
  [/^(int|signed int|int32(_t)?)$/, "int32"],
  [/^(uint|unsigned int|uint32(_t)?)$/, "uint32"],
  [/^float$/, "float"],
  [/^double$/, "double"],
];

const vectors = (text: string): number[][] =>
  [...text.matchAll(/\(([^)]*)\)/g)].map(found => found[1].split(",").map(Number));
const vectorText = (vector: number[]): string => `(${vector.join(",")})`;

function changedNrrd(
  fields: Map<string, string>,
  magic: string,
  size: number[],
  factor: number[],
  shift: number[],
): Uint8Array {
  const now = new Map(fields),
    directions = vectors(fields.get("space directions") ?? ""),
    origin = vectors(fields.get("space origin") ?? "")[0];
  now.set("sizes", size.join(" "));
  now.set("encoding", "raw");
  if (directions.length === 3)
    now.set("space directions", directions.map((v, a) => vectorText(v.map(x => x * factor[a]))).join(" "));
  if (directions.length === 3 && origin !== undefined)
    now.set(
      "space origin",
      vectorText(origin.map((x, r) => x + directions.reduce((sum, v, a) => sum + v[r] * shift[a], 0))),
    );
  const spacings = fields.get("spacings")?.split(/\s+/).map(Number);
  if (spacings !== undefined) now.set("spacings", spacings.map((s, a) => s * factor[a]).join(" "));
  const text = [...now].map(([name, value]) => `${name}: ${value}\n`).join("");
  return new TextEncoder().encode(`${magic}\n${text}\n`);
}

function nrrdHeader(head: Uint8Array): VolumeHeader | null {
  const text = new TextDecoder("latin1").decode(head),
    end = /\r?\n\r?\n/.exec(text);
  if (!text.startsWith("NRRD") || end === null) return null;
  const [magic, ...lines] = text.slice(0, end.index).split(/\r?\n/),
    fields = new Map(
      lines.flatMap((line): [string, string][] => {
        const found = /^([^#:]+):\s?(.*)$/.exec(line);
        return found === null ? [] : [[found[1], found[2].trim()]];
      }),
    );
  const type = kNrrdTypes.find(([name]) => name.test(fields.get("type") ?? ""))?.[1],
    size = (fields.get("sizes") ?? "").split(/\s+/).map(Number),
    encoding = fields.get("encoding") ?? "",
    isPacked = encoding === "gzip" || encoding === "gz";
  const isWhole = !["data file", "datafile", "line skip", "byte skip", "axis mins"].some(name =>
    fields.has(name),
  );
  if (type === undefined || size.length !== 3 || !size.every(n => n >= 1)) return null;
  if ((!isPacked && encoding !== "raw") || !isWhole) return null;
  return {
    size,
    type,
    isLittleEndian: fields.get("endian") !== "big",
    begin: end.index + end[0].length,
    packing: isPacked ? "voxels" : "none",
    changed: (...how) => changedNrrd(fields, magic, ...how),
  };
}

const kHead = 1 << 16; // bytes of a file that hold its header

/** The first bytes of a stream, which is not read on. */
async function firstBytes(stream: ReadableStream<Uint8Array>): Promise<Uint8Array> {
  const reader = stream.getReader(),
    out = new Uint8Array(kHead);
  let size = 0;
  while (size < kHead) {
    const { done, value } = await reader.read();
    if (done) break;
    const part = value.subarray(0, kHead - size);
    out.set(part, size);
    size += part.length;
  }
  await reader.cancel();
  return out.slice(0, size);
}

export const unpacked = (file: globalThis.Blob): ReadableStream<Uint8Array> =>
  file.stream().pipeThrough(new DecompressionStream("gzip") as ReadableWritablePair<Uint8Array, Uint8Array>);

/** Null for a file that is not known to be a volume, or is broken: the engine has the sentence on it. */
export async function readVolumeHeader(name: string, file: globalThis.Blob): Promise<VolumeHeader | null> {
  try {
    if (/\.nrrd$/i.test(name)) return nrrdHeader(await firstBytes(file.stream()));
    if (/\.nii$/i.test(name)) return niftiHeader(await firstBytes(file.stream()), "none");
    return /\.nii\.gz$/i.test(name) ? niftiHeader(await firstBytes(unpacked(file)), "all") : null;
  } catch {
    return null;
  }
}
