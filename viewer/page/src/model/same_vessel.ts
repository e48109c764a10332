// SPDX-License-Identifier: Apache-2.0
/** The same vessel in another tree: the vessel of that name, or the one that begins where a renamed vessel began. */
import type { View } from "./model";
import type { Tree } from "../case/tree";

type Kept = Omit<View["selection"], "allOpacity" | "proposal" | "place">;

/** Old name of each vessel that has another name in the new tree, but begins at the same place. */
function renamed(old: Tree, tree: Tree): Map<string, string> {
  const begin = (t: Tree, b: number): string => t.position(t.branches[b].first_node).join();
  const had = new Set(old.branches.map(b => b.label)),
    has = new Set(tree.branches.map(b => b.label));
  const gone = new Map(old.branches.filter(b => !has.has(b.label)).map(b => [begin(old, b.index), b.label]));
  return new Map(
    tree.branches
      .filter(b => !had.has(b.label))
      .flatMap(b => {
        const name = gone.get(begin(tree, b.index));
        return name === undefined ? [] : [[name, b.label]];
      }),
  );
}

/** The numbers of names that are left, and for new names the next that are free, in the order of the list. */
function numbered(numbers: ReadonlyMap<string, number>, tree: Tree): Map<string, number> {
  const labels = tree.branches.map(b => b.label),
    all = new Map(
      labels.flatMap(x => {
        const n = numbers.get(x);
        return n === undefined ? [] : [[x, n]];
      }),
    );
  const taken = new Set(all.values());
  let next = 0;
  for (const label of labels) {
    if (all.has(label)) continue;
    while (taken.has(next)) ++next;
    taken.add(next);
    all.set(label, next);
  }
  return all;
}

/** Selection, cursor, looks and colours, in the tree that follows another. */
export function sameVessels(view: Pick<View, "document" | "selection">, tree: Tree | null): Kept {
  const {
      document: { tree: old },
      selection: before,
    } = view,
    { hidden, solo, opacity, colours, colourNumbers } = before,
    none = {
      selected: -1,
      chosen: new Set<string>(),
      node: -1,
      hidden,
      solo,
      opacity,
      colours,
      colourNumbers,
    };
  if (tree === null) return none;
  if (old === null) return { ...none, colourNumbers: numbered(colourNumbers, tree) };
  const names = renamed(old, tree),
    name = (label: string): string => names.get(label) ?? label;
  const byName = <T>(map: ReadonlyMap<string, T>): Map<string, T> =>
    new Map([...map].map(([label, value]) => [name(label), value]));
  const wanted = before.selected < 0 ? null : name(old.branches[before.selected].label),
    selected = wanted === null ? -1 : tree.branches.findIndex(b => b.label === wanted);
  const found = selected < 0 ? null : tree.branches[selected],
    was = old.branches[before.selected];
  // in a branch with as many nodes the node is the same one, wherever it is now
  const node =
    found === null || before.node < 0
      ? -1
      : found.node_count === was.node_count
        ? found.first_node + before.node - was.first_node
        : tree.nearest(old.position(before.node), b => b === selected);
  const alone = solo === null ? undefined : tree.branches.find(b => b.label === name(solo)); // one that is gone would leave nothing to see
  return {
    selected,
    chosen: new Set([...before.chosen].map(name).filter(label => tree.branches.some(b => b.label === label))),
    node,
    hidden: new Set([...hidden].map(name)),
    solo: alone?.label ?? null,
    opacity: byName(opacity),
    colours: byName(colours),
    colourNumbers: numbered(byName(colourNumbers), tree),
  };
}
