// SPDX-License-Identifier: Apache-2.0
/** The selected vessel in words, below the list of vessels. */
import type { Part, View } from "../model/model";
import { setOpacity } from "../model/selection";
import { askText, brief, button, h, mm, slider } from "../base/ui";

export class VesselDetail {
  readonly element = h("div", {
    class: "detail",
    id: "branch-detail",
    "aria-label": "Selected vessel",
  });

  constructor(private readonly app: Part<"document" | "selection", "source" | "perform">) {
    app.store.watch(
      ["document.tree", "selection.selected", "selection.opacity", "selection.allOpacity", "document.state"],
      view => this.describe(view),
    );
  }

  private describe(view: Pick<View, "document" | "selection">): void {
    const b =
        view.selection.selected >= 0 ? view.document.tree?.branches[view.selection.selected] : undefined,
      { app } = this;
    if (b === undefined) {
      const r = view.document.tree?.reachable ?? null;
      this.element.replaceChildren(
        ...(view.document.tree === null
          ? []
          : [
              h(
                "p",
                { class: "hint" },
                `${
                  r === null
                    ? `${brief(view.document.tree.branches.reduce((s, x) => s + x.length_mm, 0))} mm of vessels`
                    : `${brief(r.reached_mm)} of ${brief(r.total_mm)} mm are reachable from ${r.trees === 1 ? "the root" : `the roots of ${r.trees} trees`}`
                }. Click a vessel here or in a view.`,
              ),
            ]),
      );
      return;
    }
    const parent = b.parentBranch < 0 ? "none: a root" : view.document.tree!.branches[b.parentBranch].label;
    const least = view.document.tree!.leastShown;
    const radius = (mm: number): string => (mm < least ? `≤ ${brief(least)}` : brief(mm));
    const rows: [string, string][] = [
      ["Length", mm(b.length_mm)],
      ["Radius", `${radius(b.mean)} (${radius(b.least)} – ${radius(b.greatest)}) mm`],
      ["Confidence", b.confidence === null ? "–" : `${Math.round(100 * b.confidence)} %`],
      ["End", b.end ?? b.stop_reason.replaceAll("-", " ")],
      ["Parent", parent],
    ];
    if (view.document.tree!.systems.length > 0)
      rows.push(["System", (b.system ?? "unknown").replaceAll("-", " ")]);
    const edited = view.document.tree!.countEdited(b);
    if (edited > 0) rows.push(["Edited", `${edited} of ${b.node_count} nodes, by hand`]);
    const opacity = slider(
      "branch-opacity",
      `Opacity of ${b.label}`,
      [0, 1, 0.05],
      view.selection.opacity.get(b.label) ?? 1,
      value => setOpacity(app, b.index, value),
    );
    if (document.activeElement?.id === "branch-opacity" && this.element.dataset.branch === String(b.index))
      return; // being dragged
    this.element.dataset.branch = String(b.index);
    this.element.replaceChildren(
      h(
        "div",
        { class: "paneltop" },
        h("h3", { id: "branch-name" }, b.label),
        h("span", { class: "kind" }, b.kind),
        app.source.live
          ? button(
              { icon: "edit", label: "Rename", key: "F2", id: "branch-rename" },
              () => void renameBranch(app, b.index),
            )
          : null,
      ),
      h("dl", {}, ...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])),
      h("label", { class: "line" }, "Opacity", opacity),
    );
  }
}

export async function renameBranch(
  app: Part<"document", "source" | "perform">,
  branch: number,
): Promise<void> {
  const { tree } = app.store.get().document,
    old = tree?.branches[branch]?.label;
  if (old === undefined || !app.source.live) return;
  const label = (await askText("Rename the vessel", "Name", old))?.trim();
  if (label === undefined || label === "" || label === old) return;
  await app.perform({ op: "rename", branch, label });
}
