// SPDX-License-Identifier: Apache-2.0
/** Work on the document: files, seeds and tracking, what the check found, corrections of the tree. */
import { editSection } from "./edit_panel";
import type { Hand } from "../tools/hand";
import type { App, CursorPart, Part } from "../model/model";
import { openSeriesDialog } from "./series_dialog";
import { goTo } from "../model/selection";
import type { Seed } from "../base/types";
import { askYes, brief, button, h, link, section, select } from "../base/ui";
import { checkSection, type WorkList } from "./work_list";

export function workPanel(
  app: CursorPart<"tools", "source" | "inform" | "perform">,
  hand: Hand,
  work: WorkList,
): HTMLElement[] {
  return app.source.live
    ? [seedSection(app, hand), checkSection(app, work), editSection(app), fileSection(app)]
    : [];
}

function seedSection(app: Part<"document" | "slices" | "tools", "perform">, hand: Hand): HTMLElement {
  const { store } = app,
    list = h("ul", { class: "list", id: "seed-list", "aria-label": "Seeds" }),
    trackedCount = h("summary", {}),
    trackedList = h("ul", {
      class: "list",
      id: "seed-tracked-list",
      "aria-label": "Seeds that were tracked",
    }),
    tracked = h("details", { id: "seed-tracked", class: "tracked", hidden: true }, trackedCount, trackedList);
  const kind = select(
    "seed-kind",
    "Meaning of the next clicks",
    [
      ["vessel", "Vessel, one click"],
      ["path", "Vessel, several clicks"],
      ["aneurysm", "Aneurysm, several clicks"],
    ] as ["vessel" | "path" | "aneurysm", string][],
    "vessel",
    value => {
      hand.giveUp();
      hand.seedKind = value;
      finish.hidden = value === "vessel";
    },
  );
  const parent = h("select", {
    id: "seed-parent",
    "aria-label": "Parent of the next seed",
    title: "The vessel that it leaves; tracked ones are also joined where they meet",
  });
  parent.addEventListener("change", () => {
    hand.parent = parent.value === "" ? null : parent.value;
  });
  const finish = button(
    {
      icon: "check",
      text: "Finish",
      label: "Finish this vessel's clicks",
      key: "Enter",
      id: "seed-finish",
      class: "button text",
    },
    () => void hand.finish(),
  );
  finish.hidden = true;
  store.watch(["tools.clicks"], ({ tools: { clicks } }) => {
    finish.disabled = clicks.length === 0;
  });
  const all = button(
    {
      icon: "play",
      text: "Track all",
      label: "Track all seeds that are placed",
      key: "T",
      id: "track-all",
      class: "button primary",
    },
    () => void app.perform({ op: "track", labels: null }),
  );
  store.watch(["document.state"], ({ document: { state } }) => {
    const waiting = state.seeds.filter(s => !s.tracked);
    all.disabled = waiting.length === 0 || state.job !== null || !state.has_volume;
    list.replaceChildren(...state.seeds.filter(s => !s.tracked).map(seed => seedRow(app, seed)));
    if (waiting.length === 0)
      list.append(
        h(
          "li",
          { class: "hint" },
          state.has_volume
            ? "No seeds wait. Choose “Seed” (S) and click in a vessel, in a slice or in the projection."
            : "Seeds need a volume: open one, or drop it here.",
        ),
      );
    const done = state.seeds.filter(s => s.tracked);
    tracked.hidden = done.length === 0;
    trackedCount.textContent =
      done.length === 1 ? "One seed was tracked" : `${done.length} seeds were tracked`;
    trackedList.replaceChildren(...done.map(seed => trackedRow(app, seed)));
    const labels = [
      ...new Set([
        ...state.seeds.map(s => s.label),
        ...(store.get().document.tree?.branches.map(b => b.label) ?? []),
      ]),
    ];
    parent.replaceChildren(
      h("option", { value: "" }, "Found by itself"),
      ...labels.map(label => h("option", { value: label }, label)),
    );
    parent.value = hand.parent !== null && labels.includes(hand.parent) ? hand.parent : "";
    if (parent.value === "") hand.parent = null;
  });
  return section(
    "section-seeds",
    "Seeds and tracking",
    true,
    h("label", { class: "line" }, "Clicks", kind),
    h("label", { class: "line" }, "Parent", parent),
    finish,
    list,
    tracked,
    h("div", { class: "row end" }, all),
  );
}

