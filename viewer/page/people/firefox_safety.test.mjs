// SPDX-License-Identifier: Apache-2.0
// The page in Firefox: a volume of another patient, seeds that wait, an orientation in doubt, walls put right by hand.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { test } from "node:test";
import { chord, dropFiles, keep, openInFirefox, placeIn, settle, text, untilText } from "./firefox.mjs";
import { firstVessel, kissing } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const rows = "#tree-list [role=treeitem]";

/** Puts the crosshair on a place, mm, and a seed there, by keys alone. */
async function seedAt(page, place) {
  await page.keyboard.press("j");
  await page.waitForSelector("#ask-text");
  await chord(page, "Control", "a");
  await page.keyboard.type(place.join(" "));
  await page.keyboard.press("Enter");
  await page.waitForSelector("#ask-text", { hidden: true });
  await settle(page);
  await page.focus("#view-axial");
  await page.keyboard.press("s");
  await page.keyboard.press(" ");
  await page.waitForSelector("#seed-list .item");
}

test("a volume of another patient is not tracked into the case without an answer", async t => {
  const file = makeFolder();
  kissing(file);
  lumen("phantom", "kissing", file("other.nrrd"), "--noise", "0.2", "--seed", "7");
  const { address } = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openInFirefox(t, address);
  await page.waitForSelector(rows);
  await settle(page);
  await dropFiles(page, [{ name: "other.nrrd", bytes: readFileSync(file("other.nrrd")) }]);
  await page.waitForSelector("#ask-auto");
  await page.click("#ask-auto"); // in place of the volume
  await untilText(page, "dialog", /vessels\.lumen was made from another volume than other\.nrrd/);
  await keep(page, "firefox-two-patients");
  await page.keyboard.press("Escape");
  await page.waitForSelector("#other-source", { visible: true });
  const [seed] = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches;
  await seedAt(page, seed.points[0].position);
  await page.click("#track-all");
  await untilText(page, "[role=alert], [role=status], .toast", /belong to one patient/);
});

test("a seed that waits is saved with the case, and waits again", async t => {
  const file = makeFolder();
  firstVessel(file, "kissing");
  const second = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches[1].points[0].position,
    { address } = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openInFirefox(t, address);
  await page.waitForSelector(rows);
  await settle(page);
  await seedAt(page, second);
  const label = await text(page, "#seed-list .item .link");
  await chord(page, "Control", "s");
  await page.waitForSelector("#unsaved", { hidden: true });
  assert.deepEqual(lumen("info", file("vessels.lumen")).seeds, { tracked: 1, waiting: 1 });

  const again = await view(t, file("volume.nrrd"), file("vessels.lumen"));
  await page.goto(again.address);
  await page.waitForSelector("#seed-list .item");
  assert.equal(await text(page, "#seed-list .item .link"), label);
  await keep(page, "firefox-waits-again");
  await page.keyboard.press("t");
  await page.waitForFunction(where => document.querySelectorAll(where).length === 2, {}, rows);
});

test("an orientation that two transforms of a file state differently is named", async t => {
  const file = makeFolder();
  lumen("phantom", "tube", file("tube.nii"), "--size", "48");
  const bytes = readFileSync(file("tube.nii"));
  bytes.writeInt16LE(1, 252); // code of the qform, which stays as it is
  bytes.writeInt16LE(2, 254); // code of the sform, whose first row is turned
  bytes.writeFloatLE(-bytes.readFloatLE(280), 280);
  writeFileSync(file("tube.nii"), bytes);
  const { address } = await view(t, file("tube.nii")),
    page = await openInFirefox(t, address);
  await page.waitForSelector("#assumptions", { visible: true });
  assert.match(await text(page, "#assumptions"), /sform.*qform|qform.*sform/);
  await keep(page, "firefox-orientation");
});

test("the wall is pulled by the brush, and put back", async t => {
  const file = makeFolder();
  firstVessel(file, "bifurcation");
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
