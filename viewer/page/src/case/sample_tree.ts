// SPDX-License-Identifier: Apache-2.0
/** A tree for tests. */
import { makePack, Pack } from "./pack";
import { Tree } from "./tree";

/** A trunk of 11 nodes along z, a child of 5 leaving node 5 along x, and a vessel of its own beside the trunk's end. */
export function sampleTree(): Tree {
  const centre: number[] = [],
    parent: number[] = [],
    branch: number[] = [],
    radius: number[] = [],
    distance: number[] = [];
  const node = (p: number[], up: number, b: number, r: number, d: number): void => {
    centre.push(...p);
    parent.push(up);
    branch.push(b);
    radius.push(r);
    distance.push(d);
  };
  for (let i = 0; i <= 10; ++i) node([0, 0, i], i - 1, 0, 1, i);
  for (let i = 1; i <= 5; ++i) node([i, 0, 5], i === 1 ? 5 : 9 + i, 1, 0.5, 5 + i);
  for (let i = 0; i < 4; ++i) node([0, 1.75, 8 + i], i === 0 ? -1 : 15 + i, 2, 0.5, i);
  const n = radius.length,
    f32 = (shape: number[], data: number[]) => ({
      type: "f32" as const,
      shape,
      data: new Float32Array(data),
    });
  const record = (label: string, parentNode: number, firstNode: number, nodeCount: number) => ({
    label,
    kind: "vessel",
    parent_node: parentNode,
    first_node: firstNode,
    node_count: nodeCount,
    stop_reason: "unknown",
    confidence: null,
    length_mm: nodeCount - 1,
  });
  return new Tree(
    new Pack(
      makePack(
        {
          branches: [
            record("trunk", -1, 0, 11),
            record("child", 5, 11, 5),
            record("<b>alone</b>", -1, 16, 4),
          ],
          voxel_size_mm: 1,
          has_models: false,
          reachable: null,
        },
        {
          centre: f32([n, 3], centre),
          direction: f32([n, 3], Array.from({ length: n }, () => [0, 0, 1]).flat()),
          radius_mm: f32([n], radius),
          height_mm: f32([n], radius),
          parent: { type: "i32", shape: [n], data: new Int32Array(parent) },
          branch: { type: "u32", shape: [n], data: new Uint32Array(branch) },
          root_distance_mm: f32([n], distance),
        },
      ),
    ),
  );
}
