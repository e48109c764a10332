// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { sampleTree } from "./sample_tree";
import type { MissingVessel, State, WorkItem, WorkKind } from "../base/types";
import { countKinds, kWorkTitles, missingPlaces, remediesOf, requestOf } from "./work_items";

const item = (kind: WorkKind, missing: number | null = null): WorkItem => ({
  id: 0,
  kind,
  position: [1, 2, 3],
  node: 2,
  branch: 1,
  about: "",
  missing,
});
const vessel: MissingVessel = {
  position: [1, 2, 3],
  length_mm: 7,
  radius_mm: 0.5,
  clicks: {
    points: [
      [1, 2, 3],
      [2, 3, 4],
    ],
    radius_mm: 0.5,
  },
};
const state = (items: WorkItem[]): Pick<State, "check" | "work"> => ({
  check: { missing_vessels: [vessel] },
  work: { items, found: items.length, ignored: [] },
});

describe("countKinds", () => {
  it("countsInTheOrderOfTheListWithOneAndSeveral", () => {
    expect(countKinds([item("dark"), item("loose"), item("loose")])).toBe("2 loose pieces, 1 dark place");
    expect(countKinds([])).toBe("");
  });
});
describe("missingPlaces", () => {
  it("areThoseThatAreLeft", () => {
    expect(missingPlaces(state([item("missing", 0), item("dark")]))).toEqual([
      { item: 0, index: 0, place: vessel },
    ]);
    expect(missingPlaces(state([]))).toEqual([]);
    expect(missingPlaces({ check: { missing_vessels: [vessel] }, work: null })).toEqual([]);
  });
});
describe("remedies", () => {
  it("areSomeForEveryKind", () => {
    for (const kind of Object.keys(kWorkTitles) as WorkKind[])
      expect(remediesOf(item(kind, 0)).length).toBeGreaterThan(0);
  });
  it("trackOnlyWhereClicksAreKnown", () => {
    expect(remediesOf(item("early-end"))).toEqual([]);
    expect(requestOf("track", item("missing", 1), state([]), null)).toBeNull();
    expect(requestOf("track", item("missing", 0), state([]), null)).toEqual({
      op: "track_from",
      points: [
        { position: [1, 2, 3], radius_mm: 0.5 },
        { position: [2, 3, 4], radius_mm: null },
      ],
    });
  });
  it("cutAndDeleteWhatTheItemNames", () => {
    expect(requestOf("cut", item("dark"), state([]), null)).toEqual({ op: "cut", node: 2 });
    expect(requestOf("delete", item("thin"), state([]), null)).toEqual({ op: "delete", branch: 1 });
  });
  it("joinToAnotherTreeOnly", () => {
    const tree = sampleTree(),
      join = (branch: number): unknown => requestOf("join", { ...item("loose"), branch }, state([]), tree);
    expect(join(2)).toEqual({ op: "join", branch: 2, node: 8 }); // the trunk's node beside its first one
    expect(join(1)).toEqual({ op: "join", branch: 1, node: 16 }); // not the trunk, on which it hangs
    tree.branches[2].parent_node = 10;
    expect(join(2)).toBeNull();
  });
});
