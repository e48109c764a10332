// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Store } from "./store";

describe("Store", () => {
  it("callsOnlyWatchersOfTheKey", () => {
    const store = new Store({ a: 1, b: 1 }),
      seen: string[] = [];
    store.watch(["a"], v => seen.push(`a${v.a}`));
    store.watch(["b"], v => seen.push(`b${v.b}`));
    store.set({ a: 2, b: 1 });
    expect(seen).toEqual(["a1", "b1", "a2"]);
  });
  it("letsWatchersSetAndEnds", () => {
    const store = new Store({ a: 0, b: 0 });
    store.watch(["a"], v => store.set({ b: 2 * v.a }));
    const stop = store.watch(["b"], () => undefined);
    store.set({ a: 4 });
    expect(store.get().b).toBe(8);
    stop();
  });
  it("throwsWhereWatchersNeverEnd", () => {
    const store = new Store({ a: 0 });
    store.watch(["a"], v => {
      if (v.a > 0) store.set({ a: v.a + 1 });
    });
    expect(() => store.set({ a: 1 })).toThrow(/without end/);
  });
});
