// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { sampleTree } from "../case/sample_tree";
import { kInitial, type View } from "./model";
import { sameVessels } from "./same_vessel";

describe("sameVessels", () => {
  const before = sampleTree(),
    renamed = sampleTree(),
    where = (selection: Partial<View["selection"]>): View => ({
      ...kInitial,
      document: { ...kInitial.document, tree: before },
      selection: { ...kInitial.selection, ...sameVessels(kInitial, before), ...selection },
    });
  renamed.branches[1] = { ...renamed.branches[1], label: "other" };
  it("followsAVesselThatWasRenamed", () => {
    expect(
      sameVessels(where({ selected: 1, node: 13, hidden: new Set(["child"]), solo: "child" }), renamed),
    ).toMatchObject({ selected: 1, node: 13, hidden: new Set(["other"]), solo: "other" });
    expect(sameVessels(where({ chosen: new Set(["trunk", "child", "gone"]) }), renamed).chosen).toEqual(
      new Set(["trunk", "other"]),
    );
  });
  it("leavesEveryVesselItsColour", () => {
    expect([...where({}).selection.colourNumbers]).toEqual([
      ["trunk", 0],
      ["child", 1],
      ["<b>alone</b>", 2],
    ]);
    const more = sampleTree();
    more.branches[0] = { ...more.branches[0], label: "new", first_node: 1 }; // the trunk is gone, another vessel is before the rest
    expect([...sameVessels(where({}), more).colourNumbers]).toEqual([
      ["child", 1],
      ["<b>alone</b>", 2],
      ["new", 0],
    ]);
  });
  it("showsTheRestWhenTheOneThatWasAloneIsGone", () => {
    const rest = sampleTree();
    rest.branches[1] = { ...rest.branches[1], label: "new", first_node: 12 };
    expect(sameVessels(where({ selected: 1, node: 13, solo: "child" }), rest)).toMatchObject({
      selected: -1,
      node: -1,
      solo: null,
    });
  });
  it("isNoneWithoutATree", () => {
    expect(sameVessels(where({ selected: 1, node: 13 }), null)).toMatchObject({
      selected: -1,
      node: -1,
    });
  });
});
