// SPDX-License-Identifier: Apache-2.0
/** The container in which numbers travel: see "Packs" in ../../README.md. */

const kTypes = { f32: Float32Array, u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, i32: Int32Array };
type TypeName = keyof typeof kTypes;
type ArrayOf = { [K in TypeName]: InstanceType<(typeof kTypes)[K]> };
type AnyArray = ArrayOf[TypeName];

interface Place {
  type: TypeName;
  shape: number[];
  offset: number;
  /** Coded arrays only, as in the page as one file. */
  coding?: "differences" | "back";
  stored?: "u16" | "u32";
  low?: number[];
  step?: number[];
}

const kMostHeader = 64 << 20; // bytes of JSON; more is no pack

/** A number at 4 little-endian bytes gives the length of the JSON; throws if that is none. */
export function headerEnd(bytes: Uint8Array): number {
  if (bytes.length < 4) throw new Error("The pack is cut off before its header.");
  const size = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
  if (size > kMostHeader || (4 + size) % 8 !== 0)
    throw new Error(`The pack's header has ${size} bytes, which cannot be.`);
  return 4 + size;
}

/** The values of a coded array: see "Packs" in ../../README.md. */
function decoded(place: Place, bytes: Uint8Array): AnyArray {
  const rows = place.shape[0],
    columns = place.shape[1] ?? 1,
    size = place.stored === "u16" ? 2 : 4;
  const values = new Uint32Array(rows * columns);
  for (let c = 0, at = 0; c < columns; ++c)
    for (let k = 0; k < size; ++k)
      for (let i = c; i < values.length; i += columns) values[i] |= bytes[at++] << (8 * k);
  if (place.coding === "back")
    for (let i = 0, next = 0; i < values.length; ++i) {
      values[i] = next - values[i]; // modulo 2^32
      next = Math.max(next, values[i] + 1);
    }
  else
    for (let i = columns, mask = size === 2 ? 0xffff : 0xffffffff; i < values.length; ++i)
      values[i] = (values[i] + values[i - columns]) & mask;
  const { low, step } = place;
  return low === undefined || step === undefined
    ? values
    : Float32Array.from(values, (v, i) => low[i % columns] + step[i % columns] * v);
}

/** Arrays by name, as views of one buffer, and the other members of the JSON. */
export class Pack {
  readonly meta: Record<string, unknown>;
  readonly base: number;
  private readonly places: Record<string, Place>;
  private readonly decoded = new Map<string, AnyArray>();

  /** The arrays may still be being received: only the header is read. Throws where it is not a pack. */
  constructor(readonly bytes: Uint8Array) {
    this.base = headerEnd(bytes);
    if (bytes.length < this.base) throw new Error("The pack is cut off in its header.");
    const text = new TextDecoder().decode(bytes.subarray(4, this.base));
    this.meta = JSON.parse(text) as Record<string, unknown>;
    this.places = (this.meta.arrays ?? {}) as Record<string, Place>;
  }

  has(name: string): boolean {
    return Object.hasOwn(this.places, name);
  }
  shape(name: string): number[] {
    return this.place(name).shape;
  }
  type(name: string): TypeName {
    return this.place(name).type;
  }
  /** Byte of the pack at which an array begins. */
  begin(name: string): number {
    return this.base + this.place(name).offset;
  }

  private place(name: string): Place {
    const place = this.has(name) ? this.places[name] : undefined;
    if (place === undefined || !Object.hasOwn(kTypes, place.type))
      throw new Error(`The pack has no array "${name}".`);
    return place;
  }

  /** A view of an array of that type; throws if it has another type or lies outside of the bytes. */
  get<T extends TypeName>(name: string, type: T): ArrayOf[T] {
    const place = this.place(name);
    if (place.type !== type)
      throw new Error(`The pack's "${name}" is of type ${place.type}, expected ${type}.`);
    return this.any(name) as ArrayOf[T];
  }

  any(name: string): AnyArray {
    const place = this.place(name),
      Type = kTypes[place.stored ?? place.type];
    const count = place.shape.reduce((a, b) => a * b, 1),
      at = this.base + place.offset;
    if (
      !Number.isSafeInteger(count) ||
      place.offset % 8 !== 0 ||
      at + count * Type.BYTES_PER_ELEMENT > this.bytes.length
    )
      throw new Error(`The pack's "${name}" of ${place.shape.join(" x ")} ends beyond the pack.`);
    if (place.coding === undefined)
      return new Type(this.bytes.buffer as ArrayBuffer, this.bytes.byteOffset + at, count);
    let values = this.decoded.get(name);
    if (values === undefined) this.decoded.set(name, (values = decoded(place, this.bytes.subarray(at))));
    return values;
  }

  /** Null where there is no such array. */
  optional<T extends TypeName>(name: string, type: T): ArrayOf[T] | null {
    return this.has(name) ? this.get(name, type) : null;
  }
}

/** The bytes of a pack: what writes fixtures of tests. */
export function makePack(
  meta: Record<string, unknown>,
  arrays: Record<string, { type: TypeName; shape: number[]; data: AnyArray }>,
): Uint8Array {
  const places: Record<string, Place> = {};
  let size = 0;
  for (const [name, { type, shape, data }] of Object.entries(arrays)) {
    places[name] = { type, shape, offset: size };
    size = Math.ceil((size + data.byteLength) / 8) * 8;
  }
  let text = new TextEncoder().encode(JSON.stringify({ ...meta, arrays: places }));
  const padded = new Uint8Array(Math.ceil((text.length + 4) / 8) * 8 - 4).fill(32);
  padded.set(text);
  text = padded;
  const bytes = new Uint8Array(4 + text.length + size);
  new DataView(bytes.buffer).setUint32(0, text.length, true);
  bytes.set(text, 4);
  for (const [name, { data }] of Object.entries(arrays))
    bytes.set(
      new Uint8Array(data.buffer, data.byteOffset, data.byteLength),
      4 + text.length + places[name].offset,
    );
  return bytes;
}
