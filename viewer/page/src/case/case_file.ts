// SPDX-License-Identifier: Apache-2.0
/** Reads a .lumen file (../../../spec/lumen.md) as far as the page shows it: the tree and whether there are models. libblob,
 * which opens the same bytes, checks checksums and the models; here every size and index is checked before it is used. */
import { makePack } from "./pack";
import { kSystems } from "../base/colour";
import type { BranchRecord } from "../base/types";
import { edgeLengths, type Nodes } from "./vessel_length";

const kSignature = [0x8c, 0x4c, 0x55, 0x4d, 0x45, 0x4e, 0x0d, 0x0a, 0x1a, 0x0a],
  kHeader = 64, // bytes of the header, and of a chunk's row in the table
  kRecord = 24, // bytes of a branch
  kMajor = 1,
  kMostChunks = 4096,
  kKinds = ["vessel", "aneurysm"],
  kStops = [
    "unknown",
    "no-valid-cylinder",
    "turned-back",
    "left-volume",
    "met-branch",
    "end-of-seeds",
    "step-limit",
  ];

export const isCaseFile = (bytes: Uint8Array): boolean => kSignature.every((byte, i) => bytes[i] === byte);

/** The raw bytes of each chunk. Throws with a sentence for people. */
function chunksOf(bytes: Uint8Array): Map<string, Uint8Array> {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength),
    chunks = new Map<string, Uint8Array>();
  if (bytes.length < kHeader || !isCaseFile(bytes)) throw new Error("This is no .lumen file.");
  if (bytes[12] !== kMajor) throw new Error("The case needs a newer reader than this page.");
  const count = view.getUint32(24, true);
  let arrays = 0; // their chunks have one name
  if (count > kMostChunks || kHeader * (1 + count) > bytes.length) throw new Error("The case is cut off.");
  for (let i = 0; i < count; ++i) {
    const row = kHeader * (1 + i),
      name = String.fromCharCode(...bytes.subarray(row, row + 4)),
      offset = Number(view.getBigUint64(row + 8, true)),
      size = Number(view.getBigUint64(row + 16, true)),
      isCritical = (bytes[row + 6] & 1) !== 0;
    if (offset + size > bytes.length) throw new Error("The case is cut off.");
    if (bytes[row + 7] === 0)
      chunks.set(name === "NARR" ? `NARR${arrays++}` : name, bytes.subarray(offset, offset + size));
    else if (isCritical || name.startsWith("M"))
      throw new Error("The case is compressed: lumen convert CASE RAW.lumen makes one that a page reads.");
  }
  return chunks;
}

function needed(chunks: Map<string, Uint8Array>, name: string, size?: number): Uint8Array<ArrayBuffer> {
  const chunk = chunks.get(name);
  if (chunk === undefined || (size !== undefined && chunk.length !== size))
    throw new Error(`The case's chunk ${name} is missing or of a wrong size.`);
  return new Uint8Array(chunk); // a copy, whose first byte lies at a multiple of 8
}

function branchesOf(chunks: Map<string, Uint8Array>, nodes: number): BranchRecord[] {
  const records = needed(chunks, "BREC"),
    labels = needed(chunks, "BLAB"),
    view = new DataView(records.buffer),
    out: BranchRecord[] = [];
  for (let at = 0; at + kRecord <= records.length; at += kRecord) {
    const [firstNode, nodeCount] = [view.getUint32(at, true), view.getUint32(at + 4, true)],
      parentNode = view.getInt32(at + 8, true),
      label = view.getUint32(at + 12, true),
      confidence = view.getFloat32(at + 20, true);
    if (nodeCount === 0 || firstNode + nodeCount > nodes || parentNode >= nodes)
      throw new Error("A branch of the case names a node that does not exist.");
    out.push({
      label: new TextDecoder().decode(labels.subarray(label, label + view.getUint16(at + 16, true))),
      kind: kKinds[records[at + 18]] ?? "vessel",
      parent_node: parentNode,
      first_node: firstNode,
      node_count: nodeCount,
      stop_reason: kStops[records[at + 19]] ?? "unknown",
      confidence: confidence < 0 ? null : confidence,
      length_mm: 0,
    });
  }
  return out;
}

