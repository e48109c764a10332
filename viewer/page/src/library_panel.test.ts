// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { found } from "./library_panel";

const cases = ["head/Left ICA.lumen", "head/right ica.lumen", "aorta.lumen"].map(name => ({
  name,
  branches: 1,
  length: 2,
  error: null,
}));

describe("found", () => {
  it("givesAllForNothing", () => {
    expect(found(cases, " ").map(([index]) => index)).toEqual([0, 1, 2]);
  });
  it("wantsEveryWordInAnyCaseAndKeepsPlaces", () => {
    expect(found(cases, "ICA right").map(([index]) => index)).toEqual([1]);
    expect(found(cases, "ica aorta")).toEqual([]);
  });
});
