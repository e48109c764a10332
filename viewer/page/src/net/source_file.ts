// SPDX-License-Identifier: Apache-2.0
/** A file at an address as the page's source: a case, or a page that `lumen view --html` has written. */
import { load } from "../../../../libblob/wasm/blob.mjs";
import { isCaseFile, packOfCase } from "../case/case_file";
import { surfacePack } from "../case/field_surface";
import { Pack } from "../case/pack";
import { nameOf } from "./named_files";
import type { Source } from "./source";
import { embeddedToday } from "./old_page";
import { EmbeddedSource, type Embedded } from "./source_embedded";
import { Tree } from "../case/tree";

async function fetched(address: string): Promise<Uint8Array> {
  const answer = await fetch(address);
  if (!answer.ok)
    throw new Error(`${nameOf(address)} cannot be fetched: the server answers ${answer.status}.`);
  return new Uint8Array(await answer.arrayBuffer());
}

/** The parts of a case's bytes that the page asks for. */
function embeddedCase(title: string, file: Uint8Array, wasm: () => Promise<Uint8Array>): Embedded {
  const pack = packOfCase(file),
    tree = new Tree(new Pack(pack));
  const parts: Embedded["parts"] = {
    case: () => Promise.resolve(pack.slice()),
    "case.lumen": () => Promise.resolve(file),
    "blob.wasm": wasm,
  };
  if (tree.hasModels)
    parts.surface = async () => {
      const model = (await load((await wasm()) as BufferSource)).open(file);
      try {
        return surfacePack(model, tree);
      } finally {
        model.close();
      }
    };
  return {
    state: { title, has_case: true, revisions: { case: 1, surface: 1, volume: 0, seeds: 0 } },
    parts,
  };
}

/** The data that a page of `lumen view --html` embeds; its scripts do not run. */
function embeddedInPage(text: string): Embedded {
  const found = new DOMParser().parseFromString(text, "text/html").getElementById("lumen-embedded");
  if (found === null)
    throw new Error("The file is neither a case (.lumen) nor a page that lumen view --html has written.");
  return embeddedToday(JSON.parse(found.textContent) as Embedded);
}

/** Fetches `address`, whose content decides its kind. Throws with a sentence for people. */
export async function openFile(address: string, wasm: string): Promise<Source> {
  const bytes = await fetched(address);
  let library: Promise<Uint8Array> | null = null;
  const askWasm = (): Promise<Uint8Array> => (library ??= fetched(wasm));
  const embedded = isCaseFile(bytes)
    ? embeddedCase(nameOf(address), bytes, askWasm)
    : embeddedInPage(new TextDecoder().decode(bytes));
  return new EmbeddedSource(embedded);
}
