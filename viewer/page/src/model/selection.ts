// SPDX-License-Identifier: Apache-2.0
/** The selected vessel and the cursor along it; list, views, plot and keys share them. */
import { isShown, shownTree, type CursorPart, type Part, type View } from "./model";
import { vesselFrame } from "./slice_frame";
import type { Vec3 } from "../base/types";
import { length, sub } from "../base/vec";

/** Selects a branch, or none (-1). */
export function select(app: Part<"document" | "selection">, branch: number): void {
  const { store } = app,
    {
      document: { tree },
      selection: { selected },
    } = store.get();
  if (tree === null || branch === selected) return;
  store.set({
    selection: {
      selected: branch,
      node: branch < 0 ? -1 : tree.branches[branch].first_node + (tree.branches[branch].node_count >> 1),
    },
  });
}

/** Puts cursor and crosshair on a node of the tree, and turns the planes with it if they follow the vessel. */
export function goToNode(app: CursorPart, node: number): void {
  const { store } = app,
    { planes } = store.get().slices,
    tree = shownTree(store.get());
  if (tree === null || node < 0 || node >= tree.count) return;
  const branch = tree.branch[node];
  store.set({
    selection: { selected: branch, node },
    slices: {
      crosshair: tree.position(node),
      ...(planes === "vessel" ? { frame: vesselFrame(tree, node) } : {}),
    },
  });
}

/** Selects a branch and shows it in every view: at its cursor if it is selected already, else in its middle. */
export function showBranch(app: CursorPart, branch: number): void {
  const {
    document: { tree },
    selection: { selected, node },
  } = app.store.get();
  if (tree === null || tree.branches[branch] === undefined) return;
  const { first_node: firstNode, node_count: nodeCount } = tree.branches[branch];
  goToNode(app, branch === selected && node >= 0 ? node : firstNode + (nodeCount >> 1));
}

/** Whether the crosshair, through which all slices go, lies in the lumen of the cursor's node. */
export function isCursorShown(view: Pick<View, "document" | "motion" | "selection" | "slices">): boolean {
  const {
      selection: { node },
      slices: { crosshair },
    } = view,
    tree = shownTree(view);
  return (
    tree !== null &&
    node >= 0 &&
    length(sub(tree.position(node), crosshair)) <= Math.max(tree.radius[node], 0)
  );
}

/** Acts on the cursor's node where every view shows it. Elsewhere the views go there first, and nothing else happens. */
export function atCursor(
  app: CursorPart<never, "inform">,
  act: (node: number) => void,
  doing = "cuts",
): void {
  const view = app.store.get();
  if (view.selection.node < 0) return;
  if (isCursorShown(view)) {
    act(view.selection.node);
    return;
  }
  goToNode(app, view.selection.node);
  app.inform(`The views were elsewhere. They show the cursor now: once more ${doing} there.`, "warning");
}

/** Puts the crosshair anywhere. */
export function goTo(app: Part<"slices">, p: Vec3): void {
  app.store.set({ slices: { crosshair: p } });
}

/** Steps along the selected vessel. */
export function stepAlong(app: CursorPart, count: number): void {
  const {
    document: { tree },
    selection: { selected, node },
  } = app.store.get();
  if (tree === null || selected < 0) return;
  const { first_node: firstNode, node_count: nodeCount } = tree.branches[selected];
  goToNode(
    app,
    Math.min(firstNode + nodeCount - 1, Math.max(firstNode, (node < 0 ? firstNode : node) + count)),
  );
}

/** Planes across and along the selected vessel; with none selected, the nearest of those shown. */
export function followVessel(app: CursorPart): void {
  const { store } = app,
    view = store.get();
  if (view.document.tree === null) return;
  const node =
    view.selection.node >= 0
      ? view.selection.node
      : shownTree(view)!.nearest(view.slices.crosshair, b => isShown(view, b));
  if (node < 0) return;
  store.set({ slices: { planes: "vessel" } });
  goToNode(app, node);
}

export function toggleHidden(app: Part<"document" | "selection">, branch: number): void {
  const { store } = app,
    view = store.get(),
    label = view.document.tree?.branches[branch]?.label;
  if (label === undefined) return;
  const hidden = new Set(view.selection.hidden);
  if (!hidden.delete(label)) hidden.add(label);
  store.set({ selection: { hidden, solo: null } });
}
export function toggleSolo(app: Part<"document" | "selection">, branch: number): void {
  const { store } = app,
    view = store.get(),
    label = view.document.tree?.branches[branch]?.label ?? null;
  store.set({ selection: { solo: view.selection.solo === label ? null : label } });
}
export function showAll(app: Part<"selection">): void {
  app.store.set({ selection: { hidden: new Set(), solo: null, opacity: new Map(), allOpacity: 1 } });
}
export function setOpacity(app: Part<"document" | "selection">, branch: number, value: number): void {
  const { store } = app,
    view = store.get(),
    label = view.document.tree?.branches[branch]?.label;
  if (label !== undefined)
    store.set({ selection: { opacity: new Map(view.selection.opacity).set(label, value) } });
}
