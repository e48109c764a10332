// SPDX-License-Identifier: Apache-2.0
/** Work that an earlier program did not save: the page asks, in the middle, before anything else is done. */
import type { Part } from "../model/model";
import type { State, UnsavedFile } from "../base/types";
import { choose } from "../base/ui";

const kChoices = [
  { value: "forget", label: "Delete it" },
  { value: "recover", label: "Take it" },
] as const;

/** A sentence on a file: where it comes from, when it was written, and whether the case is newer. */
export function aboutUnsaved(file: UnsavedFile, saveAs: string | null): string {
  const written = new Date(file.written_ms).toLocaleString(),
    beside =
      saveAs === null
        ? ""
        : file.newer
          ? `, after ${saveAs}`
          : `; ${saveAs} has been written since and is newer`;
  return `${file.name} holds work of an earlier program that was not saved. It was written on ${written}${beside}. “Files” keeps it until you decide.`;
}

/** Asks once for each file, when the page first hears of it. */
export function offerUnsaved(app: Part<"document", "source" | "perform">): void {
  if (!app.source.live) return;
  const asked = new Set<string>();
  let asking = false;
  const ask = async ({ unsaved_before: unsavedBefore, save_as: saveAs }: State): Promise<void> => {
    const file = unsavedBefore.find(each => !asked.has(each.name));
    if (asking || file === undefined) return;
    asking = true;
    asked.add(file.name);
    const answer = await choose("Take up unsaved work?", aboutUnsaved(file, saveAs), kChoices);
    if (answer !== null) await app.perform({ op: answer, name: file.name });
    asking = false;
    await ask(app.store.get().document.state);
  };
  app.store.watch(["document.state"], ({ document: { state } }) => void ask(state));
}
