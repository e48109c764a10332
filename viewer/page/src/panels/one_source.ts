// SPDX-License-Identifier: Apache-2.0
/** A volume and a case that may be of two patients: the page asks, aloud and until there is an answer. */
import type { Part } from "../model/model";
import type { FileEntry, State } from "../base/types";
import { button, choose, h } from "../base/ui";

const kChoices = [
  { value: "accept", label: "They belong together" },
  { value: "case", label: "Close the case" },
  { value: "volume", label: "Close the volume" },
] as const;

/** What the page asks for `answer`; null for none, and for one that no longer fits the state. */
export function requestFor(
  answer: string | null,
  state: Pick<State, "files">,
): { op: string; id?: FileEntry["id"] } | null {
  if (answer === "accept") return { op: "accept_volume" };
  const file = state.files.find(each => each.kind === answer);
  return file === undefined ? null : { op: "close_file", id: file.id };
}

async function askWhich(app: Part<"document", "perform">): Promise<void> {
  const { other_source: otherSource } = app.store.get().document.state;
  if (otherSource === null) return;
  const answer = await choose(
    "One patient, or two?",
    `${otherSource}. Vessels are not tracked in this volume until you answer; the case records that you accept it.`,
    kChoices,
  );
  const request = requestFor(answer, app.store.get().document.state);
  if (request !== null) await app.perform(request);
}

/** A line that stays while the question is open. The question comes by itself once for each pair. */
export function oneSourcePanel(app: Part<"document", "source" | "perform">): HTMLElement[] {
  if (!app.source.live) return [];
  const text = h("p", { class: "warning", id: "other-source" }),
    line = h(
      "section",
      { class: "section alert", role: "alert", hidden: true },
      text,
      h(
        "div",
        { class: "row end" },
        button(
          { text: "Answer", label: "Answer whether volume and case belong together", id: "answer-source" },
          () => void askWhich(app),
        ),
      ),
    );
  let asked: string | null = null;
  app.store.watch(["document.state"], ({ document: { state } }) => {
    line.hidden = state.other_source === null;
    text.textContent = state.other_source ?? "";
    if (state.other_source === asked) return;
    asked = state.other_source;
    void askWhich(app);
  });
  return [line];
}

/** What is not certain about the place of the voxels, such as which side is left; it stays on the page. */
export function assumptionsPanel(app: Part<"document">): HTMLElement[] {
  const list = h("ul", { class: "list" }),
    box = h(
      "section",
      { class: "section alert", id: "assumptions", role: "note", hidden: true },
      h("h2", {}, "Not certain"),
      list,
    );
  app.store.watch(["document.state"], ({ document: { state } }) => {
    box.hidden = state.assumptions.length === 0;
    list.replaceChildren(...state.assumptions.map(sentence => h("li", {}, `The volume: ${sentence}.`)));
  });
  return [box];
}
