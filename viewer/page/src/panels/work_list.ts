// SPDX-License-Identifier: Apache-2.0
/** The check as a list of work: every place with what to do, walked through by keys, until nothing is left. */
import type { CursorPart, Part } from "../model/model";
import { goTo, goToNode } from "../model/selection";
import type { IgnoredPlace, Operation, State, WorkItem, WorkKind } from "../base/types";
import { askText, button, h, link, mm, replaceRows, section } from "../base/ui";
import { countKinds, kWorkTitles, remediesOf, requestOf, type Remedy } from "../case/work_items";

const kRemedyWords: Record<Remedy, { text: string; icon: string; label: string; changes: boolean }> = {
  track: { text: "Track", icon: "play", label: "Track the vessel from here", changes: false },
  cut: { text: "Cut", icon: "cut", label: "Cut the vessel here", changes: true },
  join: { text: "Join", icon: "check", label: "Join it to the nearest vessel", changes: true },
  delete: { text: "Delete", icon: "trash", label: "Delete the vessel", changes: true },
};

/** Acts on places and proposals, for buttons and keys alike. */
export class WorkList {
  /** Number, among proposals and items, of what was settled by a key or button: the walk goes on from there; or -1. */
  private settled = -1;

  constructor(private readonly app: CursorPart<never, "inform" | "perform">) {
    app.store.watch(["document.state"], () => this.goOn());
  }

  /** The number of what was shown last among proposals and items, or -1. */
  private get at(): number {
    const {
        document: { state },
        selection: { place, proposal },
      } = this.app.store.get(),
      proposed = state.proposals.findIndex(p => p.label === proposal),
      listed = (state.work?.items ?? []).findIndex(item => item.id === place);
    return proposed >= 0 ? proposed : listed >= 0 ? state.proposals.length + listed : -1;
  }

  /** Shows what has come to the place of what was settled, once that has left the list. */
  private goOn(): void {
    const { state } = this.app.store.get().document,
      total = state.proposals.length + (state.work?.items.length ?? 0);
    if (this.settled < 0 || state.job !== null || this.at >= 0) return;
    const next = Math.min(this.settled, total - 1);
    this.settled = -1;
    if (next >= 0) this.showNumber(next);
  }

  private showNumber(number: number): void {
    const { state } = this.app.store.get().document;
    if (number >= state.proposals.length) {
      this.show(state.work!.items[number - state.proposals.length]);
      return;
    }
    const proposal = state.proposals[number];
    this.settled = -1;
    this.app.store.set({ selection: { proposal: proposal.label, place: null } });
    goTo(this.app, proposal.position);
  }

  /** Performs what settles the thing that was shown last, or something else, after which the walk stays. */
  private async settle(operation: Operation, isShown: boolean): Promise<void> {
    const { at } = this;
    if (!(await this.app.perform(operation)) || !isShown) return;
    this.settled = at;
    this.goOn();
  }

  /** The item that was shown last and is left, or undefined. */
  private get current(): WorkItem | undefined {
    const {
      document: { state },
      selection: { place },
    } = this.app.store.get();
    return state.work?.items.find(item => item.id === place);
  }

  /** The label of the proposal that was shown last and waits, or undefined. */
  private get proposed(): string | undefined {
    const {
      document: { state },
      selection: { proposal },
    } = this.app.store.get();
    return state.proposals.find(each => each.label === proposal)?.label;
  }

  /** Shows a place in every view. */
  show(item: WorkItem): void {
    const { store } = this.app;
    this.settled = -1;
    if (item.missing === null) goToNode(this.app, item.node);
    goTo(this.app, item.position);
    store.set({ selection: { place: item.id, proposal: null } });
  }

  /** Goes to the next (1) or the one before (-1): proposals first, then places; round at the ends. */
  walk(by: 1 | -1): boolean {
    const { state } = this.app.store.get().document,
      total = state.proposals.length + (state.work?.items.length ?? 0);
    if (total === 0) {
      this.app.inform(
        state.work === null
          ? "There is no list yet: find vessels (Shift+F) or check (K)."
          : "Nothing is left.",
      );
      return true;
    }
    const at = this.at >= 0 || by < 0 ? Math.max(this.at, 0) : -1;
    this.showNumber((at + by + total) % total);
    return true;
  }

