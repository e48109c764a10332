// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { fromBase64 } from "./source_embedded";

describe("fromBase64", () => {
  it("givesTheBytes", () => {
    expect(Array.from(fromBase64("AAEC/w=="))).toEqual([0, 1, 2, 255]);
  });
  it("passesOverWhiteSpace", () => {
    expect(Array.from(fromBase64("AAEC\n/w=="))).toEqual([0, 1, 2, 255]);
  });
});
