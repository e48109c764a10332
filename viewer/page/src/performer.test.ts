// SPDX-License-Identifier: Apache-2.0
import { beforeAll, expect, test } from "vitest";
import { kInitial, type View } from "./model";
import { Performer } from "./performer";
import type { Source } from "./source";
import { Store } from "./store";

beforeAll(() => {
  globalThis.window ??= globalThis as never;
});

/** A document that counts its revisions and reports them late. */
function slowDocument(store: Store<View>): { source: Source; asked: [string, number][] } {
  const asked: [string, number][] = [];
  let now = 7;
  const perform = (operation: { op: string }, revision: number): Promise<{ revision: number }> => {
    asked.push([operation.op, revision]);
    const answer = ++now;
    setTimeout(() => store.set({ state: { ...store.get().state, revision: answer } }), 20);
    return Promise.resolve({ revision: answer });
  };
  return { source: { perform } as unknown as Source, asked };
}

const storeAt = (revision: number): Store<View> =>
  new Store<View>({ ...kInitial, state: { ...kInitial.state, revision }, treeRevision: revision });

test("two undos at once are two undos, each of the state that the one before it left", async () => {
  const store = storeAt(7),
    { source, asked } = slowDocument(store),
    performer = new Performer(store, source);
  await Promise.all([performer.perform({ op: "undo" }), performer.perform({ op: "undo" })]);
  expect(asked).toEqual([
    ["undo", 7],
    ["undo", 8],
  ]);
});

test("an index is meant for the tree that was shown when it was named", async () => {
  const store = storeAt(7),
    { source, asked } = slowDocument(store),
    performer = new Performer(store, source);
  await Promise.all([performer.perform({ op: "undo" }), performer.perform({ op: "delete", branch: 1 })]);
  expect(asked).toEqual([
    ["undo", 7],
    ["delete", 7],
  ]);
});
