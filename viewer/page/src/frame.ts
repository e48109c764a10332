// SPDX-License-Identifier: Apache-2.0
/** The inner side of <lumen-case src>: the page in its frame learns what to show, and reports when it is shown. */
import type { CaseFrame, Framed } from "./lumen_case";
import { kLayouts, type View } from "./model/model";
import type { Source } from "./net/source";
import { openFile } from "./net/source_file";
import type { Store } from "./base/store";

export class Frame {
  private constructor(
    private readonly element: CaseFrame,
    private readonly framed: Framed,
  ) {}

  /** Null if the page is in no frame of a <lumen-case> of the same origin. */
  static find(): Frame | null {
    let element: CaseFrame | null = null;
    try {
      element = window.frameElement as CaseFrame | null;
    } catch {
      return null; // the frame is of another origin
    }
    const framed = element?.lumenCase;
    return element === null || framed === undefined ? null : new Frame(element, framed);
  }

  source(): Promise<Source> {
    return openFile(this.framed.src, this.framed.wasm);
  }

  /** The layout and panels that the element asks for; a case alone begins as one view without panels. */
  applyView(store: Store<View>): void {
    const { layout, panels } = this.framed,
      open = panels !== null && panels !== "none";
    store.set({
      page: {
        layout: kLayouts.find(each => each === layout) ?? "scene",
        panels: { left: open && panels !== "right", right: open && panels !== "left" },
        strip: open,
      },
    });
  }

  ready(store: Store<View>): void {
    const { theme } = this.framed;
    if (theme === "light" || theme === "dark") store.set({ page: { theme } });
    this.element.dispatchEvent(new CustomEvent("lumen-ready"));
  }
  fail(text: string): void {
    this.element.dispatchEvent(new CustomEvent("lumen-error", { detail: text }));
  }
}
