// SPDX-License-Identifier: Apache-2.0
/** The engine in a worker of this page, in the place of a server: files stay in this tab. */
import { Refused, type Answer, type OpenAs, type Received, type Source } from "./source";
import type { Event, Operation, VesselAtClick, State } from "../base/types";
import { saveBlob } from "../base/ui";
import { inOrder, nameOf } from "./named_files";
import type { Begin, Question, Told } from "./worker_talk";

const kMostMemory = 2 ** 32; // bytes that WebAssembly can address
const kMostName = 100; // letters of the name of a file of DICOM

interface Told200 {
  status: number;
  bytes: Uint8Array;
  fileName: string;
}

/** An address that is there until it is revoked. */
const newFlag = (): string => URL.createObjectURL(new globalThis.Blob([]));

export class WorkerSource implements Source {
  readonly live = true;
  readonly where = "Engine: this tab, no upload";
  readonly mostBytes: number;
  private readonly waiting = new Map<number, (told: Told200) => void>();
  private readonly stops = { job: newFlag(), surface: newFlag() };
  private listener: (event: Event) => void = () => undefined;
  private last = 0;
  private fault = "";
  private readonly opened: Promise<void>;

  /** Null where the document names no engine: there is a server. */
  static find(): WorkerSource | null {
    const link = document.querySelector<HTMLLinkElement>("link[rel=lumen-engine]");
    if (link === null) return null;
    // without one, as on a site without https, the page needs the network each time it is loaded
    void navigator.serviceWorker?.register("offline.js").catch(() => undefined);
    return new WorkerSource(new Worker("worker.js"), link);
  }

  private constructor(
    private readonly worker: Worker,
    link: HTMLLinkElement,
  ) {
    this.mostBytes = Number(link.dataset.mostBytes ?? kMostMemory);
    worker.addEventListener("message", ({ data }: MessageEvent<Told>) => this.hear(data));
    worker.addEventListener("error", e => this.stop(e.message));
    this.begin(link.href).catch((error: unknown) => this.stop(String(error)));
    this.opened = this.openNamed(new URLSearchParams(location.search).getAll("open"));
  }

  /** Opens the files that the page's own address names, ?open=ADDRESS, of the same origin, before anything is shown. */
  private async openNamed(addresses: string[]): Promise<void> {
    const names = addresses.map(address => ({ address, name: nameOf(address) }));
    for (const { address, name, as } of inOrder(names)) {
      const answer = await fetch(address);
      if (!answer.ok) throw new Error(`${name} cannot be fetched: the server answers ${answer.status}.`);
      const done = new Promise<void>((resolve, reject) => {
        this.listener = event => {
          if (event.type !== "done") return;
          if (event.ok) resolve();
          else reject(new Error(event.text));
        };
      });
      await this.ask(true, "file", { name, as, first: "1" }, await answer.blob());
      await done;
    }
  }

  private async begin(engine: string): Promise<void> {
    const files: Record<string, Uint8Array> = {},
      module = WebAssembly.compileStreaming(fetch(engine));
    for (const name of ["page.js", "page.css", "blob.wasm"]) files[name] = await this.file(name);
    const message: Begin = { engine: await module, files };
    this.worker.postMessage(message);
  }
  private async file(name: string): Promise<Uint8Array> {
    const answer = await fetch(name);
    if (!answer.ok) throw new Error(`${name} is missing beside the page (${answer.status}).`);
    return new Uint8Array(await answer.arrayBuffer());
  }

  private hear(told: Told): void {
    if (told.type === "fault") this.stop(told.text);
    else if (told.type === "event") {
      const value = JSON.parse(told.data) as Record<string, unknown>;
      this.listener(
        told.name === "state"
          ? { type: "state", state: value as unknown as State }
          : ({ type: told.name, ...value } as Event),
      );
    } else {
      this.waiting.get(told.id)?.(told);
      this.waiting.delete(told.id);
    }
  }
  private stop(text: string): void {
    this.fault = `The engine in this tab has stopped (${text}). Load the page again.`;
    for (const resolve of this.waiting.values())
      resolve({
        status: 500,
        bytes: new TextEncoder().encode(JSON.stringify({ error: this.fault })),
        fileName: "",
      });
    this.waiting.clear();
    this.listener({ type: "message", severity: "error", text: this.fault });
    this.listener({ type: "lost" });
  }

  /** Asks the worker, and lets it leave a surface that nobody waits for. Throws Refused. */
  private async ask(
    isPost: boolean,
    name: string,
    query: Record<string, string> = {},
    body: Question["body"] = null,
  ): Promise<Told200 | null> {
    if (this.fault !== "") throw new Refused(500, this.fault);
    this.renew("surface");
    const id = ++this.last,
      question: Question = {
        id,
        isPost,
        name,
        query: Object.entries(query),
        body,
        stops: { ...this.stops },
      };
    const told = await new Promise<Told200>(resolve => {
      this.waiting.set(id, resolve);
      this.worker.postMessage(question);
    });
    if (told.status === 404) return null;
    if (told.status >= 400) {
      const { error } = JSON.parse(new TextDecoder().decode(told.bytes)) as { error: string };
      throw new Refused(told.status, error);
    }
    return told;
  }
  private renew(stop: keyof Question["stops"]): void {
    URL.revokeObjectURL(this.stops[stop]);
    this.stops[stop] = newFlag();
  }
  private async json(...question: Parameters<WorkerSource["ask"]>): Promise<unknown> {
    const told = await this.ask(...question);
    if (told === null) throw new Refused(404, `The engine has no answer to ${question[1]}.`);
    return JSON.parse(new TextDecoder().decode(told.bytes));
  }

  async state(): Promise<State> {
    await this.opened;
    return (await this.json(false, "state")) as State;
  }
  async bytes(
    name: string,
    query: Record<string, string> = {},
    received?: Received,
    signal?: AbortSignal,
  ): Promise<Uint8Array | null> {
    if (name === "blob.wasm") return this.file(name);
    const told = await this.ask(false, name, query);
    signal?.throwIfAborted();
    if (told !== null) received?.(told.bytes, told.bytes.length);
    return told?.bytes ?? null;
  }
  listen(listener: (event: Event) => void): void {
    this.listener = listener;
  }
  async perform(operation: Operation, revision: number): Promise<Answer> {
    return (await this.json(true, "do", {}, JSON.stringify({ ...operation, revision }))) as Answer;
  }
  async vesselAtClick(position: number[]): Promise<VesselAtClick> {
    return (await this.json(true, "vessel_at_click", {}, JSON.stringify({ position }))) as VesselAtClick;
  }
  async open(name: string, as: OpenAs, file: globalThis.Blob): Promise<void> {
    await this.ask(true, "file", { name, as }, file);
  }
  async sendSeriesFile(batch: number, file: File): Promise<void> {
    await this.ask(
      true,
      "series_file",
      { batch: String(batch), name: file.name.slice(-kMostName) || "file" },
      file,
    );
  }
  async cancel(): Promise<void> {
    this.renew("job");
    await this.ask(false, "state"); // the worker learns the next address
  }
  async download(format: string, options: Record<string, string> = {}): Promise<void> {
    const told = await this.ask(false, "save", { format, ...options });
    if (told === null) throw new Refused(404, `There is nothing to save as ${format}.`);
    saveBlob(told.fileName, new globalThis.Blob([told.bytes as BlobPart]));
  }
}
