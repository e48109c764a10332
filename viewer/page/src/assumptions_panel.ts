// SPDX-License-Identifier: Apache-2.0
/** What is not certain about the place of the voxels, such as which side is left; it stays on the page. */
import type { App } from "./model";
import { h } from "./ui";

export function assumptionsPanel(app: App): HTMLElement[] {
  const list = h("ul", { class: "list" }),
    box = h(
      "section",
      { class: "section alert", id: "assumptions", role: "note", hidden: true },
      h("h2", {}, "Not certain"),
      list,
    );
  app.store.watch(["state"], ({ state }) => {
    box.hidden = state.assumptions.length === 0;
    list.replaceChildren(...state.assumptions.map(sentence => h("li", {}, `The volume: ${sentence}.`)));
  });
  return [box];
}
