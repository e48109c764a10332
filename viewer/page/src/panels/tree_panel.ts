// SPDX-License-Identifier: Apache-2.0
/** The list of vessels: a tree in the order of the case, or a table by any of its columns. */
import { toHex, fromHex, systemWords } from "../base/colour";
import { colourOf, isShown, type CursorPart, type Part, type View } from "../model/model";
import { goToNode, setOpacity, showAll, showBranch, toggleHidden, toggleSolo } from "../model/selection";
import type { Branch, Tree } from "../case/tree";
import { askText, brief, button, h, icon, mm, select, slider } from "../base/ui";

type Sort = "tree" | "label" | "system" | "length" | "radius" | "confidence" | "stop";
const kSorts: [Sort, string][] = [
  ["tree", "As a tree"],
  ["label", "Name"],
  ["system", "System"],
  ["length", "Length"],
  ["radius", "Radius"],
  ["confidence", "Confidence"],
  ["stop", "Stopped by"],
];
const kOrders: Record<Exclude<Sort, "tree">, (a: Branch, b: Branch) => number> = {
  label: (a, b) => a.label.localeCompare(b.label, "en", { numeric: true }),
  system: (a, b) => (a.system ?? "").localeCompare(b.system ?? "", "en"),
  length: (a, b) => b.length_mm - a.length_mm,
  radius: (a, b) => b.mean - a.mean,
  confidence: (a, b) => (a.confidence ?? 2) - (b.confidence ?? 2), // the doubtful first
  stop: (a, b) => a.stop_reason.localeCompare(b.stop_reason, "en"),
};

export class TreePanel {
  private sort: Sort = "tree";
  private wanted = "";
  private readonly list = h("ul", {
    class: "tree",
    id: "tree-list",
    role: "tree",
    "aria-label": "Vessels",
    tabindex: 0,
  });
  private readonly count = h("span", { class: "count", id: "tree-count" });
  private readonly detail = h("div", {
    class: "detail",
    id: "branch-detail",
    "aria-label": "Selected vessel",
  });
  private rows: { branch: number; element: HTMLElement; eye: HTMLButtonElement; swatch: HTMLInputElement }[] =
    [];

  constructor(
    readonly element: HTMLElement,
    private readonly app: CursorPart<never, "source" | "perform">,
  ) {
    const search = h("input", {
      type: "search",
      id: "tree-search",
      placeholder: "Search vessels",
      "aria-label": "Search vessels",
      title: "Search vessels  (/)",
      "aria-keyshortcuts": "/",
    });
    search.addEventListener("input", () => {
      this.wanted = search.value.trim().toLowerCase();
      this.fill(this.app.store.get());
    });
    element.append(
      h(
        "div",
        { class: "paneltop" },
        h("h2", {}, "Vessels"),
        this.count,
        button({ icon: "eye", label: "Show all vessels, opaque", key: "Shift+H", id: "tree-show-all" }, () =>
          showAll(app),
        ),
      ),
      h(
        "div",
        { class: "row filters" },
        search,
        select("tree-sort", "Order of the list", kSorts, this.sort, sort => {
          this.sort = sort;
          this.fill(app.store.get());
        }),
      ),
      h(
        "div",
        { class: "columns", "aria-hidden": "true" },
        h("span", {}, "Length"),
        h("span", {}, "Radius"),
        h("span", {}, "Conf."),
      ),
      this.list,
      this.detail,
    );
    this.list.addEventListener("keydown", e => this.key(e));
    app.store.watch(["document.tree"], view => this.fill(view));
    app.store.watch(["document.state"], view => {
      if (view.document.tree === null) this.fill(view);
    });
    app.store.watch(["document.state", "document.treeRevision"], view => {
      this.list.setAttribute(
        "aria-busy",
        String(view.document.state.revision !== view.document.treeRevision),
      );
    });
    app.store.watch(
      [
        "document.tree",
        "selection.selected",
        "selection.hidden",
        "selection.solo",
        "selection.colours",
        "selection.opacity",
      ],
      view => this.mark(view),
    );
    app.store.watch(
      ["document.tree", "selection.selected", "selection.opacity", "selection.allOpacity", "document.state"],
      view => this.describe(view),
    );
  }

  private ordered(tree: Tree): { branch: Branch; depth: number }[] {
    const matches = (b: Branch): boolean =>
      this.wanted === "" ||
      `${b.label} ${b.kind} ${b.stop_reason} ${b.system ?? ""}`.toLowerCase().includes(this.wanted);
    if (this.sort === "tree")
      return tree
        .outline()
        .map(({ branch, depth }) => ({ branch: tree.branches[branch], depth }))
        .filter(x => matches(x.branch));
    return [...tree.branches]
      .sort(kOrders[this.sort])
      .filter(matches)
      .map(branch => ({ branch, depth: 0 }));
  }

