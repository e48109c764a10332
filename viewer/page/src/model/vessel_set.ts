// SPDX-License-Identifier: Apache-2.0
/** Several vessels that are chosen together, by their labels: the set that a list shows and that is deleted at once. */
import type { Tree } from "../case/tree";
import type { Part } from "./model";

/** The set after a click with Ctrl (`toggle`) or Shift (`range`, from the label `anchor` on) on a label of a list. */
export function afterClick(
  chosen: ReadonlySet<string>,
  listed: readonly string[],
  label: string,
  anchor: string | null,
  how: "toggle" | "range",
): Set<string> {
  const from = anchor === null ? -1 : listed.indexOf(anchor),
    to = listed.indexOf(label);
  if (how === "range" && from >= 0) return new Set(listed.slice(Math.min(from, to), Math.max(from, to) + 1));
  const set = new Set(chosen.size === 0 && from >= 0 ? [listed[from]] : chosen); // the one that was selected alone
  if (!set.delete(label)) set.add(label);
  return set;
}

/** Labels of the vessels whose confidence is known and below a share. */
export const labelsBelow = (tree: Tree, share: number): string[] =>
  tree.branches.filter(b => b.confidence !== null && b.confidence < share).map(b => b.label);

/** Labels of all vessels of the tree that a branch belongs to. */
export function labelsOfTree(tree: Tree, branch: number): string[] {
  const rootOf = (b: number): number => {
    let at = b;
    while (tree.branches[at].parentBranch >= 0) at = tree.branches[at].parentBranch;
    return at;
  };
  const root = rootOf(branch);
  return tree.branches.filter(b => rootOf(b.index) === root).map(b => b.label);
}

export const chooseVessels = (app: Part<"selection">, labels: Iterable<string>): void =>
  app.store.set({ selection: { chosen: new Set(labels) } });

/** Deletes the set, or keeps it and deletes all others; what hangs on them stays. True if there was a set of several. */
export function deleteSet(app: Part<"document" | "selection", "perform">, others = false): boolean {
  const {
    document: { tree },
    selection: { chosen },
  } = app.store.get();
  if (chosen.size < 2 || tree === null) return false;
  const labels = tree.branches.map(b => b.label).filter(label => chosen.has(label) !== others);
  void app.perform({ op: "delete", labels }).then(isDone => {
    if (isDone) chooseVessels(app, []);
  });
  return true;
}

/** Hides the set, which "show all" shows again. True if there was a set of several. */
export function hideSet(app: Part<"selection">): boolean {
  const { chosen, hidden } = app.store.get().selection;
  if (chosen.size < 2) return false;
  app.store.set({ selection: { hidden: new Set([...hidden, ...chosen]), solo: null, chosen: new Set() } });
  return true;
}
