// SPDX-License-Identifier: Apache-2.0
/** Find vessels: what the volume shows and the case lacks, as a list to accept or to reject. */
import { systemWords } from "../base/colour";
import type { Part } from "../model/model";
import { goTo } from "../model/selection";
import type { Proposal, State } from "../base/types";
import { brief, button, h, link, mm, replaceRows, section } from "../base/ui";

/** What these functions take of the page. */
type Needs = Part<"document" | "selection" | "slices", "source" | "perform">;

const kConfidence =
  "Confidence, 0 to 1: the share of the measured wall points that lie on the vessel's cylinders, as a mean of its nodes";

/** A sentence on the proposals as they are. */
function aboutProposals(state: Pick<State, "has_case" | "proposals">): string {
  const count = state.proposals.length;
  if (count > 0)
    return `${count === 1 ? "One vessel waits" : `${count} vessels wait`} (dashed). To accept one accepts its parents too; it is then fitted, and part of the case.`;
  return state.has_case
    ? "Finds the vessels of the volume that the case lacks, and proposes them."
    : "Finds the vessels of the volume without a click, and proposes them.";
}

export function findPanel(app: Needs): HTMLElement[] {
  if (!app.source.live) return [];
  const { store } = app,
    list = h("ul", { class: "list proposals", id: "proposal-list", "aria-label": "Proposed vessels" }),
    about = h("p", { class: "hint", id: "find-about" });
  const run = button(
    {
      icon: "find",
      text: "Find vessels",
      label: "Find the vessels of the volume that the case lacks",
      key: "Shift+F",
      id: "find",
      class: "button primary",
    },
    () => void app.perform({ op: "find" }),
  );
  const all = button(
      { text: "Accept all", label: "Accept all proposed vessels", id: "accept-all", class: "button text" },
      () => void app.perform({ op: "accept", labels: null }),
    ),
    none = button(
      { text: "Reject all", label: "Reject all proposed vessels", id: "reject-all", class: "button text" },
      () => void app.perform({ op: "reject", labels: null }),
    ),
    decide = h("div", { class: "row end" }, none, all),
    box = section(
      "section-find",
      "Find vessels",
      true,
      about,
      list,
      decide,
      h("div", { class: "row end" }, run),
    );
  store.watch(["document.state"], ({ document: { state } }) => {
    const waiting = state.proposals.length > 0;
    box.hidden = !state.has_volume;
    run.disabled = !state.has_volume || state.job !== null;
    all.disabled = none.disabled = state.job !== null;
    list.hidden = decide.hidden = !waiting;
    about.textContent = aboutProposals(state);
    replaceRows(
      list,
      state.proposals.map(proposal => proposalRow(app, proposal)),
    );
  });
  store.watch(["selection.proposal"], ({ selection: { proposal } }) => {
    for (const row of list.children)
      (row as HTMLElement).classList.toggle("chosen", (row as HTMLElement).dataset.label === proposal);
  });
  return [box];
}

function proposalRow(app: Needs, proposal: Proposal): HTMLElement {
  const { label, parent } = proposal,
    busy = app.store.get().document.state.job !== null;
  const show = (): void => {
    app.store.set({ selection: { proposal: label, place: null } });
    goTo(app, proposal.position);
  };
  const accept = button(
      { icon: "check", label: `Accept ${label}${proposal.parent_waits ? " and its parents" : ""}` },
      () => void app.perform({ op: "accept", labels: [label] }),
    ),
    reject = button(
      { icon: "close", label: `Reject ${label}` },
      () => void app.perform({ op: "reject", labels: [label] }),
    );
  accept.disabled = reject.disabled = busy;
  return h(
    "li",
    {
      class: app.store.get().selection.proposal === label ? "row item chosen" : "row item",
      "data-label": label,
    },
    h(
      "div",
      { class: "what" },
      h(
        "div",
        { class: "row" },
        link(label, show),
        h(
          "span",
          { class: "note", title: parent === null ? "A tree of its own" : `It leaves ${parent}` },
          `${proposal.kind === "aneurysm" ? "aneurysm, " : ""}${systemWords(proposal.system)}${parent === null ? "own tree" : `on ${parent}`}`,
        ),
      ),
      h(
        "div",
        { class: "figures" },
        h("span", { title: "Length" }, mm(proposal.length_mm)),
        h("span", { title: "Mean radius, mm" }, `r ${brief(proposal.radius_mm)}`),
        h("span", { class: "confidence", title: kConfidence }, `confidence ${brief(proposal.confidence)}`),
      ),
    ),
    accept,
    reject,
  );
}
