// SPDX-License-Identifier: Apache-2.0
/** <lumen-case src="head.lumen">: a case on somebody's page, in a frame of its own, so that styles, keys and names of neither side
 * reach the other. The frame holds the very page of lumen view. */

/** Files beside the module, as addresses. */
export interface PageFiles {
  script: string;
  style: string;
  wasm: string;
}

/** Settings that the page inside reads of its element; see frame.ts. */
export interface Framed {
  /** Absolute. */
  src: string;
  wasm: string;
  layout: string | null;
  panels: string | null;
  theme: string | null;
}

/** An iframe with what its page is to show. */
export interface CaseFrame extends HTMLIFrameElement {
  lumenCase?: Framed;
}

const kStyle =
  ":host { display: block; min-height: 20rem; } :host([hidden]) { display: none; }" +
  " iframe { display: block; width: 100%; height: 100%; min-height: inherit; border: 0; }";

/** Events: `ready`, once the case is shown; `error`, a CustomEvent whose detail is a sentence. */
export class LumenCase extends HTMLElement {
  static observedAttributes = ["src", "layout", "panels", "theme"];
  /** Set once, by the module that defines the element. */
  static files: PageFiles | null = null;
  private frame: CaseFrame | null = null;

  connectedCallback(): void {
    this.show();
  }
  disconnectedCallback(): void {
    this.frame?.remove();
    this.frame = null;
  }
  attributeChangedCallback(_name: string, before: string | null, now: string | null): void {
    if (this.isConnected && before !== now) this.show();
  }

  get src(): string {
    return this.getAttribute("src") ?? "";
  }
  set src(address: string) {
    this.setAttribute("src", address);
  }

  /** Shows `src` anew; nothing without one. */
  protected show(): void {
    this.frame?.remove();
    this.frame = null;
    const { files } = LumenCase;
    if (this.src === "" || files === null) return;
    const frame: CaseFrame = document.createElement("iframe");
    frame.title = this.getAttribute("aria-label") ?? "Vessels, in lumen's viewer";
    frame.lumenCase = {
      src: new URL(this.src, document.baseURI).href,
      wasm: files.wasm,
      layout: this.getAttribute("layout"),
      panels: this.getAttribute("panels"),
      theme: this.getAttribute("theme"),
    };
    for (const name of ["ready", "error"])
      frame.addEventListener(`lumen-${name}`, e =>
        this.dispatchEvent(new CustomEvent(name, { detail: (e as CustomEvent<unknown>).detail })),
      );
    frame.srcdoc = documentOf(files);
    this.root().append(frame);
    this.frame = frame;
  }

  private root(): ShadowRoot {
    if (this.shadowRoot !== null) return this.shadowRoot;
    const root = this.attachShadow({ mode: "open" }),
      style = document.createElement("style");
    style.textContent = kStyle;
    root.append(style);
    return root;
  }
}

const attribute = (text: string): string => text.replaceAll("&", "&amp;").replaceAll('"', "&quot;");

/** The page of lumen view, as index.html has it, with its files at their addresses. */
function documentOf({ script, style }: PageFiles): string {
  return (
    '<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">' +
    `<title>lumen</title><link rel="icon" href="data:,"><link rel="stylesheet" href="${attribute(style)}">` +
    `<script src="${attribute(script)}" defer></script></head><body><lumen-case></lumen-case></body></html>`
  );
}
