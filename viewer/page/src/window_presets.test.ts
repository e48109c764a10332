// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { kPresets, presetOf, windowOf } from "./window_presets";

describe("windowOf", () => {
  it("spansTheWidthAboutTheCentre", () => {
    expect(windowOf("brain")).toEqual([0, 80]);
    expect(windowOf("lung")).toEqual([-1350, 150]);
    expect(windowOf("other")).toBe(null);
  });
  it("isFoundAgainByItsNumbers", () => {
    for (const { name } of kPresets) expect(presetOf(windowOf(name)!)).toBe(name);
    expect(presetOf([0, 81])).toBe("");
  });
});
