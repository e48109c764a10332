// SPDX-License-Identifier: Apache-2.0
/** Messages between the page and the worker that has the engine. */

/** To the worker, once: the engine as WebAssembly, and the files of the page, which a page as one file holds. */
export interface Begin {
  engine: WebAssembly.Module;
  files: Record<string, Uint8Array>;
}

/** To the worker: a request as to the server (viewer/README.md). */
export interface Question {
  id: number;
  isPost: boolean;
  name: string;
  query: [string, string][];
  body: globalThis.Blob | string | null;
  /** Addresses that stand for questions to a worker that is at work and hears nothing: one that is gone is a yes. */
  stops: { job: string; surface: string };
}

/** From the worker: what it answers, as HTTP would, and events; `fault` is why it will answer no more. */
export type Told =
  | { type: "answer"; id: number; status: number; bytes: Uint8Array; fileName: string }
  | { type: "event"; name: string; data: string }
  | { type: "fault"; text: string };
