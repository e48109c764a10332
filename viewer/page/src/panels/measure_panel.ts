// SPDX-License-Identifier: Apache-2.0
/** Measurements, gaps between vessels, and the figures of a comparison. */
import type { Actions } from "./actions";
import type { Hand } from "../tools/hand";
import { measurementsCsv } from "../model/kept_view";
import { gaps } from "../tools/measure";
import type { Part } from "../model/model";
import { goTo } from "../model/selection";
import { brief, button, h, link, saveText, section } from "../base/ui";

const kMostGaps = 40;

export function measurePanel(
  app: Part<"document" | "slices" | "tools", "source" | "inform">,
  actions: Pick<Actions, "compare" | "open">,
  hand: Hand,
): HTMLElement[] {
  return [measureSection(app, hand), gapSection(app, hand), compareSection(app, actions)];
}

function measureSection(app: Part<"document" | "slices" | "tools", "inform">, hand: Hand): HTMLElement {
  const { store } = app,
    list = h("ul", { class: "list", id: "measure-list", "aria-label": "Measurements" });
  const clear = button(
    { text: "Clear", label: "Remove all measurements", id: "measure-clear", class: "button text" },
    () => store.set({ tools: { measurements: [], pending: [] } }),
  );
  const here = button(
    {
      text: "Section at cursor",
      label: "Diameter and area at the cursor of the selected vessel",
      id: "measure-section",
      class: "button text",
    },
    () => hand.section(store.get().slices.crosshair),
  );
  const keep = button(
    {
      text: "Probe crosshair",
      label: "Keep what the probe shows at the crosshair",
      id: "measure-probe",
      class: "button text",
    },
    () => hand.keepProbe(store.get().slices.crosshair),
  );
  const csv = (): string => measurementsCsv(store.get().tools.measurements);
  const copy = button(
    { text: "Copy", label: "Copy the measurements as a table", id: "measure-copy", class: "button text" },
    () =>
      void navigator.clipboard.writeText(csv()).then(
        () => app.inform("The measurements are copied, as comma-separated values."),
        () => app.inform("The browser does not let the page copy: take the CSV file.", "warning"),
      ),
  );
  const table = button(
    {
      text: "CSV",
      label: "Save the measurements as comma-separated values",
      id: "measure-csv",
      class: "button text",
    },
    () => saveText(`${store.get().document.state.title || "lumen"}.measurements.csv`, csv()),
  );
  store.watch(["tools.measurements"], view => {
    clear.disabled = copy.disabled = table.disabled = view.tools.measurements.length === 0;
    list.replaceChildren(
      ...view.tools.measurements.map(m =>
        h(
          "li",
          { class: "row item" },
          link(m.text, () => goTo(app, m.points[0])),
          h("span", { class: "note", title: m.detail }, m.detail),
          button({ icon: "close", label: "Remove this measurement", class: "button" }, () =>
            store.set({ tools: { measurements: store.get().tools.measurements.filter(x => x !== m) } }),
          ),
        ),
      ),
    );
    if (view.tools.measurements.length === 0)
      list.append(
        h(
          "li",
          { class: "hint" },
          "Distance (D), angle (A), section (X), gap (G), probe (P, then click keeps).",
        ),
      );
  });
  return section(
    "section-measure",
    "Measure",
    true,
    list,
    h("div", { class: "row wrap" }, here, keep, copy, table, clear),
  );
}

function gapSection(app: Part<"document">, hand: Hand): HTMLElement {
  const { store } = app,
    list = h("ul", { class: "list", id: "gap-list", "aria-label": "Vessels that touch or nearly touch" });
  const find = (): void => {
    const { tree, blob } = store.get().document;
    if (tree === null) return;
    const found = gaps(tree, blob, kMostGaps);
    list.replaceChildren(
      ...found.map(g =>
        h(
          "li",
          { class: "row item" },
          h(
            "button",
            {
              type: "button",
              class: "link",
              title: "Show and measure it",
              onclick: () =>
                hand.showGap(g.from, g.to, g.gap, tree.branches[g.a].label, tree.branches[g.b].label),
            },
            `${tree.branches[g.a].label} – ${tree.branches[g.b].label}`,
          ),
          h("span", { class: g.gap <= 0 ? "note low" : "note" }, `${brief(g.gap)} mm`),
        ),
      ),
    );
    if (found.length === 0) list.append(h("li", { class: "hint" }, "No two vessels come near each other."));
  };
  store.watch(["document.tree", "document.blob"], () => list.replaceChildren());
  return section(
    "section-gaps",
    "Vessels that touch",
    false,
    h(
      "div",
      { class: "row" },
      button(
        {
          text: "Find",
          label: "Find where vessels come near each other",
          id: "gap-find",
          class: "button text",
        },
        find,
      ),
    ),
    list,
  );
}

const kFigures: [string, string, string][] = [
  ["overlap", "Overlap", "share"],
  ["average_inside_mm", "Centerline, average", "mm"],
  ["assd_mm", "Centerline, symmetric", "mm"],
  ["radius_bias_mm", "Radius, bias", "mm"],
  ["radius_rms_mm", "Radius, rms", "mm"],
  ["missed_mm", "Missed", "mm"],
  ["false_mm", "False", "mm"],
];

function compareSection(
  app: Part<"document", "source">,
  actions: Pick<Actions, "compare" | "open">,
): HTMLElement {
  const { store } = app,
    table = h("dl", { id: "figures" }),
    hint = h("p", { class: "hint" });
  const run = button(
    {
      icon: "compare",
      text: "Compare",
      label: "Compare the case with the truth",
      id: "compare",
      class: "button text",
    },
    () => void actions.compare(),
  );
  const open = button(
    { text: "Open truth…", label: "Open a second case or the truth", id: "open-truth", class: "button text" },
    () => actions.open("truth"),
  );
  store.watch(["document.state", "document.figures", "document.distance"], view => {
    const f = view.document.figures,
      wall = f?.wall_distance_mm as { median?: number; p90?: number; max?: number } | undefined;
    hint.textContent = view.document.state.has_truth
      ? f === null
        ? "Compare to see distances as colour."
        : "Colours: distance of the surface to the truth’s; red is outside."
      : "Open a second case or the truth beside this one.";
    run.disabled =
      !view.document.state.has_truth || !view.document.state.has_case || view.document.state.job !== null;
    const rows =
      f === null
        ? []
        : [
            ...kFigures
              .filter(([key]) => typeof f[key] === "number")
              .map(([key, title, unit]) => [
                title,
                unit === "share"
                  ? `${(100 * (f[key] as number)).toFixed(1)} %`
                  : `${(f[key] as number).toFixed(3)} mm`,
              ]),
            ...(wall === undefined
              ? []
              : [
                  ["Wall, median", `${wall.median?.toFixed(3) ?? "–"} mm`],
                  ["Wall, 90 %", `${wall.p90?.toFixed(3) ?? "–"} mm`],
                  ["Wall, greatest", `${wall.max?.toFixed(3) ?? "–"} mm`],
                ]),
          ];
    table.replaceChildren(...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
  });
  const box = section(
    "section-compare",
    "Compare",
    false,
    hint,
    table,
    app.source.live ? h("div", { class: "row end" }, open, run) : null,
  );
  store.watch(["document.distance"], view => {
    if (view.document.distance !== null) box.open = true;
  });
  return box;
}
