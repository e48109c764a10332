// SPDX-License-Identifier: Apache-2.0
/** Service worker of the page without a server: keeps the files of the page, and hands them out where the network has none. A file
 * from the network comes first, so that no page runs with files of two versions. */

const kCache = "lumen-page",
  kFiles = ["./", "page.js", "page.css", "worker.js", "blob.wasm", "lumen-view.wasm"];

/** The events of a service worker, whose types are not among those of a page. */
interface LifeEvent extends Event {
  waitUntil(work: Promise<unknown>): void;
}
interface FetchEvent extends LifeEvent {
  request: Request;
  respondWith(answer: Promise<Response>): void;
}
const scope = self as unknown as {
  skipWaiting(): Promise<void>;
  clients: { claim(): Promise<void> };
  addEventListener(type: "install" | "activate", listener: (event: LifeEvent) => void): void;
  addEventListener(type: "fetch", listener: (event: FetchEvent) => void): void;
};

async function keepAll(): Promise<void> {
  await (await caches.open(kCache)).addAll(kFiles);
  await scope.skipWaiting();
}

async function answer(request: Request): Promise<Response> {
  const cache = await caches.open(kCache);
  try {
    const answer = await fetch(request);
    if (answer.ok) await cache.put(request, answer.clone());
    return answer;
  } catch (error) {
    const kept = await cache.match(request, { ignoreSearch: true });
    if (kept !== undefined) return kept;
    throw error;
  }
}

/** Whether it is one of the page's own files. */
function isOwn(address: string): boolean {
  const { origin, pathname } = new URL(address);
  return kFiles.some(file => {
    const own = new URL(file, location.href);
    return own.origin === origin && own.pathname === pathname;
  });
}

scope.addEventListener("install", event => event.waitUntil(keepAll()));
scope.addEventListener("activate", event => event.waitUntil(scope.clients.claim()));
scope.addEventListener("fetch", event => {
  if (event.request.method === "GET" && isOwn(event.request.url)) event.respondWith(answer(event.request));
});
