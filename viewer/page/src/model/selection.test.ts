// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Vec3 } from "../base/types";
import { sampleTree } from "../case/sample_tree";
import type { Tree } from "../case/tree";
import { kInitial, type View } from "./model";
import { isCursorShown } from "./selection";

describe("isCursorShown", () => {
  const tree = sampleTree(),
    at = tree.position(1);
  const view = (tree: Tree | null, node: number, crosshair: Vec3): View => ({
    ...kInitial,
    document: { ...kInitial.document, tree },
    selection: { ...kInitial.selection, node },
    slices: { ...kInitial.slices, crosshair },
  });
  it("isTrueInTheLumenOfTheCursorsNode", () => {
    expect(isCursorShown(view(tree, 1, at))).toBe(true);
  });
  it("isFalseBesideItAndWithoutACursor", () => {
    const beside: Vec3 = [at[0] + 1.1 * tree.radius[1], at[1], at[2]];
    expect(isCursorShown(view(tree, 1, beside))).toBe(false);
    expect(isCursorShown(view(tree, -1, at))).toBe(false);
    expect(isCursorShown(view(null, 1, at))).toBe(false);
  });
});
