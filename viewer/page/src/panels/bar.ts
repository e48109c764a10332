// SPDX-License-Identifier: Apache-2.0
/** The bar on top: files, history, tools, layout. */
import { kViewFormat } from "../model/kept_view";
import type { Actions } from "./actions";
import { kLayouts, type Part, type Layout, type Tool } from "../model/model";
import { button, h, select } from "../base/ui";

export const kTools: { tool: Tool; label: string; key: string; live?: boolean }[] = [
  { tool: "navigate", label: "Navigate: crosshair, select vessels", key: "N" },
  { tool: "seed", label: "Seed: click vessels to track", key: "S", live: true },
  { tool: "move", label: "Move a node of the selected vessel, or drag its outline", key: "V", live: true },
  { tool: "brush", label: "Brush: push or pull the wall of a vessel in a slice", key: "E", live: true },
  { tool: "probe", label: "Probe: value, distance to the wall, normal", key: "P" },
  { tool: "distance", label: "Distance between two points", key: "D" },
  { tool: "angle", label: "Angle of three points", key: "A" },
  { tool: "section", label: "Cross-section: diameter and area", key: "X" },
  { tool: "touch", label: "Gap to the vessel that is nearest", key: "G" },
];

const kLayoutTitles: Record<Layout, string> = {
  four: "Four views",
  rows: "3D and slices",
  scene: "3D only",
  axial: "Axial only",
  coronal: "Coronal only",
  sagittal: "Sagittal only",
};

/** Formats whose ending says too little. */
const kFormatTitles: Record<string, string | undefined> = {
  html: "page (html)",
  "sofa.zip": "scene of SOFA (zip)",
};

export function makeBar(
  element: HTMLElement,
  app: Part<"document" | "tools" | "page", "source" | "perform">,
  actions: Actions,
): void {
  const { store, source } = app,
    live = source.live;
  const title = h("span", { class: "title", id: "title" }),
    unsaved = h("span", { class: "unsaved", id: "unsaved", title: "Changes are not saved" }, "●");
  const undo = button(
    { icon: "undo", label: "Undo", key: "Control+Z", id: "undo" },
    () => void app.perform({ op: "undo" }),
  );
  const redo = button(
    { icon: "redo", label: "Redo", key: "Control+Shift+Z", id: "redo" },
    () => void app.perform({ op: "redo" }),
  );
  const save = button(
    { icon: "save", label: "Save the case", key: "Control+S", id: "save" },
    () => void actions.save(),
  );
  const formats = h("select", { id: "export", "aria-label": "Export", title: "Save as another format" });
  formats.addEventListener("change", () => {
    if (formats.value !== "") actions.download(formats.value);
    formats.value = "";
  });
  const tools = kTools
    .filter(t => live || t.live !== true)
    .map(t => {
      const b = button(
        {
          icon: t.tool,
          label: t.label,
          key: t.key,
          id: `tool-${t.tool}`,
          pressed: false,
          class: "button tool",
        },
        () => actions.tool(t.tool),
      );
      return { ...t, b };
    });
  const fold = (side: "left" | "right", label: string): HTMLButtonElement =>
    button({ icon: side, label, key: "\\", id: `fold-${side}` }, () => {
      const { panels } = store.get().page;
      store.set({ page: { panels: { ...panels, [side]: !panels[side] } } });
    });
  const left = fold("left", "Fold or open the list of vessels"),
    right = fold("right", "Fold or open display and work");
  const layout = select(
    "layout",
    "Layout of the views  (1 to 6)",
    kLayouts.map((name): [Layout, string] => [name, kLayoutTitles[name]]),
    "four",
    value => store.set({ page: { layout: value } }),
  );
  element.append(
    h("div", { class: "brand" }, h("strong", {}, "lumen"), title, unsaved),
    live
      ? h(
          "div",
          { class: "group" },
          button({ icon: "open", label: "Open files", key: "Control+O", id: "open" }, () => actions.open()),
          save,
          formats,
        )
      : null!,
    live ? h("div", { class: "group" }, undo, redo) : null!,
    h("div", { class: "group", role: "radiogroup", "aria-label": "Tool" }, ...tools.map(t => t.b)),
    h("div", { class: "spring" }),
    h(
      "div",
      { class: "group" },
      button({ icon: "flight", label: "Fly through the selected vessel", key: "F", id: "fly" }, () =>
        actions.fly(),
      ),
      button({ icon: "camera", label: "Save a picture", key: "Control+P", id: "picture" }, () =>
        actions.picture(),
      ),
    ),
    h(
      "div",
      { class: "group" },
      layout,
      left,
      right,
      button({ icon: "fit", label: "Show everything", key: "0", id: "fit" }, () => actions.fit()),
      button({ icon: "theme", label: "Light or dark", key: "Shift+L", id: "theme" }, () => actions.theme()),
      button({ icon: "help", label: "Help and keys", key: "?", id: "help" }, () => actions.help()),
    ),
  );
  for (const child of [...element.childNodes]) if (child.nodeType === Node.TEXT_NODE) child.remove();
  store.watch(["page.panels"], ({ page: { panels } }) => {
    left.setAttribute("aria-expanded", String(panels.left));
    right.setAttribute("aria-expanded", String(panels.right));
  });
  store.watch(["tools.tool"], view => {
    for (const { tool, b } of tools) b.setAttribute("aria-pressed", String(tool === view.tools.tool));
  });
  store.watch(["page.layout"], view => {
    layout.value = view.page.layout;
  });
  store.watch(["document.state"], ({ document: { state } }) => {
    title.textContent = state.title;
    document.title = state.title === "" ? "lumen" : `${state.title} – lumen`;
    unsaved.hidden = !state.unsaved;
    undo.disabled = state.undo === null;
    redo.disabled = state.redo === null;
    undo.title = state.undo === null ? "Nothing to undo" : `Undo: ${state.undo}  (Control+Z)`;
    redo.title = state.redo === null ? "Nothing to do again" : `Redo: ${state.redo}  (Control+Shift+Z)`;
    save.disabled = !state.has_case;
    save.title =
      state.save_as === null
        ? "Save the case as a download  (Control+S)"
        : `Save to ${state.save_as}  (Control+S)`;
    formats.replaceChildren(
      h("option", { value: "" }, "Export…"),
      ...state.formats.map(name => h("option", { value: name }, kFormatTitles[name] ?? name)),
      h("option", { value: kViewFormat }, "view (colours, window, measurements)"),
    );
    formats.disabled = !state.has_case && !state.has_volume;
  });
}
