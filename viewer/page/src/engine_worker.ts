// SPDX-License-Identifier: Apache-2.0
/** The worker in the place of the server: it answers the page's requests with lumen-view.wasm, one after the other, and does what
 * the session has to do while none waits. */
import { Instance } from "../../../packages/npm/engine/instance.mjs";
import type { Begin, Question, Told } from "./net/worker_talk";

const kQuiet = 20; // ms without a request before work begins: an event is often followed by some

const queue: Question[] = [];
let instance: Instance | null = null,
  stops: Question["stops"] | null = null,
  isPumping = false;

function tell(told: Told, transfer: Transferable[] = []): void {
  (self as unknown as Worker).postMessage(told, transfer);
}

/** Whether the page has given an address up. The page cannot reach a worker that works, but the worker can ask for an address. */
function isGone(address: string | undefined): boolean {
  if (address === undefined) return false;
  try {
    const request = new XMLHttpRequest();
    request.open("GET", address, false);
    request.send();
    return false;
  } catch {
    return true;
  }
}

function withText<T>(engine: Instance, text: string, use: (at: number) => T): T {
  const at = engine.putText(text);
  try {
    return use(at);
  } finally {
    engine.free(at);
  }
}

async function begin({ engine, files }: Begin): Promise<void> {
  const made: Instance = await Instance.create(
    engine,
    {},
    {
      event: (name: number, data: number) =>
        tell({ type: "event", name: made.text(name), data: made.text(data) }),
      is_job_stopped: () => Number(isGone(stops?.job)),
      is_surface_stopped: () => Number(isGone(stops?.surface)),
    },
  );
  for (const [name, bytes] of Object.entries(files)) {
    const at = made.put(bytes);
    withText(made, name, text => made.call("lumen_view_add_file", text, at, bytes.length));
    made.free(at);
  }
  instance = made;
  await pump();
}

/** Copies a body into the module, a part at a time. */
async function putBody(engine: Instance, body: globalThis.Blob): Promise<boolean> {
  const kPart = 1 << 24; // bytes
  const at = engine.call("lumen_view_make_body", body.size);
  if (at === 0) return false;
  for (let done = 0; done < body.size; done += kPart)
    engine.write(at + done, new Uint8Array(await body.slice(done, done + kPart).arrayBuffer()));
  return true;
}

function readAnswer(engine: Instance): Uint8Array {
  const bytes = new Uint8Array(engine.call("lumen_view_size"));
  for (let at = 0; at < bytes.length; ) {
    const length = engine.call("lumen_view_read", at);
    bytes.set(engine.bytes(engine.call("lumen_view_piece"), length), at);
    at += length;
  }
  return bytes;
}

async function answer(engine: Instance, { id, isPost, name, query, body }: Question): Promise<void> {
  withText(engine, name, text => engine.call("lumen_view_begin", Number(isPost), text));
  for (const [word, value] of query)
    withText(engine, word, a => withText(engine, value, b => engine.call("lumen_view_add_query", a, b)));
  const isTaken =
    body === null || (await putBody(engine, typeof body === "string" ? new Blob([body]) : body));
  if (!isTaken) {
    const text = JSON.stringify({
      error: "there is not enough memory for this file in a tab of the browser",
    });
    tell({ type: "answer", id, status: 400, bytes: new TextEncoder().encode(text), fileName: "" });
    return;
  }
  const status = engine.call("lumen_view_ask"),
    bytes = readAnswer(engine),
    fileName = engine.text(engine.call("lumen_view_file_name"));
  engine.call("lumen_view_end");
  tell({ type: "answer", id, status, bytes, fileName }, [bytes.buffer]);
}

const pause = (ms: number): Promise<void> => new Promise(resolve => setTimeout(resolve, ms));

/** Answers what waits, and works while nothing does. */
async function pump(): Promise<void> {
  if (isPumping || instance === null) return;
  isPumping = true;
  try {
    for (;;) {
      for (let next = queue.shift(); next !== undefined; next = queue.shift()) await answer(instance, next);
      await pause(kQuiet);
      if (queue.length === 0 && instance.call("lumen_view_work") === 0) break;
    }
  } catch (error) {
    tell({ type: "fault", text: error instanceof Error ? error.message : String(error) });
    return; // the module takes no more calls
  }
  isPumping = false;
}

self.addEventListener("message", ({ data }: MessageEvent<Begin | Question>) => {
  if ("engine" in data) {
    begin(data).catch((error: unknown) => tell({ type: "fault", text: String(error) }));
    return;
  }
  queue.push(data);
  stops = data.stops;
  void pump();
});
