// SPDX-License-Identifier: Apache-2.0
/** Corrections of the tree, of its nodes and of walls. */
import type { CursorPart, Part, View } from "../model/model";
import { atCursor } from "../model/selection";
import { trackOn } from "../tools/track_on";
import { renameBranch } from "./vessel_detail";
import type { Operation } from "../base/types";
import { button, h, section } from "../base/ui";

/** Corrections of the cursor's node, which act where every view shows it. */
const kAtCursor: Record<string, string | undefined> = {
  cut: "cuts",
  node_add: "adds a node",
  node_delete: "deletes the node",
};

/** A length in mm, or nothing: then `usual` counts. */
function lengthField(
  app: Part<"tools">,
  id: "stretch" | "brush",
  text: string,
  usual: string,
  title: string,
  least: number,
): HTMLElement {
  const input = h("input", {
    type: "number",
    id: `edit-${id}`,
    min: least,
    max: 200,
    step: 0.1,
    placeholder: usual,
    "aria-label": `${text}, mm`,
    title,
  });
  input.addEventListener("change", () => {
    const value = Number(input.value);
    app.store.set({ tools: { [id]: input.value.trim() === "" || !(value >= least) ? null : value } });
  });
  app.store.watch([`tools.${id}`], ({ tools }) => {
    input.value = tools[id] === null ? "" : String(tools[id]);
  });
  return h("label", { class: "line" }, `${text}, mm`, input);
}

export function editSection(app: CursorPart<"tools", "source" | "inform" | "perform">): HTMLElement {
  const { store } = app,
    name = h("p", { class: "hint", id: "edit-name" });
  const act = (
    id: string,
    text: string,
    label: string,
    make: (view: Pick<View, "document" | "selection">) => Operation | null,
    iconName?: string,
    key?: string,
  ): HTMLButtonElement =>
    button({ id: `edit-${id}`, text, label, icon: iconName, key, class: "button text" }, () => {
      const operation = make(store.get());
      if (operation === null) return;
      const doing = kAtCursor[operation.op];
      if (doing !== undefined) atCursor(app, () => void app.perform(operation), doing);
      else void app.perform(operation);
    });
  const target = h("select", {
    id: "edit-target",
    "aria-label": "Vessel to join to",
    title: "Vessel to join to",
  });
  const branch = (v: Pick<View, "selection">): number => v.selection.selected;
  const buttons = [
    button(
      { id: "edit-rename", text: "Rename", label: "Rename", icon: "edit", key: "F2", class: "button text" },
      () => void renameBranch(app, store.get().selection.selected),
    ),
    act(
      "delete",
      "Delete",
      "Delete the vessel",
      v => ({ op: "delete", branch: branch(v) }),
      "trash",
      "Delete",
    ),
    act(
      "cut",
      "Cut here",
      "Cut the vessel before the cursor's node; what follows becomes a vessel of its own",
      v => (v.selection.node < 0 ? null : { op: "cut", node: v.selection.node }),
      "cut",
      "Shift+X",
    ),
    act("reverse", "Reverse", "Turn the vessel round", v => ({ op: "reverse", branch: branch(v) })),
    act("root", "Make root", "Let the tree begin at this vessel", v => ({ op: "root", branch: branch(v) })),
    act("merge", "Merge", "Make it the continuation of its parent", v => ({
      op: "merge",
      branch: branch(v),
    })),
    act("kind", "Vessel ↔ sac", "Change between vessel and aneurysm", v => ({
      op: "kind",
      branch: branch(v),
      kind: v.document.tree?.branches[v.selection.selected].kind === "aneurysm" ? "vessel" : "aneurysm",
    })),
    act(
      "split",
      "Split here",
      "Cut the vessel at the cursor; what follows stays joined as a vessel of its own",
      v => (v.selection.node < 0 ? null : { op: "cut", node: v.selection.node, rest: "child" }),
    ),
    act(
      "prune",
      "Delete below",
      "Delete the vessel and all that leave it",
      v => ({ op: "delete", branch: branch(v), hanging: "go" }),
      undefined,
      "Shift+Delete",
    ),
    act(
      "node-add",
      "Add node",
      "Put a node between the cursor's and the next",
      v => (v.selection.node < 0 ? null : { op: "node_add", node: v.selection.node }),
      undefined,
      "Shift+A",
    ),
    act(
      "node-delete",
      "Delete node",
      "Delete the cursor's node; its neighbours take its wall points",
      v => (v.selection.node < 0 ? null : { op: "node_delete", node: v.selection.node }),
      undefined,
      "Shift+D",
    ),
    button(
      {
        id: "edit-track-on",
        text: "Track on",
        label: "Track the vessel on from the crosshair, or beyond its end if the crosshair is in it",
        icon: "play",
        key: "Shift+T",
        class: "button text",
      },
      () => void trackOn(app),
    ),
    act("fit", "Fit all", "Fit all models anew", () => ({ op: "fit" }), undefined, "Control+Enter"),
  ];
  const join = act(
    "join",
    "Join to",
    "Make its first node a child of the nearest node of the chosen vessel",
    v => {
      const { tree } = v.document,
        to = Number(target.value);
      if (tree === null || target.value === "") return null;
      const first = tree.position(tree.branches[v.selection.selected].first_node);
      return { op: "join", branch: branch(v), node: tree.nearest(first, b => b === to) };
    },
  );
  const box = section(
    "section-edit",
    "Correct",
    true,
    name,
    h("div", { class: "grid" }, ...buttons),
    h("div", { class: "row" }, join, target),
    lengthField(
      app,
      "stretch",
      "Radius fades over",
      "3 radii",
      "Length along the vessel over which a radius that is dragged (V) or typed (R) fades; 0: one node alone",
      0,
    ),
    lengthField(
      app,
      "brush",
      "Brush radius",
      "0.8 radii",
      "Radius of the brush (E), also by Shift and the wheel",
      0.1,
    ),
  );
  store.watch(["document.tree", "selection.selected", "document.state", "selection.node"], view => {
    const b =
      view.selection.selected >= 0 ? view.document.tree?.branches[view.selection.selected] : undefined;
    box.hidden = view.document.tree === null;
    name.textContent =
      b === undefined
        ? "Select a vessel."
        : `${b.label}${view.selection.node >= 0 ? `, cursor at node ${view.selection.node - b.first_node + 1} of ${b.node_count}` : ""}`;
    for (const each of [...buttons, join])
      each.disabled = (b === undefined && each.id !== "edit-fit") || view.document.state.job !== null;
  });
  store.watch(["document.tree", "selection.selected"], view => {
    const before = target.value;
    target.replaceChildren(
      h("option", { value: "" }, "choose a vessel"),
      ...(view.document.tree?.branches ?? [])
        .filter(x => x.index !== view.selection.selected)
        .map(x => h("option", { value: x.index }, x.label)),
    );
    target.value = before;
    if (target.selectedIndex < 0) target.value = "";
  });
  return box;
}