/** A seed that the case was tracked with. */
function trackedRow(app: Part<"slices">, seed: Seed): HTMLElement {
  return h(
    "li",
    { class: "row item" },
    link(seed.label, () => goTo(app, seed.points[0].position)),
    h("span", { class: "note" }, seed.points.length > 1 ? `${seed.points.length} clicks` : "one click"),
  );
}

function seedRow(app: Part<"document" | "slices", "perform">, seed: Seed): HTMLElement {
  const radius = seed.points[0]?.radius_mm ?? null,
    busy = app.store.get().document.state.job !== null;
  const track = button(
    { icon: "play", label: `Track ${seed.label}`, class: "button" },
    () => void app.perform({ op: "track", labels: [seed.label] }),
  );
  track.disabled = busy;
  return h(
    "li",
    { class: "row item" },
    link(seed.label, () => goTo(app, seed.points[0].position)),
    h(
      "span",
      { class: "note" },
      `${seed.kind === "aneurysm" ? "aneurysm, " : ""}${seed.points.length > 1 ? `${seed.points.length} clicks, ` : ""}${radius === null ? "no radius" : `r ${brief(radius)} mm`}`,
    ),
    track,
    button(
      { icon: "close", label: `Remove ${seed.label}`, class: "button" },
      () => void app.perform({ op: "seed_delete", label: seed.label }),
    ),
  );
}

function fileSection(app: Part<"document" | "tools", "source" | "perform">): HTMLElement {
  const list = h("ul", { class: "list", id: "file-list", "aria-label": "Open files" }),
    box = section("section-files", "Files", false, list);
  let hadSeries = false;
  app.store.watch(["document.state"], ({ document: { state } }) => {
    list.replaceChildren(
      ...state.files.map(file =>
        h(
          "li",
          { class: "row item" },
          h("span", { class: "filename", title: file.name }, file.name),
          h(
            "span",
            { class: file.changed ? "note changed" : "note" },
            file.changed ? "changed on disk" : file.kind === "second" ? "second volume" : file.kind,
          ),
          ...(file.changed && file.named
            ? [
                button(
                  { text: "Reload", label: `Read ${file.name} again`, class: "button text" },
                  () => void app.perform({ op: "reload", id: file.id }),
                ),
              ]
            : []),
          button(
            { icon: "close", label: `Close ${file.name}`, class: "button" },
            () => void app.perform({ op: "close_file", id: file.id }),
          ),
        ),
      ),
    );
    list.append(
      ...state.unsaved_before.map(({ name }) =>
        h(
          "li",
          { class: "row item" },
          h("span", { class: "filename", title: name }, name),
          h("span", { class: "note changed" }, "was not saved"),
          button(
            { text: "Take", label: `Take what ${name} holds`, class: "button text" },
            () => void app.perform({ op: "recover", name }),
          ),
          button({ icon: "trash", label: `Delete ${name}`, class: "button" }, () => void forget(app, name)),
        ),
      ),
    );
    if (state.series !== null && !hadSeries) box.open = true;
    hadSeries = state.series !== null;
    if (state.unsaved_before.length > 0 || state.files.some(file => file.changed)) box.open = true;
    if (state.series !== null)
      list.append(
        h(
          "li",
          { class: "row item" },
          h("span", { class: "filename" }, `Series of ${state.series.folder}`),
          button(
            {
              text: "Choose…",
              label: `Choose a series of ${state.series.folder}`,
              id: "series-again",
              class: "button text",
            },
            () => {
              app.store.set({ tools: { seriesAs: null } }); // another series may become another part
              openSeriesDialog(app);
            },
          ),
          button(
            { icon: "close", label: "Forget these series", class: "button" },
            () => void app.perform({ op: "close_series" }),
          ),
        ),
      );
    if (state.files.length === 0) list.append(h("li", { class: "hint" }, "No file is open."));
  });
  return box;
}

async function forget(app: Pick<App, "perform">, name: string): Promise<void> {
  if (await askYes("Delete the file?", `${name} holds the only copy of work that was not saved.`, "Delete"))
    await app.perform({ op: "forget", name });
}
