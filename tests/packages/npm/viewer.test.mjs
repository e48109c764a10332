// SPDX-License-Identifier: Apache-2.0
// <lumen-case> on somebody's page: a case alone, a page of lumen view, and files that cannot be shown.
import assert from "node:assert/strict";
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { frames, picture, startBrowser, story } from "../../../viewer/page/people/browser.mjs";
import { lumen } from "../../../viewer/page/people/lumen.mjs";
import { installed, kCase, kRoot, served } from "./made.mjs";

// the policy of a careful site, as README.md of the package asks for it
const kPolicy =
  "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; connect-src 'self'; frame-src 'self'; img-src data: blob:";

function writePage(folder, body) {
  writeFileSync(
    join(folder, "index.html"),
    `<!doctype html><html lang="en"><meta charset="utf-8"><title>A site</title><link rel="icon" href="data:,">
<style>body { font: 16px serif; margin: 2rem; background: #fffbe8; } button { color: red; } lumen-case { height: 26rem; margin: 1rem 0; }</style>
<script type="module" src="/node_modules/@lumen/viewer/index.js"></script><script type="module" src="/site.js"></script>
<h1>Two vessels</h1>${body}</html>\n`,
  );
  writeFileSync(
    join(folder, "site.js"),
    `window.heard = [];
for (const element of document.querySelectorAll("lumen-case"))
  for (const name of ["ready", "error"]) element.addEventListener(name, e => window.heard.push([element.id, name, e.detail]));\n`,
  );
}

async function open(t, folder) {
  const address = await served(t, folder, kPolicy),
    browser = await startBrowser(t),
    page = await browser.newPage({ viewport: { width: 1000, height: 1100 } }),
    mistakes = [];
  t.pages.push(page);
  page.on("pageerror", error => mistakes.push(String(error)));
  page.on("console", message => {
    if (message.type() === "error" && !/404/.test(message.text())) mistakes.push(message.text());
  });
  await page.goto(address + "index.html");
  return { page, mistakes, address };
}

/** Pixels of a frame's canvas that are neither its ground nor dark. */
const coloured = frame =>
  frame.locator("canvas.stage").evaluate(canvas => {
    const gl = canvas.getContext("webgl2"),
      data = new Uint8Array(4 * canvas.width * canvas.height);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, data);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (Math.max(data[i], data[i + 1], data[i + 2]) > 90) ++count;
    return count;
  });

/** The page's own reading of a case and its surface, and libblob, as one module for Node. */
async function pageCode(folder) {
  const page = join(kRoot, "viewer/page"),
    { build } = createRequire(join(page, "build.mjs"))("esbuild"),
    outfile = join(folder, "code.mjs"),
    contents = ["./src/case/case_file", "./src/case/field_surface", "./src/case/pack", "./src/case/tree", "../../libblob/wasm/blob.mjs"]
      .map(name => `export * from "${name}";`)
      .join("\n");
  await build({ stdin: { contents, resolveDir: page }, bundle: true, format: "esm", platform: "node", outfile, logLevel: "error" });
  return import(pathToFileURL(outfile).href);
}

/** Numbers of triangles at the edges, each once. */
function trianglesAtEdges(triangle) {
  const edges = new Map();
  for (let t = 0; t < triangle.length; t += 3)
    for (const [i, j] of [
      [0, 1],
      [1, 2],
      [2, 0],
    ]) {
      const [a, b] = [triangle[t + i], triangle[t + j]].sort((x, y) => x - y);
      edges.set(`${a} ${b}`, (edges.get(`${a} ${b}`) ?? 0) + 1);
    }
  return new Set(edges.values());
}

test("the surface of a case is closed, lies on the wall, and faces outwards", async t => {
  const { folder } = installed(t),
    code = await pageCode(folder),
    file = new Uint8Array(readFileSync(kCase)),
    model = (await code.load(readFileSync(join(folder, "node_modules/@lumen/viewer/blob.wasm")))).open(file),
    pack = new code.Pack(code.surfacePack(model, new code.Tree(new code.Pack(code.packOfCase(file))))),
    [position, normal, triangle] = [pack.get("position", "f32"), pack.get("normal", "f32"), pack.get("triangle", "u32")],
    count = position.length / 3;
  assert.ok(count > 3000, `${count} vertices`);
  assert.deepEqual(trianglesAtEdges(triangle), new Set([2]), "each edge has two triangles");
  const batch = model.batch(count);
  batch.points.set(position);
  batch.query(code.Flags.DISTANCE_EXACT);
  const off = Array.from(batch.distances(), Math.abs).sort((a, b) => a - b);
  assert.ok(off[Math.floor(0.99 * count)] < 1e-4 && off[count - 1] < 0.05, `${off[Math.floor(0.99 * count)]}, ${off[count - 1]} mm off the wall`);
  batch.points.set(position.map((x, i) => x + 0.1 * normal[i]));
  batch.query();
  assert.ok(batch.distances().filter(x => x > 0).length > 0.98 * count, "normals point out of the lumen");
});

