// SPDX-License-Identifier: Apache-2.0
// Types of lumen-vascular. Lengths are millimetres, positions LPS patient coordinates: +x left, +y posterior, +z superior.

/** usage: a call that cannot be meant; input: bytes that are damaged or not what they have to be; unsupported: legal, but not
 * read or written by lumen; failed: such as no vessel is found. */
export type FaultKind = "failed" | "usage" | "input" | "unsupported" | "memory" | "cancelled";

/** A failure, with one sentence for people as its message. */
export declare class LumenError extends Error {
  readonly kind: FaultKind;
}

/** Hears of long work. An exception of its functions ends the work, and the call rejects with it. */
export interface Listener {
  /** A stage begins, such as "find", "track" and "fit". */
  onStage?(name: string): void;
  /** The share of the stage that is done, from 0 to 1. */
  onProgress?(done: number): void;
  /** A warning, one line. */
  onWarning?(sentence: string): void;
  /** Ends the work, which is done in one piece, when a function of this listener aborts it. */
  signal?: AbortSignal;
}

export type OptionValue = string | number | boolean;
/** Options of `lumen convert`, by the names of its help without hyphens, or in camel case: {accuracy: 0.2, maxError: "0.1v"}. One
 * that may be given several times takes an array. */
export type Options = Record<string, OptionValue | readonly OptionValue[]>;

/** Bytes under the name of a file, whose ending names the format. */
export interface NamedBytes {
  name: string;
  bytes: Uint8Array | ArrayBuffer;
}

/** Voxel (i, j, k) lies at data[i + size[0] * (j + size[1] * k)], and its centre at affine * (i, j, k, 1), mm, LPS. (NIfTI's affine
 * is RAS: negate its first two rows.) */
export interface Voxels {
  data: Int16Array | Uint8Array | Uint16Array | Float32Array;
  /** Each at least 2. */
  size: readonly [number, number, number];
  /** Three rows of four numbers; columns 0 to 2 are orthogonal. */
  affine: readonly (readonly [number, number, number, number])[];
}

/** Bytes of a volume (.nii, .nii.gz, .nrrd, .mha), of a surface of vessels (.stl, .ply, .obj, .glb, .gltf, .vtp, .vtk), of a centerline
 * (.swc, .tre, .centerline.vtp, .mrk.json) or of a case (.lumen, .lumen.json); or voxels. */
export type Source = Uint8Array | ArrayBuffer | Voxels;

export interface Inputs extends Listener {
  /** Name of the file, whose ending names the format; of voxels: for messages. */
  name?: string;
  options?: Options;
  /** Clicks, for grey voxels: lumen's .json, 3D Slicer's .mrk.json or .fcsv. */
  seeds?: NamedBytes;
  /** A case of this volume, whose corrections are made again. */
  corrected?: NamedBytes;
  /** Volume of labels that name the vessels of a volume. */
  labelMap?: NamedBytes;
  /** Names of labels. */
  labelTable?: NamedBytes;
  /** Centerline of a surface. */
  centerline?: NamedBytes;
}

export interface Branch {
  name: string;
  /** Number of the branch that it leaves; null for a root. */
  parent: number | null;
}

/** Closed, one 2-manifold for each connected tree. */
export interface Surface {
  /** x y z of each vertex, mm, LPS. */
  positions: Float32Array;
  /** Unit, out of the lumen. */
  normals: Float32Array;
  /** Of the nearest place on the centerline, mm, for each vertex. */
  radii: Float32Array;
  /** Number of the branch there, for each vertex. */
  branches: Uint32Array;
  /** Three vertices of each triangle, counter-clockwise seen from outside. */
  triangles: Uint32Array;
  /** Number of the group of each triangle. */
  groups: Uint32Array;
  /** Such as "wall" and "outlet-ica". */
  groupNames: string[];
}

/** The tree of vessels, points on their walls, and models. Its memory goes with it. */
export declare class Case {
  readonly branches: Branch[];
  /** The bytes of a file: "lumen", "lumen.json"; of its surface: "glb", "gltf", "vtp", "obj", "stl", "ply"; of its tree: "swc", "tre",
   * "centerline.vtp", "mrk.json", "graphml", "am", "vmv". Throws LumenError. */
  encode(format: string, given?: Options & Listener): Uint8Array;
  /** Throws LumenError. */
  surface(given?: Options & Listener): Surface;
}

export interface OptionRow {
  name: string;
  group: string;
  /** "MM", "WORD" and others; empty for a flag. */
  value: string;
  default: string;
  help: string;
}

export declare class Engine {
  constructor(module: WebAssembly.Module);
  /** Finds, tracks, names and fits the vessels of a source. The work is done in this thread, in one piece: seconds to minutes,
   * which a page leaves to a worker. Rejects with LumenError. */
  caseOf(source: Source, inputs?: Inputs): Promise<Case>;
  /** The case in the bytes of a file, .lumen or .lumen.json, as it is. Rejects with LumenError. */
  openCase(bytes: Uint8Array | ArrayBuffer, name?: string): Promise<Case>;
  options(): Promise<OptionRow[]>;
  /** Of lumen, such as "0.2.0". */
  version(): Promise<string>;
}

/** The engine, compiled once. `file` is lumen.wasm where it is not beside the module; only the first call counts. */
export declare function loadEngine(file?: string | URL): Promise<Engine>;

/** Engine.caseOf() of the engine that is loaded. */
export declare function caseOf(source: Source, inputs?: Inputs): Promise<Case>;
