// SPDX-License-Identifier: Apache-2.0
/** The cases of a folder: a list with search, of which one is open. */
import type { Part } from "../model/model";
import { Refused } from "../net/source";
import type { Library, LibraryCase } from "../base/types";
import { askYes, errorText, h, mm, section } from "../base/ui";

/** What these functions take of the page. */
type Needs = Part<"document", "source" | "inform" | "perform">;

/** The cases whose names hold every word of what is searched for, with their places in the library. */
export function found(cases: LibraryCase[], wanted: string): [number, LibraryCase][] {
  const words = wanted
    .toLowerCase()
    .split(/\s+/)
    .filter(word => word !== "");
  return cases
    .map((each, index): [number, LibraryCase] => [index, each])
    .filter(([, each]) => words.every(word => each.name.toLowerCase().includes(word)));
}

export function libraryPanel(app: Needs): HTMLElement[] {
  if (!app.source.live) return [];
  const list = h("ul", { class: "list", id: "library-list", "aria-label": "Cases" }),
    count = h("p", { class: "hint", id: "library-count", role: "status" });
  const search = h("input", {
    type: "search",
    id: "library-search",
    placeholder: "Search cases",
    "aria-label": "Search cases",
    title: "Search cases",
  });
  const box = section(
    "section-library",
    "Library",
    true,
    h("div", { class: "row filters" }, search),
    count,
    list,
  );
  let library: Library | null = null,
    seen = 0;
  const fill = (): void => {
    const { state } = app.store.get().document,
      cases = library?.cases ?? [],
      shown = found(cases, search.value);
    box.hidden = library === null;
    count.textContent =
      shown.length === cases.length
        ? `${library?.name ?? ""}: ${cases.length} cases`
        : `${shown.length} of ${cases.length} cases`;
    list.replaceChildren(
      ...shown.map(([index, each]) => row(app, each, index, index === state.open_case, state.job !== null)),
    );
  };
  const fetchIt = async (): Promise<void> => {
    const bytes = await app.source.bytes("library");
    library = bytes === null ? null : (JSON.parse(new TextDecoder().decode(bytes)) as Library);
    fill();
  };
  search.addEventListener("input", fill);
  box.hidden = true;
  app.store.watch(["document.state"], ({ document: { state } }) => {
    const now = state.revisions.library ?? 0;
    if (now === seen) {
      if (library !== null) fill();
      return;
    }
    seen = now;
    void fetchIt().catch((error: unknown) =>
      app.inform(`The library could not be read: ${errorText(error)}`, "error"),
    );
  });
  return [box];
}

function row(app: Needs, each: LibraryCase, index: number, isOpen: boolean, busy: boolean): HTMLElement {
  const about =
    each.error !== null
      ? "cannot be read"
      : each.branches === null
        ? "…"
        : `${each.branches} vessels, ${mm(each.length_mm)}`;
  return h(
    "li",
    { class: "row item" },
    h(
      "button",
      {
        type: "button",
        class: "link",
        title: each.error ?? `Open ${each.name}`,
        disabled: busy || each.error !== null,
        "aria-current": isOpen ? "true" : undefined,
        onclick: () => void openCase(app, index),
      },
      each.name,
    ),
    h("span", { class: each.error !== null ? "note changed" : "note" }, isOpen ? `open, ${about}` : about),
  );
}

/** Opens a case; asks first where changes of the one that is open are not saved. */
async function openCase(app: Needs, index: number): Promise<void> {
  const { source, store, inform } = app;
  try {
    await source.perform({ op: "open_case", index }, store.get().document.state.revision);
  } catch (error) {
    const text = errorText(error);
    if (!(error instanceof Refused) || error.status !== 409 || !store.get().document.state.unsaved) {
      inform(text, "error");
      return;
    }
    if (
      await askYes(
        "Leave this case?",
        "It has changes that are not saved. They will lie beside it, as NAME.unsaved.lumen, and be offered when it is opened again.",
        "Leave it",
      )
    )
      await app.perform({ op: "open_case", index, force: true });
  }
}
