// SPDX-License-Identifier: Apache-2.0
// The page in Firefox: opening, probing, a cut with views that follow, dropped DICOM, folding panels, a wall put right by hand.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  chord,
  count,
  dropFiles,
  keep,
  openInFirefox,
  placeIn,
  settle,
  text,
  untilText,
} from "./firefox.mjs";
import { phantom } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";
import { dicomSlices, readNrrd } from "./make_dicom.mjs";

const rows = "#tree-list [role=treeitem]";

test("a case is opened, probed and cut where the views show it, and its panels fold", async t => {
  const file = makeFolder();
  phantom(file, "bifurcation", { "vessels.lumen": 1 });
  const { address } = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openInFirefox(t, address);
  await page.waitForSelector(rows);
  await settle(page);
  await keep(page, "firefox-open");
  const light = await page.evaluate(() => {
    const gl = document.querySelector("canvas.stage").getContext("webgl2"),
      { width, height } = gl.canvas,
      bytes = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return bytes.filter((value, i) => i % 4 === 0 && value > 120).length;
  });
  assert.ok(light > 500, `${light} light pixels of slices and scene`);

  // the list leads every view to the vessel; the pointer in the middle of a slice is then in the lumen
  await page.click(`${rows} .name`);
  await settle(page);
  const box = await (await page.$("#view-axial")).boundingBox();
  const there = (await page.$eval("#probe-position", e => e.dataset.mm)).split(" ").map(Number);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await settle(page);
  const pointed = (await page.$eval("#probe-position", e => e.dataset.mm)).split(" ").map(Number);
  assert.ok(pointed.every(Number.isFinite) && there.every(Number.isFinite));
  assert.ok(Math.abs(pointed[2] - there[2]) < 0.01, "the axial slice is at the height of the cursor");
  await keep(page, "firefox-probe");

  const before = await count(page, rows);
  await chord(page, "Shift", "X");
  await page.waitForFunction((where, n) => document.querySelectorAll(where).length > n, {}, rows, before);
  await settle(page);
  await keep(page, "firefox-cut");
  await chord(page, "Control", "z");
  await page.waitForFunction((where, n) => document.querySelectorAll(where).length === n, {}, rows, before);

  const wide = (await (await page.$("#views")).boundingBox()).width;
  await page.click("#fold-left");
  await page.click("#fold-right");
  await settle(page);
  const folded = (await (await page.$("#views")).boundingBox()).width;
  assert.ok(folded > wide + 300, `${wide} pixels of views before, ${folded} with folded panels`);
  await keep(page, "firefox-folded");
});

test("DICOM is dropped and one of two series chosen", async t => {
  const file = makeFolder();
  lumen("phantom", "bifurcation", file("volume.nrrd"), "--size", "64");
  const volume = readNrrd(file("volume.nrrd")),
    files = [
      ...dicomSlices(volume, { uid: "1.2.3.1", description: "Angiogram" }),
      ...dicomSlices(volume, { uid: "1.2.3.2", description: "Overview", every: 4 }),
    ];
  const { address } = await view(t),
    page = await openInFirefox(t, address);
  await dropFiles(
    page,
    files.map(({ name, bytes }, i) => ({ name: `${i}-${name}`, bytes })),
  );
  await page.waitForSelector("#series-dialog .series");
  await keep(page, "firefox-series");
  assert.equal(await count(page, "#series-dialog .series"), 2);
  await page.click("#series-dialog .series");
  await untilText(page, "#volume-about", /Angiogram: 64 × 64 × 64 voxels/);
  await settle(page);
  assert.equal(await text(page, "#title"), "Angiogram");
  await keep(page, "firefox-dicom");
});

test("the wall is pulled by the brush, and put back", async t => {
  const file = makeFolder();
  phantom(file, "bifurcation", { "vessels.lumen": 1 });
  const { address } = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openInFirefox(t, address);
  await page.waitForSelector(rows);
  await page.click(`${rows} .name`, { count: 2 });
  await untilText(page, "#edit-name", /cursor at node/);
  await settle(page);
  await page.mouse.move(2, 300);
  await settle(page);
  const radius = async () =>
    Number((await text(page, "#strip .striphead .note")).match(/radius ([\d.]+) mm/)[1]);
  const node = (await page.$eval("#probe-position", e => e.dataset.mm)).split(" ").map(Number),
    before = await radius(),
    at = mm => placeIn(page, "axial", [node[0], node[1] + mm, node[2]]);
  await page.keyboard.press("e");
  const from = await at(before),
    to = await at(1.5 * before);
  await page.mouse.move(from.x, from.y);
  await settle(page);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 5 });
  await page.mouse.up();
  await page.waitForSelector("#undo:enabled");
  await settle(page);
  await keep(page, "firefox-brush");
  await page.click(`${rows} .name`);
  await settle(page);
  assert.ok((await radius()) > 1.03 * before, `${before} became ${await radius()}`);
  await chord(page, "Control", "z");
  await page.waitForSelector("#undo:disabled");
  await settle(page);
  assert.equal(await radius(), before);
});
