// SPDX-License-Identifier: Apache-2.0

/** Addresses of the files that the frame loads. */
export interface PageFiles {
  script: string;
  style: string;
  wasm: string;
}

/** <lumen-case src="head.lumen" layout="scene" panels="none" theme="dark">. */
export class LumenCase extends HTMLElement {
  /** Set by the module to the files beside it; may be set to others before an element is shown. */
  static files: PageFiles | null;
  /** A case (.lumen), or a page that `lumen view --html` has written. */
  src: string;
}

export interface LumenCaseEventMap {
  /** The case is shown. */
  ready: CustomEvent<null>;
  /** Nothing can be shown: the detail is a sentence for people. */
  error: CustomEvent<string>;
}

declare global {
  interface HTMLElementTagNameMap {
    "lumen-case": LumenCase;
  }
}
