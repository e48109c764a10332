// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Store } from "./store";

describe("Store", () => {
  it("callsOnlyWatchersOfTheValueAndOfItsOwner", () => {
    const store = new Store({ one: { a: 1, b: 1 }, other: { c: 1 } }),
      seen: string[] = [];
    store.watch(["one.a"], v => seen.push(`a${v.one.a}`));
    store.watch(["one.b"], v => seen.push(`b${v.one.b}`));
    store.watch(["one"], v => seen.push(`one${v.one.a}`));
    store.watch(["other"], v => seen.push(`other${v.other.c}`));
    store.set({ one: { a: 2, b: 1 }, other: { c: 1 } });
    expect(seen).toEqual(["a1", "b1", "one1", "other1", "a2", "one2"]);
  });
  it("letsWatchersSetAndEnds", () => {
    const store = new Store({ one: { a: 0 }, other: { b: 0 } });
    store.watch(["one.a"], v => store.set({ other: { b: 2 * v.one.a } }));
    const stop = store.watch(["other.b"], () => undefined);
    store.set({ one: { a: 4 } });
    expect(store.get().other.b).toBe(8);
    stop();
  });
  it("throwsWhereWatchersNeverEnd", () => {
    const store = new Store({ one: { a: 0 } });
    store.watch(["one.a"], v => {
      if (v.one.a > 0) store.set({ one: { a: v.one.a + 1 } });
    });
    expect(() => store.set({ one: { a: 1 } })).toThrow(/without end/);
  });
});
