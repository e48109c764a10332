// SPDX-License-Identifier: Apache-2.0
/** Below the list of vessels: choosing several at once, and what becomes of them. */
import type { Part } from "../model/model";
import { chooseVessels, deleteSet, hideSet, labelsBelow, labelsOfTree } from "../model/vessel_set";
import { askText, button, h } from "../base/ui";

const kUsualShare = "40"; // %

/** `listed`: labels of the rows that the list shows. */
export function vesselSetBar(
  app: Part<"document" | "selection", "source" | "perform" | "inform">,
  listed: () => string[],
): HTMLElement {
  const { store } = app,
    count = h("span", { class: "note", id: "set-count", role: "status" });
  const choices: Record<string, [text: string, choose: () => void]> = {
    below: ["All below a confidence…", () => void chooseBelow(app)],
    tree: [
      "All of this tree",
      () => {
        const { document, selection } = store.get();
        if (document.tree === null || selection.selected < 0)
          app.inform("Select a vessel of the tree first.", "warning");
        else chooseVessels(app, labelsOfTree(document.tree, selection.selected));
      },
    ],
    listed: ["All that are listed", () => chooseVessels(app, listed())],
  };
  const choose = h(
    "select",
    { id: "set-choose", "aria-label": "Choose several vessels", title: "Choose several vessels" },
    h("option", { value: "" }, "Choose…"),
    ...Object.entries(choices).map(([value, [text]]) => h("option", { value }, text)),
  );
  choose.addEventListener("change", () => {
    choices[choose.value]?.[1]();
    choose.value = "";
  });
  const act = (id: string, text: string, label: string, call: () => void): HTMLButtonElement =>
    button({ id, text, label, class: "button text" }, call);
  const edits = app.source.live
    ? [
        act("set-delete", "Delete", "Delete the chosen vessels", () => deleteSet(app)),
        act("set-keep", "Keep", "Keep the chosen vessels, and delete all others", () => deleteSet(app, true)),
      ]
    : [];
  const buttons = [
    ...edits,
    act("set-hide", "Hide", "Hide the chosen vessels", () => hideSet(app)),
    button({ icon: "close", label: "Choose none", id: "set-none" }, () => chooseVessels(app, [])),
  ];
  store.watch(["selection.chosen", "document.state", "document.tree"], ({ document, selection }) => {
    const { size } = selection.chosen,
      all = document.tree?.branches.length ?? 0;
    count.textContent = size < 2 ? "" : `${size} of ${all}`;
    for (const each of buttons) each.hidden = size < 2;
    for (const each of edits) each.disabled = document.state.job !== null || size === all;
  });
  return h("div", { class: "row setbar" }, choose, count, ...buttons);
}

async function chooseBelow(app: Part<"document" | "selection", "inform">): Promise<void> {
  const text = await askText("Choose vessels by their confidence", "All below, %", kUsualShare);
  if (text === null) return;
  const percent = Number(text.replace("%", "").replace(",", ".")),
    { tree } = app.store.get().document;
  if (text.trim() === "" || !(percent > 0 && percent <= 100))
    app.inform(`The confidence is "${text}", but must be above 0 and at most 100 %.`, "warning");
  else if (tree !== null) {
    const labels = labelsBelow(tree, percent / 100);
    chooseVessels(app, labels);
    app.inform(`${labels.length} of ${tree.branches.length} vessels are below ${percent} %.`);
  }
}
