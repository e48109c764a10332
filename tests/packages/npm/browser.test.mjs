// SPDX-License-Identifier: Apache-2.0
// @lumen/blob in a page and in a worker of the page.
import { copyFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { startBrowser } from "../../../viewer/page/people/browser.mjs";
import { expectedDistances, installed, kAsk, kCase, near, served } from "./made.mjs";

test("a page and its worker have the same answers", async t => {
  const { folder } = installed(t),
    { places, distances } = expectedDistances(process.env.LUMEN, folder);
  copyFileSync(kCase, join(folder, "fork.lumen"));
  writeFileSync(join(folder, "ask.mjs"), kAsk);
  const get = 'new Uint8Array(await (await fetch("/fork.lumen")).arrayBuffer())';
  writeFileSync(
    join(folder, "worker.mjs"),
    `import * as blob from "/node_modules/@lumen/blob/index.mjs";
import { ask } from "/ask.mjs";
onmessage = async ({ data }) => postMessage(await ask(blob, ${get}, data));\n`,
  );
  writeFileSync(
    join(folder, "page.html"),
    `<!doctype html><title>blob</title><link rel="icon" href="data:,">
<script type="importmap">{"imports": {"@lumen/blob": "/node_modules/@lumen/blob/index.mjs"}}</script>
<script type="module">
import * as blob from "@lumen/blob";
import { ask } from "/ask.mjs";
window.asked = async places => {
  const worker = new Worker("/worker.mjs", { type: "module" });
  worker.postMessage(places);
  const ofWorker = new Promise((resolve, reject) => { worker.onmessage = e => resolve(e.data); worker.onerror = e => reject(new Error(e.message)); });
  return [await ask(blob, ${get}, places), await ofWorker];
};
</script>\n`,
  );
  const address = await served(t, folder),
    browser = await startBrowser(t),
    page = await browser.newPage();
  await page.goto(`${address}page.html`);
  await page.waitForFunction(() => window.asked !== undefined);
  const [own, ofWorker] = await page.evaluate(p => window.asked(p), places);
  near(own, distances, "a page");
  near(ofWorker, distances, "a worker");
});