  private fill(view: Pick<View, "document" | "selection">): void {
    const { tree } = view.document;
    this.rows = [];
    this.list.replaceChildren();
    this.count.textContent = tree === null ? "" : `${tree.branches.length}`;
    if (tree === null) {
      this.list.append(
        h(
          "li",
          { class: "none", role: "none" },
          view.document.state.has_volume
            ? "No vessels yet. Find them (Shift+F), or place seeds in the volume and track them: tool “Seed”, key S."
            : "Nothing is open.",
        ),
      );
      return;
    }
    const ordered = this.ordered(tree);
    if (ordered.length === 0)
      this.list.append(h("li", { class: "none", role: "none" }, "No vessel has these letters in its name."));
    for (const { branch, depth } of ordered) this.list.append(this.row(branch, depth));
    this.mark(view);
  }

  private row(b: Branch, depth: number): HTMLElement {
    const { app } = this;
    const swatch = h("input", {
      type: "color",
      class: "swatch",
      "aria-label": `Colour of ${b.label}`,
      title: "Colour",
      tabindex: -1,
    });
    swatch.addEventListener("input", () =>
      app.store.set({
        selection: {
          colours: new Map(app.store.get().selection.colours).set(b.label, fromHex(swatch.value)),
        },
      }),
    );
    const eye = button({ icon: "eye", label: `Show or hide ${b.label}`, class: "button eye" }, () =>
      toggleHidden(app, b.index),
    );
    const solo = button({ icon: "solo", label: `Show ${b.label} alone`, class: "button solo" }, () =>
      toggleSolo(app, b.index),
    );
    eye.tabIndex = solo.tabIndex = -1;
    const low = b.confidence !== null && b.confidence < 0.45;
    const element = h(
      "li",
      {
        class: `row branch${b.kind === "aneurysm" ? " aneurysm" : ""}`,
        role: "treeitem",
        id: `branch-${b.index}`,
        "aria-level": depth + 1,
        "data-branch": b.index,
        title: `${b.label}: ${systemWords(b.system)}${b.kind}, ${mm(b.length_mm)} long, radius ${brief(b.mean)} (${brief(b.least)} to ${brief(b.greatest)}) mm`,
      },
      swatch,
      h("span", { class: "name" }, b.label),
      h("span", { class: "number" }, brief(b.length_mm)),
      h("span", { class: "number" }, brief(b.mean)),
      h(
        "span",
        { class: low ? "number low" : "number" },
        b.confidence === null ? "–" : `${Math.round(100 * b.confidence)}%`,
      ),
      solo,
      eye,
    );
    for (let d = 1; d <= 6; ++d) if (depth >= d) element.classList.add(`depth${d}`);
    element.addEventListener("click", e => {
      if ((e.target as HTMLElement).closest("button, input") === null) {
        showBranch(app, b.index);
        this.list.focus({ preventScroll: true });
      }
    });
    element.addEventListener("dblclick", e => {
      if ((e.target as HTMLElement).closest("button, input") === null)
        goToNode(app, b.first_node + (b.node_count >> 1));
    });
    this.rows.push({ branch: b.index, element, eye, swatch });
    return element;
  }

  /** Updates selection, visibility and colours without a new list. */
  private mark(view: Pick<View, "document" | "selection">): void {
    for (const { branch, element, eye, swatch } of this.rows) {
      const on = branch === view.selection.selected,
        shown = isShown(view, branch);
      element.setAttribute("aria-selected", String(on));
      element.classList.toggle("off", !shown);
      if (on) {
        this.list.setAttribute("aria-activedescendant", element.id);
        element.scrollIntoView({ block: "nearest" });
      }
      eye.setAttribute("aria-pressed", String(shown));
      eye.replaceChildren(icon(shown ? "eye" : "hidden"));
      swatch.value = toHex(colourOf(view, branch));
      element.classList.toggle("isolated", view.selection.solo !== null && shown);
    }
    if (view.selection.selected < 0) this.list.removeAttribute("aria-activedescendant");
  }

  private key(e: KeyboardEvent): void {
    const { app } = this,
      { selected } = app.store.get().selection,
      at = this.rows.findIndex(r => r.branch === selected);
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: this.rows.length - 1 }[e.key];
    if (to !== undefined) {
      if (this.rows[to] !== undefined) showBranch(app, this.rows[to].branch);
    } else if (selected >= 0 && e.key === " ") toggleHidden(app, selected);
    else if (selected >= 0 && e.key === "Enter") goToNode(app, app.store.get().selection.node);
    else if (selected >= 0 && e.key === "F2") void renameBranch(app, selected);
    else return;
    e.preventDefault();
    e.stopPropagation();
  }

  private describe(view: Pick<View, "document" | "selection">): void {
    const b =
        view.selection.selected >= 0 ? view.document.tree?.branches[view.selection.selected] : undefined,
      { app } = this;
    if (b === undefined) {
      const r = view.document.tree?.reachable ?? null;
      this.detail.replaceChildren(
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
    const rows: [string, string][] = [
      ["Length", mm(b.length_mm)],
      ["Radius", `${brief(b.mean)} (${brief(b.least)} – ${brief(b.greatest)}) mm`],
      ["Confidence", b.confidence === null ? "–" : `${Math.round(100 * b.confidence)} %`],
      ["Stopped by", b.stop_reason.replaceAll("-", " ")],
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
    if (document.activeElement?.id === "branch-opacity" && this.detail.dataset.branch === String(b.index))
      return; // being dragged
    this.detail.dataset.branch = String(b.index);
    this.detail.replaceChildren(
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
