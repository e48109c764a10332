// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { sampleTree } from "../case/sample_tree";
import { isCursorShown } from "./selection";

describe("isCursorShown", () => {
  const tree = sampleTree(),
    at = tree.position(1);
  it("isTrueInTheLumenOfTheCursorsNode", () => {
    expect(isCursorShown({ posed: null, tree, node: 1, crosshair: at })).toBe(true);
  });
  it("isFalseBesideItAndWithoutACursor", () => {
    const beside: [number, number, number] = [at[0] + 1.1 * tree.radius[1], at[1], at[2]];
    expect(isCursorShown({ posed: null, tree, node: 1, crosshair: beside })).toBe(false);
    expect(isCursorShown({ posed: null, tree, node: -1, crosshair: at })).toBe(false);
    expect(isCursorShown({ posed: null, tree: null, node: 1, crosshair: at })).toBe(false);
  });
});