  /** The likeliest remedy for what was shown last. */
  accept(): boolean {
    const proposal = this.proposed,
      item = this.current;
    if (proposal !== undefined) void this.settle({ op: "accept", labels: [proposal] }, true);
    else if (item !== undefined) void this.act(item, remediesOf(item)[0]);
    else return false;
    return true;
  }
  /** Rejects or ignores what was shown last. */
  dismiss(): boolean {
    const proposal = this.proposed,
      item = this.current;
    if (proposal !== undefined) void this.settle({ op: "reject", labels: [proposal] }, true);
    else if (item !== undefined) void this.ignore(item);
    else return false;
    return true;
  }

  /** A remedy that changes a vessel acts only on a place that the views show: elsewhere the first press goes there. */
  async act(item: WorkItem, remedy: Remedy | undefined): Promise<void> {
    if (remedy === undefined) return;
    const {
      document: { state, tree },
      selection: { place },
    } = this.app.store.get();
    if (kRemedyWords[remedy].changes && place !== item.id) {
      this.show(item);
      this.app.inform(
        `The views show the place now: once more ${remedy === "cut" ? "cuts" : `${remedy}s`}.`,
        "warning",
      );
      return;
    }
    const request = requestOf(remedy, item, state, tree);
    if (request === null) this.app.inform("There is no other tree to join it to.", "warning");
    else await this.settle(request, place === item.id);
  }

  async ignore(item: WorkItem): Promise<void> {
    const reason = (await askText("Ignore this place", "Reason, which the case keeps", ""))?.trim();
    if (reason === undefined || reason === "") return;
    await this.settle(
      { op: "ignore", item: item.id, reason },
      this.app.store.get().selection.place === item.id,
    );
  }
}

const kMostShown = 20; // places of a kind that are listed without being asked for

function sentence(state: State): string {
  const { check, work } = state,
    wall = check?.wall?.offset_mm;
  if (check === null || work === null)
    return "Lists all that check and reachability find: missing vessels, early ends, dark, blocked and loose places, walls off the volume's edges.";
  const left = work.items.length === 0 ? "Nothing is left" : countKinds(work.items);
  return `${left}; the wall is off the edge by ${mm(wall?.median)} (median), ${mm(wall?.p90_absolute)} (90 %).${
    state.check_is_old ? " The case has changed since: check again." : ""
  }`;
}

