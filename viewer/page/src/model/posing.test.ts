// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { kInitial, type App, type View } from "./model";
import { goToTime, mayChange, playOrPause } from "./posing";
import { Store } from "../base/store";
import type { Tree } from "../case/tree";
import type { Operation } from "../base/types";

const kMotion = { begin: 0.1, end: 0.7, period: null, within: (time: number): number => time };

/** A case that moves, shown at a time of its motion. */
function movingApp(time: number | null): { app: App; told: string[] } {
  const store = new Store<View>({
      ...kInitial,
      document: { ...kInitial.document, tree: { motion: kMotion } as unknown as Tree },
      motion: { ...kInitial.motion, time },
    }),
    told: string[] = [];
  return { app: { store, inform: (text: string) => told.push(text) } as unknown as App, told };
}

const kChanges: Operation[] = [
  { op: "delete", branch: 1 },
  { op: "widen", node: 4, radius_mm: 1, reach_mm: 2 },
  { op: "push", node: 4 },
  { op: "node_delete", node: 4 },
  { op: "track", labels: null },
  { op: "accept", labels: ["a"] },
];

test.each(kChanges)("$op waits at rest until it is asked for again", operation => {
  const { app, told } = movingApp(0.3);
  expect(mayChange(app, operation)).toBe(false);
  expect(app.store.get().motion.time).toBe(null);
  expect(told).toEqual([expect.stringContaining("case at rest")]);
  expect(mayChange(app, operation)).toBe(true);
});

const kAnyTime: Operation[] = [{ op: "rename", branch: 1, label: "a" }, { op: "undo" }, { op: "check" }];

test.each(kAnyTime)("$op is done at any time", operation => {
  const { app } = movingApp(0.3);
  expect(mayChange(app, operation)).toBe(true);
  expect(app.store.get().motion.time).toBe(0.3);
});

test("a motion without a period plays from its begin, and again after its end", () => {
  const { app } = movingApp(null);
  expect(playOrPause(app)).toBe(true);
  expect(app.store.get().motion).toMatchObject({ time: 0.1, playing: true });
  playOrPause(app);
  goToTime(app, 0.7);
  expect(app.store.get().motion.playing).toBe(false);
  playOrPause(app);
  expect(app.store.get().motion).toMatchObject({ time: 0.1, playing: true });
});

test("a tool is put away where the case moves", () => {
  const { app } = movingApp(null);
  app.store.set({ tools: { tool: "move" } });
  goToTime(app, 0.2);
  expect(app.store.get().tools.tool).toBe("navigate");
});
