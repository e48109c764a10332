// SPDX-License-Identifier: Apache-2.0
/** The selected vessel is tracked on: from the crosshair, or beyond its end. */
import { errorText } from "../base/ui";
import type { Part } from "../model/model";
import type { Tree } from "../case/tree";
import type { Vec3 } from "../base/types";
import { along, distance } from "../base/vec";

const kBeyond = 2; // radii from an end to where the vessel is looked for

/** Where a vessel would go on, and the vessel that it leaves. */
interface Onward {
  from: Vec3;
  /** Null: the vessel goes on before the first node of a root, so it leaves none. */
  parent: string | null;
}

/** The crosshair where it is outside of the selected vessel; else the place beyond the end that is nearer to it. */
export function onward(tree: Tree, branch: number, crosshair: Vec3): Onward {
  const {
      first_node: firstNode,
      node_count: nodeCount,
      label,
      parent_node: parentNode,
    } = tree.branches[branch],
    last = firstNode + nodeCount - 1,
    node = tree.nearest(crosshair, b => b === branch);
  if (distance(tree.position(node), crosshair) > tree.radius[node]) return { from: crosshair, parent: label };
  const beyond = (end: number, way: number): Vec3 =>
    along(tree.position(end), tree.axis(end), way * kBeyond * tree.radius[end]);
  const isBefore =
    parentNode < 0 &&
    distance(crosshair, tree.position(firstNode)) < distance(crosshair, tree.position(last));
  return isBefore ? { from: beyond(firstNode, -1), parent: null } : { from: beyond(last, 1), parent: label };
}

export async function trackOn(
  app: Part<"document" | "selection" | "slices", "source" | "inform" | "perform">,
): Promise<void> {
  const {
    document: { tree, state, volume },
    selection: { selected },
    slices: { crosshair },
  } = app.store.get();
  if (tree === null || selected < 0 || !state.has_volume) {
    app.inform("Select the vessel that goes on, and put the crosshair where it does.", "warning");
    return;
  }
  const { from, parent } = onward(tree, selected, crosshair);
  if (volume !== null && !volume.holds(from)) {
    app.inform("The vessel leaves the volume there.", "warning");
    return;
  }
  try {
    const there = await app.source.vesselAtClick(from);
    if (!there.found) {
      app.store.set({ slices: { crosshair: from } });
      app.inform(
        `No vessel was found there: ${there.reason ?? "it is dark"}. Put the crosshair where the vessel goes on.`,
        "warning",
      );
      return;
    }
    await app.perform({
      op: "track_from",
      points: [{ position: there.position, radius_mm: there.radius_mm }],
      ...(parent === null ? {} : { parent }),
    });
  } catch (error) {
    app.inform(errorText(error), "error");
  }
}
