// SPDX-License-Identifier: Apache-2.0
/** The image volume: its voxels in memory, and where they are. The textures are made in volume_texture.ts. */
import type { Pack } from "./pack";
import type { Vec3 } from "../base/types";

interface Meta {
  size: number[];
  spacing_mm: number[];
  origin: number[];
  direction: number[];
  source_size: number[];
  reduction: number[];
  scale: number;
  offset: number;
  window: number[];
  name: string;
}

export class Volume {
  readonly meta: Meta;
  readonly size: Vec3;
  readonly spacing: Vec3;
  /** 1 or 2. */
  readonly bytesPerVoxel: number;
  readonly voxel: Uint8Array | Uint16Array;
  /** Byte of the pack at which voxels begin; `complete` counts those that have arrived. */
  readonly begin: number;
  /** Slices in memory. */
  complete = 0;

  constructor(pack: Pack) {
    this.meta = pack.meta as unknown as Meta;
    this.size = this.meta.size as Vec3;
    this.spacing = this.meta.spacing_mm as Vec3;
    const voxel = pack.any("voxel");
    if (!(voxel instanceof Uint8Array) && !(voxel instanceof Uint16Array))
      throw new Error("The volume's voxels are of an unknown type.");
    if (voxel.length !== this.size[0] * this.size[1] * this.size[2])
      throw new Error("The volume's size does not fit its voxels.");
    this.voxel = voxel;
    this.bytesPerVoxel = voxel.BYTES_PER_ELEMENT;
    this.begin = pack.begin("voxel");
  }

  /** Intensity of a stored number, and back. */
  intensity(stored: number): number {
    return this.meta.scale * stored + this.meta.offset;
  }
  stored(intensity: number): number {
    return (intensity - this.meta.offset) / this.meta.scale;
  }

  /** Continuous index of a position: 0 is the centre of the first voxel. */
  index(p: Vec3): Vec3 {
    const { origin: o, direction: d } = this.meta;
    return [0, 1, 2].map(
      a => ((p[0] - o[0]) * d[a] + (p[1] - o[1]) * d[3 + a] + (p[2] - o[2]) * d[6 + a]) / this.spacing[a],
    ) as Vec3;
  }
  position(i: Vec3): Vec3 {
    const { origin: o, direction: d } = this.meta,
      s = this.spacing;
    return [0, 1, 2].map(
      r => o[r] + d[3 * r] * i[0] * s[0] + d[3 * r + 1] * i[1] * s[1] + d[3 * r + 2] * i[2] * s[2],
    ) as Vec3;
  }
  centre(): Vec3 {
    return this.position(this.size.map(n => (n - 1) / 2) as Vec3);
  }
  corners(): Vec3[] {
    return Array.from({ length: 8 }, (_, k) =>
      this.position(this.size.map((n, a) => (((k >> a) & 1) === 1 ? n - 0.5 : -0.5)) as Vec3),
    );
  }
  /** 4x4 in columns, as WebGL wants it: from mm to texture coordinates, 0 to 1 over all voxels with their halves. */
  toTexture(): number[] {
    const { origin: o, direction: d } = this.meta,
      m = new Array<number>(16).fill(0);
    for (let a = 0; a < 3; ++a) {
      const f = 1 / (this.spacing[a] * this.size[a]);
      for (let r = 0; r < 3; ++r) m[4 * r + a] = d[3 * r + a] * f;
      m[12 + a] = 0.5 / this.size[a] - (o[0] * d[a] + o[1] * d[3 + a] + o[2] * d[6 + a]) * f;
    }
    m[15] = 1;
    return m;
  }

  /** Whether a position is in a voxel. */
  holds(p: Vec3): boolean {
    return this.index(p).every((x, a) => x >= -0.5 && x <= this.size[a] - 0.5);
  }

  /** Stored number of the voxel that holds a position; 0 outside, and where it has not arrived. */
  nearest(p: Vec3): number {
    if (!this.holds(p)) return 0;
    const [i, j, k] = this.index(p).map((x, a) => Math.min(Math.max(Math.round(x), 0), this.size[a] - 1));
    return this.voxel[i + this.size[0] * (j + this.size[1] * k)];
  }

