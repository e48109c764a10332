// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { drawingOf, isBeside, isSecondAt, kNoBeside, showsSecond, type Beside } from "./beside";
import { readView, takeView } from "./kept_view";
import { kInitial, type View } from "./model";
import type { Volume } from "../case/volume";

const volume = {} as Volume,
  view = (beside: Partial<Beside>, second: Volume | null = volume): View => ({
    ...kInitial,
    document: { ...kInitial.document, volume, second },
    slices: { ...kInitial.slices, beside: { ...kNoBeside, ...beside }, secondWindow: [1, 9] },
  });

describe("a second volume", () => {
  it("isBlendedWithItsShareOverTheWholeView", () => {
    expect(drawingOf({ mode: "blend", share: 0.3, warm: true })).toEqual({
      alpha: 0.3,
      from: -1,
      warm: true,
    });
  });
  it("isOpaqueAndGreyToTheRightOfALine", () => {
    expect(drawingOf({ mode: "split", share: 0.25, warm: true })).toEqual({
      alpha: 1,
      from: -0.5,
      warm: false,
    });
  });
  it("isAtThePointerOnItsSideOfTheLineAlone", () => {
    expect(isSecondAt(view({ mode: "split", share: 0.25 }), 0.3)).toBe(true);
    expect(isSecondAt(view({ mode: "split", share: 0.25 }), 0.2)).toBe(false);
    expect(isSecondAt(view({ mode: "blend", share: 0.25 }), 0.3)).toBe(false);
    expect(isSecondAt(view({ mode: "split", share: 0.25 }, null), 0.3)).toBe(false);
  });
  it("isNotShownWhenItIsOffOrMissing", () => {
    expect(showsSecond(view({ mode: "blend" }))).toBe(true);
    expect(showsSecond(view({ mode: "off" }))).toBe(false);
    expect(showsSecond(view({ mode: "blend" }, null))).toBe(false);
  });
  it("keepsHowItIsSeen", () => {
    const kept = readView(JSON.stringify(takeView(view({ mode: "split", share: 0.7 }))));
    expect(kept.beside).toEqual({ mode: "split", share: 0.7, warm: true });
    expect(kept.secondWindow).toEqual([1, 9]);
    expect(isBeside({ ...kNoBeside, share: 1.2 })).toBe(false);
    expect(() =>
      readView(JSON.stringify({ ...takeView(view({})), beside: { mode: "over", share: 1, warm: true } })),
    ).toThrow("beside");
    const before: Record<string, unknown> = { ...takeView(view({})) };
    delete before.beside; // of a page that knew one volume
    expect(readView(JSON.stringify(before)).beside).toEqual(kNoBeside);
  });
});
