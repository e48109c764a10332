// SPDX-License-Identifier: Apache-2.0
/** Asks the document for changes, one after the other, each on the ground of what the user saw. */
import type { Store } from "../base/store";
import type { Source } from "../net/source";
import type { View } from "./model";
import type { Operation } from "../base/types";

const kLongest = 5000; // ms to wait for the state that an answer announced; without it the next request may be refused

/** Whether an operation names a node or a branch, by its index in the tree that was shown when it was asked for. */
export const namesTree = (operation: Operation): boolean => "branch" in operation || "node" in operation;

/** The revision whose indices an operation has; null: it has none, and is meant for the document as it will be. */
function seenRevision(
  operation: Operation,
  { document: { state, treeRevision } }: Pick<View, "document">,
): number | null {
  if (namesTree(operation)) return treeRevision;
  return "ignored" in operation ? state.revision : null;
}

export class Performer {
  private last: Promise<unknown> = Promise.resolve();

  constructor(
    private readonly store: Store<View>,
    private readonly source: Source,
  ) {}

  /** Done when the page has the state that followed; throws what the server refuses. */
  perform(operation: Operation): Promise<void> {
    const seen = seenRevision(operation, this.store.get()),
      before = this.last;
    const turn = (async (): Promise<void> => {
      await before.catch(() => undefined); // its caller gets the error
      const { revision } = await this.source.perform(
        operation,
        seen ?? this.store.get().document.state.revision,
      );
      if (revision !== undefined) await this.reached(revision);
    })();
    this.last = turn;
    return turn;
  }

  private reached(revision: number): Promise<void> {
    return new Promise(resolve => {
      let end: (() => void) | null = null;
      const done = (): void => {
        window.clearTimeout(timer);
        end?.();
        resolve();
      };
      const timer = window.setTimeout(done, kLongest);
      end = this.store.watch(["document.state"], ({ document: { state } }) => {
        if (state.revision >= revision) queueMicrotask(done);
      });
    });
  }
}
