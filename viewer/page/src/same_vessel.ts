// SPDX-License-Identifier: Apache-2.0
import type { View } from "./model";
import type { Tree } from "./tree";

/** The selected vessel and the cursor in another tree: by its name, or by where it begins if it was renamed. */
export function sameVessel(before: Pick<View, "tree" | "selected" | "node">, tree: Tree | null): { selected: number; node: number } {
  const old = before.tree?.branches[before.selected], none = { selected: -1, node: -1 };
  if (old === undefined || tree === null || before.tree === null) return none;
  const begin = before.tree.position(old.firstNode).join();
  const found = tree.branches.find(b => b.label === old.label) ?? tree.branches.find(b => tree.position(b.firstNode).join() === begin);
  if (found === undefined) return none;
  return { selected: found.index, node: before.node < 0 ? -1 : tree.nearest(before.tree.position(before.node), b => b === found.index) };
}
