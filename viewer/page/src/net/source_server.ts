// SPDX-License-Identifier: Apache-2.0
/** The server that this page came from; all addresses are relative to the page's own, which holds the token. */
import { Refused, type Answer, type OpenAs, type Received, type Source } from "./source";
import type { Event, Operation, VesselAtClick, State } from "../base/types";
import { h } from "../base/ui";

const kMostName = 100; // letters of the name of a file of DICOM
const kSilence = 2000; // ms without an answer after which the server counts as gone and is asked again

function withQuery(path: string, query: Record<string, string>): string {
  const text = new URLSearchParams(query).toString();
  return text === "" ? path : `${path}?${text}`;
}

async function refusal(response: Response): Promise<Refused> {
  let text = `The server answered ${response.status}.`;
  try {
    text = ((await response.json()) as { error?: string }).error ?? text;
  } catch {
    /* no sentence came: the number has to do */
  }
  return new Refused(response.status, text);
}

/** Reads a body into one buffer of the announced length, telling what has arrived. */
async function receive(response: Response, received?: Received): Promise<Uint8Array> {
  const announced = Number(response.headers.get("Content-Length") ?? 0);
  if (received === undefined || response.body === null || !(announced > 0))
    return new Uint8Array(await response.arrayBuffer());
  const bytes = new Uint8Array(announced),
    reader = response.body.getReader();
  let size = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (size + value.length > announced) throw new Error("The server sent more than it announced.");
    bytes.set(value, size);
    size += value.length;
    received(bytes, size);
  }
  if (size < announced) throw new Error("The server stopped in the middle of an answer.");
  return bytes;
}

export class ServerSource implements Source {
  readonly live = true;
  readonly where = "Engine: lumen view";
  readonly mostBytes = null;

  async state(): Promise<State> {
    const response = await fetch("state", { cache: "no-store" });
    if (!response.ok) throw await refusal(response);
    return (await response.json()) as State;
  }

  async bytes(
    name: string,
    query: Record<string, string> = {},
    received?: Received,
    signal?: AbortSignal,
  ): Promise<Uint8Array | null> {
    const response = await fetch(withQuery(name, query), { signal });
    if (response.status === 404) return null;
    if (!response.ok) throw await refusal(response);
    return receive(response, received);
  }

  listen(listener: (event: Event) => void): void {
    const events = new EventSource("events");
    let lost = 0;
    const parse = (e: MessageEvent): Record<string, unknown> =>
      JSON.parse(String(e.data)) as Record<string, unknown>;
    events.addEventListener("open", () => {
      window.clearTimeout(lost);
      listener({ type: "back" });
    });
    events.addEventListener("error", () => {
      window.clearTimeout(lost);
      lost = window.setTimeout(() => listener({ type: "lost" }), kSilence);
    });
    events.addEventListener("state", e => listener({ type: "state", state: parse(e) as unknown as State }));
    for (const type of ["progress", "message", "done"] as const)
      events.addEventListener(type, e => listener({ type, ...parse(e) } as Event));
  }

  private async post(
    path: string,
    body: BodyInit,
    type = "application/json",
  ): Promise<Record<string, unknown>> {
    const response = await fetch(path, { method: "POST", body, headers: { "Content-Type": type } });
    if (!response.ok) throw await refusal(response);
    const text = await response.text();
    return text === "" ? {} : (JSON.parse(text) as Record<string, unknown>);
  }

  perform(operation: Operation, revision: number): Promise<Answer> {
    return this.post("do", JSON.stringify({ ...operation, revision }));
  }
  async vesselAtClick(position: number[]): Promise<VesselAtClick> {
    return (await this.post("vessel_at_click", JSON.stringify({ position }))) as unknown as VesselAtClick;
  }
  async open(name: string, as: OpenAs, file: globalThis.Blob): Promise<void> {
    await this.post(withQuery("file", { name, as }), file, "application/octet-stream");
  }
  async sendSeriesFile(batch: number, file: File): Promise<void> {
    const query = { batch: String(batch), name: file.name.slice(-kMostName) || "file" };
    await this.post(withQuery("series_file", query), file, "application/octet-stream");
  }
  async cancel(job: number): Promise<void> {
    await this.post("cancel", JSON.stringify({ job }));
  }
  download(format: string, options: Record<string, string> = {}): Promise<void> {
    const link = h("a", { href: withQuery("save", { format, ...options }), download: "" });
    document.body.append(link);
    link.click();
    link.remove();
    return Promise.resolve();
  }
}
