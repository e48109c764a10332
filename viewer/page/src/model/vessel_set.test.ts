// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Tree } from "../case/tree";
import { afterClick, labelsBelow, labelsOfTree } from "./vessel_set";

const listed = ["a", "b", "c", "d"],
  none: ReadonlySet<string> = new Set();

/** Vessels a to d: b hangs on a, c on b, d alone. */
const tree = {
  branches: [
    { index: 0, label: "a", parentBranch: -1, confidence: 0.9 },
    { index: 1, label: "b", parentBranch: 0, confidence: 0.4 },
    { index: 2, label: "c", parentBranch: 1, confidence: null },
    { index: 3, label: "d", parentBranch: -1, confidence: 0.39 },
  ],
} as Tree;

describe("a set of vessels", () => {
  it("isAllFromTheSelectedOneToTheClickWithShift", () => {
    expect([...afterClick(none, listed, "d", "b", "range")]).toEqual(["b", "c", "d"]);
    expect([...afterClick(none, listed, "a", "c", "range")]).toEqual(["a", "b", "c"]);
  });
  it("gainsAndLosesOneWithControlBesideTheSelectedOne", () => {
    expect([...afterClick(none, listed, "d", "b", "toggle")]).toEqual(["b", "d"]);
    expect([...afterClick(new Set(["b", "d"]), listed, "b", "d", "toggle")]).toEqual(["d"]);
  });
  it("beginsWithTheClickWhereNoneIsListed", () => {
    expect([...afterClick(none, listed, "c", null, "range")]).toEqual(["c"]);
    expect([...afterClick(none, listed, "c", "gone", "toggle")]).toEqual(["c"]);
  });
  it("holdsKnownConfidencesBelowAShare", () => {
    expect(labelsBelow(tree, 0.4)).toEqual(["d"]);
    expect(labelsBelow(tree, 0.41)).toEqual(["b", "d"]);
  });
  it("isTheTreeOfAVessel", () => {
    expect(labelsOfTree(tree, 2)).toEqual(["a", "b", "c"]);
    expect(labelsOfTree(tree, 3)).toEqual(["d"]);
  });
});
