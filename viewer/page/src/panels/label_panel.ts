// SPDX-License-Identifier: Apache-2.0
/** The labels of the map beside the volume: how they are drawn, and a list with an eye and a role for each. */
import { toCss } from "../base/colour";
import {
  kLabelModes,
  labelColour,
  labelPalette,
  middleOf,
  nameOf,
  type LabelLook,
} from "../model/label_look";
import type { Part, View } from "../model/model";
import { goTo } from "../model/selection";
import type { Label } from "../base/types";
import { button, h, icon, link, section, select, slider } from "../base/ui";

type Needs = Part<"document" | "slices", "source" | "perform">;

const same = (a: Uint8Array, b: Uint8Array): boolean =>
  a.length === b.length && a.every((byte, i) => byte === b[i]);

function toggle(app: Needs, value: number): void {
  const hidden = new Set(app.store.get().slices.hiddenLabels);
  if (!hidden.delete(value)) hidden.add(value);
  app.store.set({ slices: { hiddenLabels: hidden } });
}

function show(app: Needs, place: number): void {
  const { labels } = app.store.get().document,
    at = labels === null ? null : middleOf(labels, place);
  if (at !== null) goTo(app, at);
}

interface Row {
  element: HTMLElement;
  /** Shows the label as it is now. */
  update: (label: Label, view: Pick<View, "document" | "slices">) => void;
}

function labelRow(app: Needs, label: Label, place: number, roles: readonly string[]): Row {
  const name = nameOf(label),
    eye = button({ icon: "eye", label: `Show or hide ${name}`, class: "button eye" }, () =>
      toggle(app, label.value),
    ),
    dot = h("span", { class: "labelcolour", "aria-hidden": "true" }),
    role = select(
      `role-${label.value}`,
      `Role of ${name}`,
      roles.map((word): [string, string] => [word, word.replaceAll("-", " ")]),
      label.role,
      word => void app.perform({ op: "role", label: label.value, role: word }),
    );
  return {
    element: h(
      "li",
      { class: "row item", "data-label": label.value, title: `${name}: ${label.voxels} voxels` },
      eye,
      dot,
      link(name, () => show(app, place)),
      role,
    ),
    update: (now, { document: { state }, slices: { hiddenLabels } }) => {
      const isHidden = hiddenLabels.has(now.value);
      eye.replaceChildren(icon(isHidden ? "hidden" : "eye"));
      eye.setAttribute("aria-pressed", String(!isHidden));
      dot.style.background = toCss(labelColour(now, place));
      role.value = now.role;
      role.title =
        now.from === null ? "Role: no table and no word of its name shows it" : `Role: ${now.from}`;
      role.disabled = !app.source.live || state.job !== null;
    },
  };
}

export function labelPanel(app: Needs): HTMLElement[] {
  const { store } = app,
    look = (to: Partial<LabelLook>): void =>
      store.set({ slices: { labelLook: { ...store.get().slices.labelLook, ...to } } }),
    about = h("p", { class: "hint", id: "labels-about" }),
    list = h("ul", { class: "list labels", id: "label-list", "aria-label": "Labels" }),
    mode = select("label-mode", "Labels in the slices", kLabelModes, "fill", value => look({ mode: value })),
    opacity = slider("label-opacity", "Opacity of labels", [0.05, 1, 0.05], 0.4, value =>
      look({ opacity: value }),
    ),
    search = h("input", {
      type: "search",
      id: "label-search",
      placeholder: "Search labels",
      "aria-label": "Search labels by name, number or role",
    }),
    all = button({ icon: "eye", label: "Show all labels, or none", id: "labels-all" }, () => {
      const { state } = store.get().document,
        isAnyHidden = store.get().slices.hiddenLabels.size > 0,
        values = (state.labels?.list ?? []).map(({ value }) => value);
      store.set({ slices: { hiddenLabels: new Set(isAnyHidden ? [] : values) } });
    });
  let rows: Row[] = [],
    made = -1;
  const update = (view: Pick<View, "document" | "slices">): void => {
    const { labels, revisions } = view.document.state,
      words = search.value.trim().toLowerCase(),
      { hiddenLabels, labelPalette: before } = view.slices;
    box.hidden = labels === null;
    if (labels === null) return;
    if (made !== revisions.labels) {
      made = revisions.labels ?? 0;
      rows = labels.list.map((label, i) => labelRow(app, label, i + 1, labels.roles));
      list.replaceChildren(...rows.map(({ element }) => element));
    }
    labels.list.forEach((label, i) => {
      rows[i].update(label, view);
      rows[i].element.hidden = !`${label.value} ${nameOf(label)} ${label.role}`.toLowerCase().includes(words);
    });
    about.textContent = `${labels.name}: ${labels.list.length} labels. Find vessels (Shift+F) follows their roles, and names vessels after them.`;
    const palette = labelPalette(labels.list, hiddenLabels);
    if (!same(palette, before)) store.set({ slices: { labelPalette: palette } });
  };
  search.addEventListener("input", () => update(store.get()));
  const box = section(
    "section-labels",
    "Labels",
    true,
    h("div", { class: "row" }, mode, all),
    h("label", { class: "line" }, "Opacity", opacity),
    search,
    list,
    about,
  );
  store.watch(["document.state", "slices.hiddenLabels"], update);
  store.watch(["slices.labelLook"], ({ slices: { labelLook } }) => {
    mode.value = labelLook.mode;
    opacity.value = String(labelLook.opacity);
  });
  return [box];
}
