// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { measurementsCsv, readView, takeView } from "./kept_view";
import { kInitial, type Measurement, type View } from "./model";

const measured: Measurement = {
  id: 4,
  kind: "distance",
  points: [
    [1, 2, 3],
    [4, 5, 6],
  ],
  text: "5.2 mm",
  detail: 'a "b", c',
};
const view: View = {
  ...kInitial,
  selection: {
    ...kInitial.selection,
    hidden: new Set(["ica"]),
    colours: new Map([["aca", [1, 0, 0]]]),
    opacity: new Map([["mca", 0.5]]),
  },
  slices: { ...kInitial.slices, window: [10, 200], axes: "RAS" },
  tools: { ...kInitial.tools, measurements: [measured] },
};

describe("a view file", () => {
  it("holdsWhatTheViewShows", () => {
    const kept = readView(JSON.stringify(takeView(view)));
    expect(kept.window).toEqual([10, 200]);
    expect(kept.hidden).toEqual(["ica"]);
    expect(kept.colours).toEqual({ aca: "#ff0000" });
    expect(kept.opacity).toEqual({ mca: 0.5 });
    expect(kept.axes).toBe("RAS");
    expect(kept.measurements).toEqual([
      { kind: "distance", points: measured.points, text: measured.text, detail: measured.detail },
    ]);
  });
  it.each([
    ["{", "no JSON"],
    ['{"format": "other"}', "format"],
    [JSON.stringify({ ...takeView(view), version: 2 }), "version is 2"],
    [JSON.stringify({ ...takeView(view), window: [1] }), "window"],
    [JSON.stringify({ ...takeView(view), layout: "nine" }), "layout"],
    [JSON.stringify({ ...takeView(view), colours: { a: "red" } }), "colours"],
    [JSON.stringify({ ...takeView(view), hidden: [1] }), "hidden"],
    [JSON.stringify({ ...takeView(view), measurements: [{ kind: "distance" }] }), "measurements"],
  ])("isRefusedWithWhatIsWrong: %s", (text, named) => {
    expect(() => readView(text)).toThrow(named);
  });
});
describe("measurementsCsv", () => {
  it("hasARowForEachAndQuotesWhatNeedsIt", () => {
    expect(measurementsCsv([measured])).toBe(
      'number,kind,result,about,x_mm_lps,y_mm_lps,z_mm_lps\n1,distance,5.2 mm,"a ""b"", c",1.000,2.000,3.000\n',
    );
  });
});
