// SPDX-License-Identifier: Apache-2.0
// From a volume to a saved case: vessels are found and accepted, one is clicked, the tree is corrected, saved and opened again.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { find, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import {
  crosshair,
  away,
  document,
  dragIn,
  phantom,
  placeSeed,
  radius,
  reported,
  step,
  toMiddle,
  type,
  undo,
  vessel,
  vessels,
} from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const proposals = page => page.locator("#proposal-list .item");
const dashed = (r, g, b) => r > 215 && b > 215 && g < 110; // the magenta of proposals, which no vessel has

/** Waits until N proposals are listed, and the page rests. */
async function waiting(page, count) {
  await page.waitForFunction(n => document.querySelectorAll("#proposal-list .item").length === n, count);
  await settled(page);
}

/** The tree as the list shows it: one line for each vessel, with its depth and its figures. */
const rows = page =>
  page
    .locator("#tree-list [role=treeitem]")
    .evaluateAll(items => items.map(item => `${item.getAttribute("aria-level")} ${item.title}`));

/** Number of nodes of the cursor's vessel. */
const nodes = async page =>
  Number((await page.locator("#edit-name").textContent()).match(/node \d+ of (\d+)/)[1]);

/** Vessels are proposed; one is accepted with its parent, undone, rejected, and the other accepted. */
async function acceptOne(page) {
  await page.keyboard.press("Shift+F");
  await reported(page, /vessels are proposed/);
  await waiting(page, 2);
  assert.deepEqual(await vessels(page), [], "nothing is part of the case yet");
  assert.ok(await page.locator("#save").isDisabled());
  const { count } = find(await pixels(page, "#view-axial"), dashed);
  assert.ok(count > 20, `${count} pixels of proposals`);
  await picture(page, "found-proposed");
  const child = proposals(page).filter({ has: page.getByRole("button", { name: /and its parents/ }) }),
    label = await child.getAttribute("data-label");
  await child.getByRole("button", { name: `Accept ${label}` }).click();
  await waiting(page, 0);
  assert.equal((await vessels(page)).length, 2, "its parent comes along");
  await undo(page);
  await waiting(page, 2);
  assert.deepEqual(await vessels(page), []);
  await proposals(page)
    .filter({ has: page.getByRole("button", { name: `Reject ${label}` }) })
    .getByRole("button", { name: `Reject ${label}` })
    .click();
  await waiting(page, 1);
  await page.locator("#accept-all").click();
  await waiting(page, 0);
  assert.equal(find(await pixels(page, "#view-axial"), dashed).count, 0, "nothing is dashed any more");
}

/** Corrections of the vessel `label` that are undone to the same bytes. */
async function correctAndUndo(page, label) {
  const original = await document(page);
  const undone = async what => {
    await undo(page);
    assert.deepEqual(await document(page), original, `after undoing ${what}`);
  };
  await page.keyboard.press("4"); // the axial slice alone: the 3D view need not be drawn
  await toMiddle(page, label);
  const node = await crosshair(page),
    before = await radius(page),
    beside = mm => [node[0], node[1] + mm, node[2]];
  await step(page, () => page.keyboard.press("Shift+X"));
  assert.equal((await vessels(page)).length, 3);
  await undone("a cut");

  await toMiddle(page, label);
  await page.keyboard.press("v");
  await step(page, () => dragIn(page, "axial", node, [node[0] + 1, node[1], node[2]]));
  await toMiddle(page, label);
  assert.ok(away(await crosshair(page), node) > 0.3, "the node is elsewhere");
  await undone("a node that was moved");

  await toMiddle(page, label);
  await page.keyboard.press("v");
  await step(page, () => dragIn(page, "axial", beside(before), beside(1.5 * before)));
  await toMiddle(page, label);
  assert.ok(
    Math.abs((await radius(page)) - 1.5 * before) < 0.25 * before,
    `${before} became ${await radius(page)}`,
  );
  await undone("a wall that was dragged");

  await toMiddle(page, label);
  await page.keyboard.press("e");
  await step(page, () => dragIn(page, "axial", beside(before), beside(1.5 * before)));
  await picture(page, "found-brushed");
  await vessel(page, label).locator(".name").click();
  assert.ok((await radius(page)) > 1.03 * before, `${before} became ${await radius(page)}`);
  await undone("the brush");

  await toMiddle(page, label);
  const count = await nodes(page);
  await step(page, () => page.keyboard.press("Shift+A"));
  await toMiddle(page, label);
  assert.equal(await nodes(page), count + 1);
  await step(page, () => page.keyboard.press("Shift+D"));
  await toMiddle(page, label);
  assert.equal(await nodes(page), count);
  await undo(page);
  await undone("nodes");
  await page.keyboard.press("1");
}

story("vessels are found, accepted, clicked and corrected, and the saved case is found again", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    [, second] = phantom(file, "bifurcation", {}, "--size", "64"),
    files = [file("volume.nrrd"), file("vessels.lumen")];
  let server = await view(t, ...files),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await acceptOne(page);

  await placeSeed(page, second);
  await page.locator("#seed-list .item").first().waitFor();
  await step(page, () => page.locator("#track-all").click());
  assert.equal(await page.locator("#seed-list .item").count(), 0, "no seed waits any more");
  const [label] = await vessels(page);
  assert.equal((await vessels(page)).length, 2);
  await correctAndUndo(page, label);

  await vessel(page, label).locator(".name").click();
  await page.keyboard.press("F2");
  await step(page, () => type(page, "carotid"));
  await page.keyboard.press("Control+s");
  await page.locator("#unsaved").waitFor({ state: "hidden" });
  const saved = readFileSync(files[1]),
    before = await rows(page);
  assert.ok(before[0].startsWith("1 carotid"), before[0]);
  await picture(page, "found-saved");
  assert.ok(lumen("info", files[1]).blobs > 0, "the vessels have their models");
  await page.close();
  await server.stop();

  server = await view(t, ...files);
  page = await openPage(t, browser, server.address);
  await vessel(page, "carotid").waitFor();
  await settled(page);
  assert.deepEqual(await rows(page), before, "the case that is opened again is the one that was saved");
  assert.deepEqual(await document(page), saved, "nothing has changed by opening it");
});
