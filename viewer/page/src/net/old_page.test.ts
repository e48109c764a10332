// SPDX-License-Identifier: Apache-2.0
import { deflateSync } from "node:zlib";
import { expect, it } from "vitest";
import { makePack, Pack } from "../case/pack";
import { embeddedToday } from "./old_page";
import { EmbeddedSource, type Embedded } from "./source_embedded";

const kBranch = { label: "a", firstNode: 0, stopReason: "met-branch", length: 2.5 },
  kSteps = [{ name: "track", tool: "lumen", parameters: { radius: 1, maxRadius: 2 } }];
const old = (): Embedded => ({
  state: {
    title: "a",
    hasCase: true,
    time: 0.25,
    revisions: { case: 1, distance: 1 },
  } as unknown as Embedded["state"],
  parts: {
    case: base64(
      makePack(
        { branches: [kBranch], voxelSize: 0.5, steps: kSteps },
        { rootDistance: { type: "f32", shape: [3], data: new Float32Array([1, 2, 3]) } },
      ),
    ),
    "case.lumen": base64(new Uint8Array([7, 8])),
  },
});
const base64 = (bytes: Uint8Array): string => deflateSync(bytes).toString("base64");

it("givesAPageOfBeforeTheNamesOfToday", async () => {
  const source = new EmbeddedSource(embeddedToday(old()));
  expect(await source.state()).toMatchObject({
    title: "a",
    has_case: true,
    time_s: 0.25,
    revisions: { case: 1, distance: 1 },
  });
  const pack = new Pack((await source.bytes("case"))!);
  expect([...pack.get("root_distance_mm", "f32")]).toEqual([1, 2, 3]);
  expect(pack.meta).toMatchObject({
    branches: [{ label: "a", first_node: 0, stop_reason: "met-branch", length_mm: 2.5 }],
    voxel_size_mm: 0.5,
    steps: kSteps,
  });
  expect([...(await source.bytes("case.lumen"))!]).toEqual([7, 8]);
});

it("leavesAPageOfTodayAsItIs", () => {
  const today: Embedded = { state: { has_case: true }, parts: { case: "" } };
  expect(embeddedToday(today)).toBe(today);
});