  /** Intensity at a position, trilinear; NaN outside of the voxels' centres. */
  sample(p: Vec3): number {
    const [x, y, z] = this.index(p),
      [nx, ny, nz] = this.size,
      v = this.voxel;
    if (!(x >= 0 && y >= 0 && z >= 0 && x <= nx - 1 && y <= ny - 1 && z <= nz - 1)) return NaN;
    const i = Math.min(Math.floor(x), Math.max(nx - 2, 0)),
      j = Math.min(Math.floor(y), Math.max(ny - 2, 0));
    const k = Math.min(Math.floor(z), Math.max(nz - 2, 0)),
      a = x - i,
      b = y - j,
      c = z - k;
    const dx = nx > 1 ? 1 : 0,
      dy = ny > 1 ? nx : 0,
      dz = nz > 1 ? nx * ny : 0,
      o = i + nx * (j + ny * k);
    const row = (at: number): number => v[at] + a * (v[at + dx] - v[at]);
    const plane = (at: number): number => row(at) + b * (row(at + dy) - row(at));
    return this.intensity(plane(o) + c * (plane(o + dz) - plane(o)));
  }

  /** Counts of stored numbers over `bins` equal parts of their range, from at most a million voxels. */
  histogram(bins: number): { low: number; high: number; counts: Uint32Array } {
    const v = this.voxel,
      step = Math.max(1, Math.floor(v.length / 1e6));
    let low = Infinity,
      high = -Infinity;
    for (let i = 0; i < v.length; i += step) {
      low = Math.min(low, v[i]);
      high = Math.max(high, v[i]);
    }
    const counts = new Uint32Array(bins),
      f = bins / (high - low + 1);
    for (let i = 0; i < v.length; i += step) ++counts[Math.floor((v[i] - low) * f)];
    return { low: this.intensity(low), high: this.intensity(high), counts };
  }
}

export interface Reduced {
  size: Vec3;
  data: Uint8Array;
  low: number;
  high: number;
  blocks: { size: Vec3; data: Uint8Array };
}

export const kBlock = 8; // texels of an edge of a block whose greatest value is kept, to skip what is dark

/** The volume for ray casting: the greatest of each cell of voxels, no more than `most` texels along an axis, in 8 bits
 * between the intensities `low` and `high`; and the greatest of each block with its border, for skipping. */
export function reduce(volume: Volume, most: number, low: number, high: number): Reduced {
  const [nx, ny, nz] = volume.size,
    factor = volume.size.map(n => Math.max(1, Math.ceil(n / most)));
  const size = volume.size.map((n, a) => Math.ceil(n / factor[a])) as Vec3;
  const peak = new Float32Array(size[0] * size[1] * size[2]).fill(-Infinity),
    v = volume.voxel;
  for (let k = 0, at = 0; k < nz; ++k)
    for (let j = 0; j < ny; ++j) {
      const row = size[0] * (Math.floor(j / factor[1]) + size[1] * Math.floor(k / factor[2])),
        f = factor[0];
      for (let i = 0; i < nx; ++i, ++at) {
        const to = row + (f === 1 ? i : Math.floor(i / f));
        if (v[at] > peak[to]) peak[to] = v[at];
      }
    }
  const a = volume.stored(low),
    s = 255 / Math.max(volume.stored(high) - a, 1e-9);
  const data = Uint8Array.from(peak, x => Math.min(255, Math.max(0, Math.round((x - a) * s))));
  return { size, data, low, high, blocks: blocksOf(size, data) };
}

function blocksOf(size: Vec3, data: Uint8Array): { size: Vec3; data: Uint8Array } {
  const count = size.map(n => Math.ceil(n / kBlock)) as Vec3,
    peaks = new Uint8Array(count[0] * count[1] * count[2]);
  const reach = (i: number, n: number): [number, number] => [
    // blocks that a texel is read in, as itself or a neighbour
    Math.floor(Math.max(i - 1, 0) / kBlock),
    Math.floor(Math.min(i + 1, n - 1) / kBlock),
  ];
  for (let k = 0, at = 0; k < size[2]; ++k) {
    const [k0, k1] = reach(k, size[2]);
    for (let j = 0; j < size[1]; ++j) {
      const [j0, j1] = reach(j, size[1]);
      for (let i = 0; i < size[0]; ++i, ++at) {
        const x = data[at];
        if (x === 0) continue;
        const [i0, i1] = reach(i, size[0]);
        for (let c = k0; c <= k1; ++c)
          for (let b = j0; b <= j1; ++b)
            for (let a = i0; a <= i1; ++a) {
              const to = a + count[0] * (b + count[1] * c);
              if (x > peaks[to]) peaks[to] = x;
            }
      }
    }
  }
  return { size: count, data: peaks };
}
