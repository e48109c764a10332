// SPDX-License-Identifier: Apache-2.0
// Slabs: a slice shows the brightest through a thickness, and a click takes what is drawn.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { frames, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { lookAt, placeIn } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const position = async page =>
  (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number);

/** How bright the picture of the axial slice is. */
async function brightness(page) {
  const { data } = await pixels(page, "#view-axial");
  let sum = 0;
  for (let i = 0; i < data.length; i += 4) sum += data[i];
  return sum / (data.length / 4);
}

story("a slab shows the vessel beside the plane, and a click in it takes that vessel", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "tube", file("volume.nrrd"), "--seeds", file("seeds.json"));
  const [x, y, z] = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches[0].points[0].position;
  const server = await view(t, file("volume.nrrd")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await lookAt(page, [x, y, z]);
  await page.locator("#view-coronal").focus();
  for (let i = 0; i < 15; ++i) await page.keyboard.press("Shift+PageUp"); // away from the tube
  await page.mouse.move(2, 300);
  await frames(page, 3);
  const away = await position(page);
  await picture(page, "12-plane-beside-the-tube");
  const at = await placeIn(page, "coronal", [x, away[1], z]); // in a slab, the line shows what is drawn

  assert.ok(await page.locator("#slab-coronal-mm").isHidden());
  await page.keyboard.press("7");
  assert.equal(await page.locator("#slab-coronal").inputValue(), "max");
  assert.equal(await page.locator("#slab-axial").inputValue(), "off", "each slice has its own");
  for (let i = 0; i < 8; ++i) await page.keyboard.press("9");
  assert.ok(Number(await page.locator("#slab-coronal-mm").inputValue()) > 2 * Math.abs(away[1] - y));
  await picture(page, "12-slab-shows-the-tube");
  await page.keyboard.press("n");
  await page.mouse.click(at.x, at.y);
  await page.mouse.move(2, 300);
  await frames(page, 3);
  const taken = await position(page);
  assert.ok(
    Math.abs(taken[1] - y) < 1.5,
    `the click at depth ${away[1]} took ${taken[1]}, the tube is at ${y}`,
  );
  await picture(page, "12-click-took-the-tube");

  await page.keyboard.press("0");
  await page.locator("#view-scene").focus();
  const plane = await brightness(page);
  await page.locator("#slab-axial").selectOption("max");
  const most = await brightness(page);
  await page.locator("#slab-axial").selectOption("mean");
  const mean = await brightness(page);
  await page.locator("#slab-axial").selectOption("min");
  const least = await brightness(page);
  assert.ok(most > plane && most > mean && mean > least, `${most} > ${mean} > ${least}; plane ${plane}`);
  await page.locator("#view-scene").focus();
  await page.keyboard.press("7");
  for (const name of ["axial", "coronal", "sagittal"])
    assert.equal(await page.locator(`#slab-${name}`).inputValue(), "mean", "outside of a slice, all follow");
  await picture(page, "12-all-mean");
  await page.waitForTimeout(600); // until the page has kept it
  await page.reload();
  await settled(page);
  await page.locator("#slab-axial").filter({ visible: true }).waitFor();
  assert.equal(await page.locator("#slab-axial").inputValue(), "mean", "the view is kept");
});

story("a seed is placed on the vessel that a slab shows", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "tube", file("volume.nrrd"), "--seeds", file("seeds.json"));
  const [x, y, z] = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches[0].points[0].position;
  const server = await view(t, file("volume.nrrd")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await lookAt(page, [x, y, z]);
  await page.locator("#view-coronal").focus();
  for (let i = 0; i < 15; ++i) await page.keyboard.press("Shift+PageUp");
  await page.mouse.move(2, 300);
  await frames(page, 3);
  const at = await placeIn(page, "coronal", [x, (await position(page))[1], z]);
  await page.keyboard.press("7");
  for (let i = 0; i < 8; ++i) await page.keyboard.press("9");
  await page.keyboard.press("s");
  await page.mouse.click(at.x, at.y);
  const link = page.locator("#seed-list .item .link").first();
  await link.waitFor();
  await link.click();
  await page.mouse.move(2, 300);
  await frames(page, 3);
  const placed = await position(page);
  assert.ok(Math.abs(placed[1] - y) < 0.5 && Math.abs(placed[0] - x) < 0.5, `placed at ${placed}`);
  await picture(page, "12-seed-in-a-slab");
});
