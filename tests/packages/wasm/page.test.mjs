// SPDX-License-Identifier: Apache-2.0
// lumen-vascular in a worker of a page, without a server but that of files. run.mjs has the environment.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { startBrowser } from "../../../viewer/page/people/browser.mjs";
import { served } from "../npm/made.mjs";

const kPolicy = "default-src 'self'; script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'; img-src data:";

test("a worker of a page finds the vessels that the program finds, and reports its stages", async t => {
  const folder = mkdtempSync(join(tmpdir(), "lumen-wasm-page-"));
  t.after(() => rmSync(folder, { recursive: true }));
  const at = name => join(folder, name);
  writeFileSync(at("package.json"), '{ "private": true, "type": "module" }');
  execFileSync("npm", ["install", "--offline", "--no-audit", "--no-fund", "--silent", process.env.LUMEN_ARCHIVE], { cwd: folder });
  execFileSync(process.env.LUMEN, ["phantom", "bifurcation", at("fork.nrrd"), "--size", "64", "--voxel", "0.4", "--quiet"]);
  execFileSync(process.env.LUMEN, ["convert", at("fork.nrrd"), at("fork.lumen.json"), "--quiet"]);
  writeFileSync(
    at("worker.mjs"),
    `import { caseOf } from "/node_modules/lumen-vascular/index.mjs";
onmessage = async ({ data }) => {
  try {
    const stages = [];
    const made = await caseOf(data, { name: "fork.nrrd", onStage: name => stages.push(name) });
    postMessage({ stages, names: made.branches.map(b => b.name), glb: made.encode("glb").length });
  } catch (error) {
    postMessage({ error: String(error) });
  }
};\n`,
  );
  writeFileSync(
    at("page.html"),
    `<!doctype html><title>lumen</title><link rel="icon" href="data:,">
<script type="module">
window.found = async () => {
  const worker = new Worker("/worker.mjs", { type: "module" });
  worker.postMessage(new Uint8Array(await (await fetch("/fork.nrrd")).arrayBuffer()));
  return new Promise((resolve, reject) => { worker.onmessage = e => resolve(e.data); worker.onerror = e => reject(new Error(e.message)); });
};
</script>\n`,
  );
  const address = await served(t, folder, kPolicy),
    browser = await startBrowser(t),
    page = await browser.newPage();
  await page.goto(`${address}page.html`);
  await page.waitForFunction(() => window.found !== undefined);
  const { error, stages, names, glb } = await page.evaluate(() => window.found());
  assert.equal(error, undefined);
  const { branches } = JSON.parse(readFileSync(at("fork.lumen.json"), "utf8")).tree;
  assert.deepEqual(names, branches.map(b => b.label ?? b.name));
  assert.ok(stages.includes("track") && glb > 1000, `${stages}, ${glb} bytes`);
});