story("a case alone and a page of lumen view stand on one page, apart from it and from one another", async t => {
  const { folder } = installed(t);
  copyFileSync(kCase, join(folder, "fork.lumen"));
  lumen("view", kCase, "--html", join(folder, "page.html"));
  writePage(
    folder,
    '<button>Mine</button><lumen-case id="case" src="fork.lumen" theme="dark"></lumen-case><lumen-case id="page" src="page.html" panels="left" theme="light"></lumen-case>',
  );
  const { page, mistakes } = await open(t, folder);
  const inner = id => page.locator(`#${id} iframe`).contentFrame();
  await inner("case").locator("body[data-surface=quick]").waitFor();
  await inner("page").locator("body[data-surface=closed]").waitFor();
  for (const id of ["case", "page"]) {
    await inner(id).locator("body[data-ready]").waitFor();
    await frames(page, 6);
    assert.ok((await coloured(inner(id))) > 2000, `${id}: nothing is drawn`);
    assert.deepEqual(await inner(id).locator("#tree-list .name").allTextContents(), ["root", "b01"], id);
  }
  const figures = id => inner(id).locator("#tree-list .number").allTextContents();
  assert.equal((await figures("case")).length, 6);
  assert.deepEqual(await figures("case"), await figures("page"), "lengths and radii are those of the server");
  await picture(page, "npm-viewer");
  assert.deepEqual((await page.evaluate(() => window.heard)).map(([id, name]) => `${id} ${name}`).sort(), ["case ready", "page ready"]);
  assert.equal(await inner("page").locator(":root").getAttribute("data-theme"), "light");
  assert.equal(await inner("case").locator(":root").getAttribute("data-theme"), "dark");
  assert.equal(await page.locator("button").first().evaluate(b => getComputedStyle(b).color), "rgb(255, 0, 0)");
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), undefined, "the outer page is left alone");
  assert.deepEqual(mistakes, []);
});

story("a pointer on the surface that a browser makes is on the wall", async t => {
  const { folder } = installed(t);
  copyFileSync(kCase, join(folder, "fork.lumen"));
  writePage(folder, '<lumen-case id="case" src="fork.lumen" panels="both" layout="four"></lumen-case>');
  const { page } = await open(t, folder);
  const inner = page.locator("#case iframe").contentFrame();
  await inner.locator("body[data-surface=quick]").waitFor();
  await frames(page, 6);
  await inner.locator("#tree-list .name").first().click();
  const scene = await inner.locator("#view-scene").boundingBox();
  let least = Infinity;
  for (let v = 0.15; v < 0.9; v += 0.03)
    for (const u of [0.4, 0.5, 0.6]) {
      await page.mouse.move(scene.x + u * scene.width, scene.y + v * scene.height);
      await frames(page, 2);
      if ((await inner.locator("#view-scene.over-vessel").count()) === 0) continue;
      least = Math.min(least, Math.abs(Number(await inner.locator("#probe-distance").getAttribute("data-mm"))));
    }
  await picture(page, "npm-viewer-four");
  assert.ok(least < 0.02, `the nearest picked point of the surface is ${least} mm from the wall`);
});

story("what cannot be shown is an event with a sentence, and another address shows again", async t => {
  const { folder } = installed(t);
  copyFileSync(kCase, join(folder, "fork.lumen"));
  copyFileSync(join(kCase, "../packed.lumen"), join(folder, "packed.lumen"));
  writeFileSync(join(folder, "text.html"), "<p>nothing of lumen</p>");
  writePage(folder, ["none.lumen", "packed.lumen", "text.html"].map((src, i) => `<lumen-case id="x${i}" src="${src}"></lumen-case>`).join(""));
  const { page } = await open(t, folder);
  await page.waitForFunction(() => window.heard.length === 3);
  const heard = (await page.evaluate(() => window.heard)).sort();
  for (const [i, word] of ["404", "compressed", "neither a case"].entries()) {
    assert.deepEqual(heard[i].slice(0, 2), [`x${i}`, "error"]);
    assert.match(heard[i][2], new RegExp(word));
  }
  await picture(page, "npm-viewer-errors");
  await page.evaluate(() => (document.querySelector("#x0").src = "fork.lumen"));
  await page.locator("#x0 iframe").contentFrame().locator("body[data-surface=quick]").waitFor();
});
