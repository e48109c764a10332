// SPDX-License-Identifier: Apache-2.0
// A case that lacks a vessel is checked, completed by the list of places, compared with the truth and measured.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { find, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { away, checkCase, crosshair, drop, phantom, step, type, undo, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const kShift = 0.5; // mm, by which the mesh is beside its case

const rows = (page, kind) =>
    page.locator(`#work-list .item${kind === undefined ? "" : `[data-kind="${kind}"]`}`),
  missing = page => page.locator("#work-list .item.row:is([data-kind=missing], [data-kind=early-end])"),
  pink = (r, g, b) => r > 150 && r > 1.5 * g && b > 1.05 * g && r > 1.3 * b, // the mark of such a place, lit and shaded
  isBlue = (r, g, b) => b > 70 && b > 1.6 * r,
  isRed = (r, g, b) => r > 70 && r > 1.6 * b;

/** The loose piece is joined by a key, the missing vessel tracked from its ring, and the rest ignored for a reason. */
async function walkThrough(page) {
  await page.locator("#tree-list [role=treeitem]").first().click();
  await settled(page);
  await step(page, () => page.keyboard.press("Shift+X")); // a piece that hangs on nothing
  await checkCase(page);
  assert.equal(await rows(page, "loose").count(), 1, "the piece behind the cut");
  const places = await missing(page).count();
  assert.ok(places > 0, "the second vessel");

  const remove = page.locator("#work-list .item[data-kind=loose] .button.delete");
  await remove.click();
  await page.locator(".toast").filter({ hasText: "once more deletes" }).waitFor();
  assert.equal((await vessels(page)).length, 2, "nothing is deleted before its place is shown");
  const chosen = page.locator("#work-list .item.chosen");
  assert.equal(await chosen.getAttribute("data-kind"), "loose");
  await page.keyboard.press("y");
  await rows(page, "loose").waitFor({ state: "detached" });
  await settled(page);

  for (let k = 0; k < places && (await chosen.and(missing(page)).count()) === 0; ++k) {
    await page.keyboard.press(".");
    await chosen.waitFor();
  }
  const box = await page.locator("#view-scene").boundingBox(),
    { at, count } = find(await pixels(page, "#view-scene"), pink);
  assert.ok(count > 20, `${count} pixels of the mark`);
  await picture(page, "checked-places");
  for (let k = 0; k < 2; ++k) {
    await page.mouse.click(box.x + at.x, box.y + at.y);
    await page.locator("#seed-list .item").first().waitFor();
  }
  assert.equal(
    await page.locator("#seed-list .item").count(),
    1,
    "a second click on a ring places no second seed",
  );
  const before = (await vessels(page)).length;
  await step(page, () => page.locator("#track-all").click());
  assert.ok((await vessels(page)).length > before);
  assert.ok((await missing(page).count()) < places, "the vessel has answered its place");

  await undo(page); // a vessel is missing again: it is ignored, with all else
  for (let left = await rows(page).count(); left > 0; left = await rows(page).count()) {
    await page.keyboard.press(".");
    await chosen.waitFor();
    await page.keyboard.press("i");
    await type(page, "a vein, by its late contrast");
    await page.waitForFunction(n => document.querySelectorAll("#work-list .item").length < n, left);
  }
  await page.locator("#check-about").filter({ hasText: "Nothing is left" }).waitFor();
  await page.locator("#ignored summary").click();
  const kept = await page.locator("#ignored-list .item").count();
  assert.ok(kept > 0);
  await page.locator("#ignored-list .item .button").first().click();
  await page.waitForFunction(n => document.querySelectorAll("#ignored-list .item").length < n, kept);
}

/** The colours and figures of a mesh beside the case, and of the truth. */
async function compare(page, mesh) {
  await drop(page, "moved.obj", mesh);
  await page.locator(".mesh", { hasText: "moved.obj" }).waitFor();
  await settled(page);
  await page.keyboard.press("3"); // 3D alone
  await page.locator(".mesh", { hasText: "moved.obj" }).getByLabel("Colour by deviation").check();
  const output = page.locator(".mesh", { hasText: "moved.obj" }).locator(".deviation");
  await output.filter({ hasText: /^median / }).waitFor();
  const [median, most] = (await output.textContent()).match(/[\d.]+(?= mm)/g).map(Number);
  assert.ok(median > 0.1 && most > median && most <= kShift + 0.05, `median ${median}, 90 % ${most}`);
  const legend = page.locator("#deviation-legend"),
    ends = (await legend.locator(".ends span").allTextContents()).map(Number);
  assert.ok(ends[0] === -ends[2] && ends[1] === 0, String(ends));
  await settled(page);
  const shown = await pixels(page, "#view-scene"),
    blue = find(shown, isBlue),
    red = find(shown, isRed);
  await picture(page, "checked-deviation");
  assert.ok(blue.count > 200 && red.count > 200, `${blue.count} pixels are blue and ${red.count} red`);
  // seen from the front, the patient's left (greater x, where the mesh was moved to) is on the right
  assert.ok(red.at.x > blue.at.x, `red at ${red.at.x}, blue at ${blue.at.x}`);

  await page.locator("#section-compare > summary").click();
  await page.locator("#compare").click();
  await page.locator("#figures dt", { hasText: "Overlap" }).waitFor();
  const missed = page.locator("#figures dt", { hasText: "Missed" }).locator("+ dd");
  assert.ok(parseFloat(await missed.textContent()) > 1, "the second vessel");
  await page.keyboard.press("1");
}

/** A click on a number of the measures goes to its place. */
async function measure(page, file) {
  const [measured] = lumen("measure", file("one.lumen")).cases;
  if ((await page.locator("#section-geometry[open]").count()) === 0)
    await page.locator("#section-geometry > summary").click();
  await page.locator("#geometry-run").click();
  const list = page.locator("#geometry-list .item");
  await list.first().waitFor();
  await settled(page);
  assert.equal(await list.count(), measured.vessels.length);
  await list.first().locator("button").click();
  const narrowest = page.locator("#geometry-figures .item[data-column=smallest_radius_mm]");
  await narrowest.locator("button").click();
  await settled(page);
  const place = measured.vessels[0].smallest_radius_place_mm;
  assert.ok(away(await crosshair(page), place) < 0.01, "its narrowest place");
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.locator("#geometry-csv").click(),
  ]);
  const table = readFileSync(await download.path(), "utf8")
    .trim()
    .split("\n");
  assert.equal(table.length, 1 + measured.vessels.length);
  assert.match(table[0], /^case,vessel,/);
}

story("a case is checked, its places are decided, and it is compared and measured", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  phantom(file, "bifurcation", { "one.lumen": 1, "both.lumen": 2 }, "--size", "64");
  lumen("convert", file("one.lumen"), file("moved.obj"));
  const obj = readFileSync(file("moved.obj"), "utf8");
  writeFileSync(
    file("moved.obj"),
    obj.replaceAll(/^v (\S+)/gm, (_, x) => `v ${(Number(x) + kShift).toFixed(6)}`),
  );
  const names = ["volume.nrrd", "one.lumen", "both.lumen"],
    server = await view(t, ...names.map(file)),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await measure(page, file);
  await walkThrough(page);
  await compare(page, readFileSync(file("moved.obj")));
});
