// SPDX-License-Identifier: Apache-2.0
/** The list of vessels: a tree in the order of the case, or a table by any of its columns. */
import { toHex, fromHex, systemWords } from "../base/colour";
import { colourOf, isShown, type CursorPart, type View } from "../model/model";
import { goToNode, showAll, showBranch, toggleHidden, toggleSolo } from "../model/selection";
import type { Branch, Tree } from "../case/tree";
import { afterClick, chooseVessels } from "../model/vessel_set";
import { renameBranch, VesselDetail } from "./vessel_detail";
import { vesselSetBar } from "./vessel_set_bar";
import { brief, button, h, icon, mm, select } from "../base/ui";

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

interface Row {
  branch: number;
  element: HTMLElement;
  eye: HTMLButtonElement;
  swatch: HTMLInputElement;
  /** As it is marked now: a row that stays as it is costs nothing. */
  marked: string;
}

export class TreePanel {
  private sort: Sort = "tree";
  private wanted = "";
  private readonly list = h("ul", {
    class: "tree",
    id: "tree-list",
    role: "tree",
    "aria-label": "Vessels",
    "aria-multiselectable": true,
    tabindex: 0,
  });
  private readonly count = h("span", { class: "count", id: "tree-count" });
  private rows: Row[] = [];

  constructor(
    readonly element: HTMLElement,
    private readonly app: CursorPart<never, "source" | "perform" | "inform">,
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
    search.addEventListener("keydown", e => {
      if (e.key !== "Enter" || this.rows.length === 0) return;
      e.preventDefault();
      showBranch(app, this.rows[0].branch);
      this.list.focus({ preventScroll: true });
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
        h("span", { class: "radius" }, "Radius"),
        h("span", {}, "Conf."),
      ),
      this.list,
      vesselSetBar(app, () => this.labels()),
      new VesselDetail(app).element,
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
        "selection.chosen",
        "selection.hidden",
        "selection.solo",
        "selection.colours",
        "selection.opacity",
      ],
      view => this.mark(view),
    );
  }

  private ordered(tree: Tree): { branch: Branch; depth: number }[] {
    const matches = (b: Branch): boolean =>
      this.wanted === "" ||
      `${b.label} ${b.kind} ${b.stop_reason} ${b.system ?? ""}`.toLowerCase().includes(this.wanted);
    if (this.sort === "tree")
      return tree
        .outline()
        .map(({ branch, depth }) => ({
          branch: tree.branches[branch],
          depth: this.wanted === "" ? depth : 0,
        }))
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
    this.list.classList.toggle("found", this.wanted !== "");
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
      h("span", { class: "number radius" }, brief(b.mean)),
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
        if (e.shiftKey) this.choose(b.label, "range");
        else if (e.ctrlKey || e.metaKey) this.choose(b.label, "toggle");
        else {
          chooseVessels(app, []);
          showBranch(app, b.index);
        }
        this.list.focus({ preventScroll: true });
      }
    });
    element.addEventListener("dblclick", e => {
      if ((e.target as HTMLElement).closest("button, input") === null)
        goToNode(app, b.first_node + (b.node_count >> 1));
    });
    this.rows.push({ branch: b.index, element, eye, swatch, marked: "" });
    return element;
  }

  /** Labels of the rows, from top to bottom. */
  private labels(): string[] {
    const branches = this.app.store.get().document.tree?.branches ?? [];
    return this.rows.map(row => branches[row.branch].label);
  }

  /** Chooses a vessel beside others, or all from the selected one on. */
  private choose(label: string, how: "toggle" | "range"): void {
    const { document, selection } = this.app.store.get(),
      anchor = document.tree?.branches[selection.selected]?.label ?? null;
    chooseVessels(this.app, afterClick(selection.chosen, this.labels(), label, anchor, how));
  }

  /** Updates selection, visibility and colours without a new list. */
  private mark(view: Pick<View, "document" | "selection">): void {
    for (const row of this.rows) {
      const { branch, element, eye, swatch } = row,
        on = branch === view.selection.selected,
        isChosen = on || view.selection.chosen.has(view.document.tree?.branches[branch].label ?? ""),
        shown = isShown(view, branch),
        colour = toHex(colourOf(view, branch)),
        isolated = view.selection.solo !== null && shown,
        marked = `${on} ${isChosen} ${shown} ${isolated} ${colour}`;
      if (marked === row.marked) continue;
      row.marked = marked;
      element.setAttribute("aria-selected", String(isChosen));
      element.classList.toggle("off", !shown);
      if (on) {
        this.list.setAttribute("aria-activedescendant", element.id);
        element.scrollIntoView({ block: "nearest" });
      }
      eye.setAttribute("aria-pressed", String(shown));
      eye.replaceChildren(icon(shown ? "eye" : "hidden"));
      swatch.value = colour;
      element.classList.toggle("isolated", isolated);
    }
    if (view.selection.selected < 0) this.list.removeAttribute("aria-activedescendant");
  }

  private key(e: KeyboardEvent): void {
    const { app } = this,
      { selected } = app.store.get().selection,
      at = this.rows.findIndex(r => r.branch === selected);
    if ((e.ctrlKey || e.metaKey) && e.key === "a") {
      chooseVessels(app, this.labels());
      e.preventDefault();
      return;
    }
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
}
