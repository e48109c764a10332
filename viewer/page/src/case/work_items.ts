// SPDX-License-Identifier: Apache-2.0
/** Places that the check leaves to a person: their words, and the requests that answer them. */
import type { Tree } from "./tree";
import type { MissingVessel, Operation, State, WorkItem, WorkKind } from "../base/types";

/** In the order in which the server lists them. */
export const kWorkTitles: Record<WorkKind, [one: string, several: string]> = {
  blocked: ["blocked place", "blocked places"],
  loose: ["loose piece", "loose pieces"],
  doubled: ["doubled track", "doubled tracks"],
  missing: ["missing vessel", "missing vessels"],
  "early-end": ["early end", "early ends"],
  dark: ["dark place", "dark places"],
  "wall-off": ["wall off its edge", "walls off their edges"],
  thin: ["vessel below a voxel", "vessels below a voxel"],
};

const count = (n: number, [one, several]: [string, string]): string => `${n} ${n === 1 ? one : several}`;

/** The kinds of items with their numbers: "2 loose pieces, 1 dark place". */
export function countKinds(items: readonly WorkItem[]): string {
  return (Object.keys(kWorkTitles) as WorkKind[])
    .map(kind => [kind, items.filter(item => item.kind === kind).length] as const)
    .filter(([, n]) => n > 0)
    .map(([kind, n]) => count(n, kWorkTitles[kind]))
    .join(", ");
}

/** Missing vessels that nothing runs through yet and nobody ignores: the ids of their items, and their numbers in the
 * check's answer. */
export function missingPlaces(
  state: Pick<State, "check" | "work">,
): { item: number; index: number; place: MissingVessel }[] {
  return (state.work?.items ?? []).flatMap(({ id, missing }) => {
    const place = missing === null ? undefined : state.check?.missing_vessels?.[missing];
    return missing === null || place === undefined ? [] : [{ item: id, index: missing, place }];
  });
}

export type Remedy = "track" | "cut" | "join" | "delete";
const kRemedies: Record<WorkKind, Remedy[]> = {
  blocked: ["cut", "delete"],
  loose: ["join", "delete"],
  doubled: ["delete"],
  missing: ["track"],
  "early-end": ["track"],
  dark: ["cut", "delete"],
  "wall-off": ["cut", "delete"],
  thin: ["delete"],
};

/** The remedies that an item may have, the likeliest first. */
export function remediesOf(item: WorkItem): Remedy[] {
  return kRemedies[item.kind].filter(remedy => remedy !== "track" || item.missing !== null);
}

/** The node of another tree that is nearest to the first node of a branch, or -1. */
function nearestOutside(tree: Tree, branch: number): number {
  const rootOf = (b: number): number => {
    let at = b;
    while (tree.branches[at].parent_node >= 0) at = tree.branch[tree.branches[at].parent_node];
    return at;
  };
  const own = rootOf(branch),
    outside = tree.branches.map((_, b) => rootOf(b) !== own);
  return tree.nearest(tree.position(tree.branches[branch].first_node), b => outside[b]);
}

/** The request of a remedy; null if it cannot be asked for. */
export function requestOf(
  remedy: Remedy,
  item: WorkItem,
  state: Pick<State, "check">,
  tree: Tree | null,
): Operation | null {
  switch (remedy) {
    case "track": {
      const clicks = item.missing === null ? undefined : state.check?.missing_vessels?.[item.missing]?.clicks;
      if (clicks === undefined) return null;
      return {
        op: "track_from",
        points: clicks.points.map((position, i) => ({
          position,
          radius_mm: i === 0 ? clicks.radius_mm : null,
        })),
      };
    }
    case "cut":
      return { op: "cut", node: item.node };
    case "delete":
      return { op: "delete", branch: item.branch };
    case "join": {
      const node = tree === null ? -1 : nearestOutside(tree, item.branch);
      return node < 0 ? null : { op: "join", branch: item.branch, node };
    }
  }
}