export function checkSection(
  app: Part<"document" | "selection" | "slices", "perform">,
  work: WorkList,
): HTMLElement {
  const { store } = app,
    list = h("ul", { class: "list proposals", id: "work-list", "aria-label": "Places to look at" }),
    about = h("p", { class: "hint", id: "check-about", role: "status" }),
    bar = h("progress", { id: "work-done", "aria-label": "Places that are done" }),
    done = h("span", { class: "note", id: "work-count" }),
    progress = h("div", { class: "row", id: "work-progress" }, bar, done),
    set = h("ul", { class: "list", id: "ignored-list", "aria-label": "Ignored places" }),
    ignored = h("details", { id: "ignored" }, h("summary", { class: "hint" }, "Ignored"), set);
  const opened = new Map<WorkKind, boolean>(); // by hand
  const fill = (items: readonly WorkItem[]): void => {
    const rows: HTMLElement[] = [];
    for (const kind of Object.keys(kWorkTitles) as WorkKind[]) {
      const own = items.filter(item => item.kind === kind),
        isOpen = opened.get(kind) ?? own.length <= kMostShown;
      if (own.length === 0) continue;
      rows.push(
        kindRow(own, isOpen, () => {
          opened.set(kind, !isOpen);
          fill(store.get().document.state.work?.items ?? []);
        }),
        ...own
          .filter(item => isOpen || item.id === store.get().selection.place)
          .map(item => workRow(app, work, item)),
      );
    }
    replaceRows(list, rows);
  };
  const run = button(
    {
      icon: "check",
      text: "Check",
      label: "Compare the case with its volume",
      key: "K",
      id: "check",
      class: "button text",
    },
    () => void app.perform({ op: "check" }),
  );
  const step = (id: string, text: string, label: string, key: string, by: 1 | -1): HTMLButtonElement =>
    button({ id, text, label, key, class: "button text" }, () => void work.walk(by));
  const before = step("work-before", "Before", "Show the place before", ",", -1),
    next = step("work-next", "Next", "Show the next place", ".", 1);
  store.watch(["document.state"], ({ document: { state } }) => {
    const items = state.work?.items ?? [],
      found = state.work?.found ?? 0;
    run.disabled = !state.has_case || !state.has_volume || state.job !== null;
    about.textContent = sentence(state);
    progress.hidden = found === 0;
    list.hidden = items.length === 0;
    before.hidden = next.hidden = items.length + state.proposals.length === 0;
    bar.max = Math.max(found, 1);
    bar.value = found - items.length;
    done.textContent = `${found - items.length} of ${found} done`;
    fill(items);
    const places = state.work?.ignored ?? [];
    ignored.hidden = places.length === 0;
    ignored.querySelector("summary")!.textContent = `Ignored: ${places.length}`;
    set.replaceChildren(...places.map((place, i) => ignoredRow(app, place, i)));
  });
  store.watch(["selection.place"], ({ document: { state }, selection: { place } }) => {
    if (place !== null && list.querySelector(`#work-${place}`) === null) fill(state.work?.items ?? []);
    for (const row of list.children) {
      const isChosen = place !== null && row.id === `work-${place}`;
      row.classList.toggle("chosen", isChosen);
      if (isChosen) row.scrollIntoView({ block: "nearest" });
    }
  });
  return section(
    "section-check",
    "Check",
    true,
    about,
    progress,
    list,
    ignored,
    h("div", { class: "row end" }, before, next, run),
  );
}

/** The head of the places of one kind, with their number, which shows or hides them. */
function kindRow(items: readonly WorkItem[], isOpen: boolean, toggle: () => void): HTMLElement {
  return h(
    "li",
    { class: "row kindrow", "data-group": items[0].kind },
    h(
      "button",
      { type: "button", class: "link kind", "aria-expanded": String(isOpen), onclick: toggle },
      countKinds(items),
    ),
  );
}

function workRow(app: Part<"document" | "selection">, work: WorkList, item: WorkItem): HTMLElement {
  const {
      document: { state },
      selection: { place },
    } = app.store.get(),
    words = `${item.about.charAt(0).toUpperCase()}${item.about.slice(1)}`,
    acts = remediesOf(item).map(remedy =>
      button(
        {
          icon: kRemedyWords[remedy].icon,
          label: `${kRemedyWords[remedy].label}: ${item.about}`,
          class: `button ${remedy}`,
        },
        () => void work.act(item, remedy),
      ),
    );
  const ignore = button(
    { icon: "close", label: `Ignore, with a reason: ${item.about}`, class: "button ignore" },
    () => void work.ignore(item),
  );
  for (const each of [...acts, ignore]) each.disabled = state.job !== null;
  return h(
    "li",
    {
      class: place === item.id ? "row item chosen" : "row item",
      id: `work-${item.id}`,
      "data-kind": item.kind,
    },
    h(
      "div",
      { class: "what" },
      h(
        "button",
        { type: "button", class: "link about", title: "Show it", onclick: () => work.show(item) },
        words,
      ),
    ),
    ...acts,
    ignore,
  );
}

function ignoredRow(app: Part<"slices", "perform">, place: IgnoredPlace, index: number): HTMLElement {
  return h(
    "li",
    { class: "row item" },
    link(kWorkTitles[place.kind]?.[0] ?? place.kind, () => goTo(app, place.position)),
    h("span", { class: "note", title: place.reason }, place.reason),
    button(
      { icon: "undo", label: `Stop ignoring it: ${place.reason}`, class: "button" },
      () => void app.perform({ op: "unignore", ignored: index }),
    ),
  );
}
