// SPDX-License-Identifier: Apache-2.0
/** The page as one file: <script type="application/json" id="lumen-embedded"> holds {"state", "parts": {name: base64 of what zlib has compressed}}. */
import { Refused, type Answer, type Received, type Source } from "./source";
import { kEmptyState, type Event, type VesselAtClick, type State } from "../base/types";

/** Bytes of base64, without the limits of atob on one long string. Throws on what is no base64. */
export function fromBase64(text: string): Uint8Array {
  const clean = /\s/.test(text) ? text.replace(/\s+/g, "") : text,
    kStep = 1 << 20; // characters, a multiple of 4
  const padding = clean.endsWith("==") ? 2 : clean.endsWith("=") ? 1 : 0;
  const bytes = new Uint8Array((clean.length / 4) * 3 - padding);
  for (let at = 0, out = 0; at < clean.length; at += kStep) {
    const part = atob(clean.slice(at, at + kStep));
    for (let i = 0; i < part.length; ++i) bytes[out++] = part.charCodeAt(i);
  }
  return bytes;
}

export async function inflated(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new globalThis.Blob([bytes as BufferSource])
    .stream()
    .pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Base64 of what zlib has compressed, or the bytes themselves, once they are asked for. */
type Part = string | (() => Promise<Uint8Array>);

export interface Embedded {
  state: Partial<State>;
  parts: Record<string, Part>;
}

export class EmbeddedSource implements Source {
  readonly live = false;
  readonly where = "One file, without a server";
  readonly mostBytes = null;
  private readonly state0: Partial<State>;
  private readonly parts: Map<string, Part>;

  /** Null if nothing is embedded: there is a server. */
  static find(): EmbeddedSource | null {
    const text = document.getElementById("lumen-embedded")?.textContent ?? "";
    return text === "" ? null : new EmbeddedSource(JSON.parse(text) as Embedded);
  }
  constructor(embedded: Embedded) {
    this.state0 = embedded.state;
    this.parts = new Map(Object.entries(embedded.parts));
  }

  state(): Promise<State> {
    return Promise.resolve({ ...kEmptyState, ...this.state0 });
  }
  async bytes(
    name: string,
    query: Record<string, string> = {},
    received?: Received,
  ): Promise<Uint8Array | null> {
    const key = "id" in query ? `${name}?id=${query.id}` : name,
      part = this.parts.get(key);
    if (part === undefined) return null;
    const bytes = typeof part === "string" ? await inflated(fromBase64(part)) : await part();
    if (name === "volume") this.parts.delete(key); // it is asked for once, and is large
    received?.(bytes, bytes.length);
    return bytes;
  }
  listen(listener: (event: Event) => void): void {
    void listener;
  }
  perform(): Promise<Answer> {
    return Promise.reject(new Refused(404, "This page is one file: nothing in it can be edited."));
  }
  vesselAtClick(): Promise<VesselAtClick> {
    return Promise.resolve({ found: false, position: [0, 0, 0], radius_mm: 0, direction: [0, 0, 1] });
  }
  open(): Promise<void> {
    return Promise.reject(new Refused(404, "This page is one file: open others with lumen view."));
  }
  sendSeriesFile(): Promise<void> {
    return this.open();
  }
  cancel(): Promise<void> {
    return Promise.resolve();
  }
  download(): Promise<void> {
    return this.open();
  }
}