interface Metadata {
  voxelSize?: number;
  nodeArrays?: { name: string; type: string; components: number }[];
  steps?: { name: string; tool: string; parameters: Record<string, unknown> }[];
}

/** States the system of each branch: the one that most of its nodes have, as LUMEN_vessel.system states them. */
function addSystems(
  chunks: Map<string, Uint8Array>,
  meta: Metadata,
  nodes: number,
  branches: BranchRecord[],
): void {
  const at = meta.nodeArrays?.findIndex(array => array.name === "LUMEN_vessel.system") ?? -1;
  if (!chunks.has(`NARR${at}`)) return;
  const systems = new Uint32Array(needed(chunks, `NARR${at}`, 4 * nodes).buffer);
  for (const branch of branches) {
    const counts = kSystems.map(() => 0);
    for (const system of systems.subarray(branch.first_node, branch.first_node + branch.node_count))
      ++counts[system];
    branch.system = kSystems[counts.indexOf(Math.max(...counts))];
  }
}

/** mm along the tree from each node's root. Adds up the lengths of branches. Throws where a node's parent or branch does not exist. */
function measure(nodes: Nodes, branches: BranchRecord[]): Float32Array<ArrayBuffer> {
  const { parent, branch } = nodes,
    distance = new Float64Array(parent.length);
  for (let i = 0; i < parent.length; ++i)
    if (parent[i] >= i || branch[i] >= branches.length)
      throw new Error(`Node ${i} of the case names a parent or a branch that does not exist.`);
  const edge = edgeLengths(nodes, branches);
  for (let i = 0; i < parent.length; ++i) {
    branches[branch[i]].length_mm += edge[i];
    if (parent[i] >= 0) distance[i] = distance[parent[i]] + edge[i];
  }
  return new Float32Array(distance);
}

/** The pack "case" (../../README.md) of a file's bytes, without wall points. Throws with a sentence for people. */
export function packOfCase(bytes: Uint8Array): Uint8Array {
  const chunks = chunksOf(bytes),
    n = (chunks.get("NRAD")?.length ?? 0) / 4;
  if (n === 0 || !Number.isInteger(n)) throw new Error("The case has no node.");
  const meta = JSON.parse(new TextDecoder().decode(needed(chunks, "META"))) as Metadata,
    numbers = (name: string, columns: number): Float32Array<ArrayBuffer> =>
      new Float32Array(needed(chunks, name, 4 * n * columns).buffer),
    nodes = {
      centre: numbers("NCEN", 3),
      radius: numbers("NRAD", 1),
      parent: new Int32Array(needed(chunks, "NPAR", 4 * n).buffer),
      branch: new Uint32Array(needed(chunks, "NBRA", 4 * n).buffer),
    },
    branches = branchesOf(chunks, n),
    inlierRate = chunks.has("NINL") ? numbers("NINL", 1) : null,
    links = new Uint32Array(chunks.has("LINK") ? needed(chunks, "LINK").buffer : new ArrayBuffer(0));
  addSystems(chunks, meta, n, branches);
  if (links.some(node => node >= n)) throw new Error("A link of the case names a node that does not exist.");
  return makePack(
    {
      branches,
      voxel_size_mm: meta.voxelSize ?? null,
      has_models: chunks.has("MWID") && chunks.has("MKER"),
      reachable: null,
      steps: meta.steps ?? [],
    },
    {
      centre: { type: "f32", shape: [n, 3], data: nodes.centre },
      direction: { type: "f32", shape: [n, 3], data: numbers("NDIR", 3) },
      radius_mm: { type: "f32", shape: [n], data: nodes.radius },
      height_mm: { type: "f32", shape: [n], data: numbers("NHEI", 1) },
      parent: { type: "i32", shape: [n], data: nodes.parent },
      branch: { type: "u32", shape: [n], data: nodes.branch },
      ...(inlierRate === null ? {} : { inlier_rate: { type: "f32", shape: [n], data: inlierRate } }),
      root_distance_mm: { type: "f32", shape: [n], data: measure(nodes, branches) },
      links: { type: "u32", shape: [links.length / 2, 2], data: links },
    },
  );
}
