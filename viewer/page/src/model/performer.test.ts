// SPDX-License-Identifier: Apache-2.0
import { beforeAll, expect, test } from "vitest";
import { kInitial, type View } from "./model";
import { Performer } from "./performer";
import type { Source } from "../net/source";
import { Store } from "../base/store";
import type { Operation } from "../base/types";

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
    setTimeout(
      () => store.set({ document: { state: { ...store.get().document.state, revision: answer } } }),
      20,
    );
    return Promise.resolve({ revision: answer });
  };
  return { source: { perform } as unknown as Source, asked };
}

const storeAt = (revision: number): Store<View> =>
  new Store<View>({
    ...kInitial,
    document: {
      ...kInitial.document,
      state: { ...kInitial.document.state, revision },
      treeRevision: revision,
    },
  });

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

const kNamed: Operation[] = [
  { op: "delete", branch: 1 },
  { op: "join", branch: 1, node: 4 },
  { op: "move", node: 4, position: [0, 0, 0], radius_mm: 1 },
  { op: "widen", node: 4, radius_mm: 1, reach_mm: 2 },
  { op: "push", node: 4, at: [0, 0, 0], by: [1, 0, 0], radius_mm: 1 },
  { op: "node_add", node: 4 },
  { op: "node_delete", node: 4 },
  { op: "unignore", ignored: 1 },
];

test.each(kNamed)("an index of $op is meant for what was shown when it was named", async operation => {
  const store = storeAt(7),
    { source, asked } = slowDocument(store),
    performer = new Performer(store, source);
  await Promise.all([performer.perform({ op: "undo" }), performer.perform(operation)]);
  expect(asked).toEqual([
    ["undo", 7],
    [operation.op, 7],
  ]);
});
