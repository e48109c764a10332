// SPDX-License-Identifier: Apache-2.0
// A wall that is wrong is put right: by the brush, by its outline over a stretch, by nodes; and a vessel is tracked on.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { frames, openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import {
  clickIn,
  document,
  firstVessel,
  kissing,
  lookAt,
  openVessels,
  placeIn,
  reported,
  vessel,
  vessels,
} from "./hand.mjs";
import { makeFolder, view } from "./lumen.mjs";

const position = async page =>
  (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number);

/** Performs one step, and waits until the page shows that it is done. */
async function step(page, act) {
  const title = await page.locator("#undo").getAttribute("title");
  await act();
  await page.locator(`#undo:enabled:not([title=${JSON.stringify(title)}])`).waitFor();
  await settled(page);
}

async function undo(page) {
  const title = await page.locator("#undo").getAttribute("title");
  await page.keyboard.press("Control+z");
  await page.locator(`#undo:not([title=${JSON.stringify(title)}])`).waitFor({ state: "attached" });
  await settled(page);
}

async function toMiddle(page, label) {
  await vessel(page, label).locator(".name").dblclick();
  await page
    .locator("#edit-name")
    .filter({ hasText: `${label}, cursor at node` })
    .waitFor();
  await frames(page);
}

/** Radius at the cursor, mm, as the strip shows it. */
const radius = async page =>
  Number((await page.locator("#strip .striphead .note").textContent()).match(/radius ([\d.]+) mm/)[1]);

/** The number of the cursor's node in its vessel, and how many there are. */
const cursor = async page =>
  (await page.locator("#edit-name").textContent())
    .match(/node (\d+) of (\d+)/)
    .slice(1)
    .map(Number);

async function drag(page, from, to, name) {
  await page.mouse.move(from.x, from.y);
  await frames(page, 3);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 5 });
  await picture(page, name);
  await page.mouse.up();
}

story("the brush pushes and pulls the wall where it is dragged", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  kissing(file);
  const page = await openVessels(t, browser, file),
    original = await document(page);
  await vessel(page, "root").locator(".name").click();
  await toMiddle(page, "root");
  await page.mouse.move(2, 300);
  await frames(page, 3);
  const node = await position(page),
    before = await radius(page),
    at = mm => placeIn(page, "axial", [node[0], node[1] + mm, node[2]]);
  await page.keyboard.press("e");
  assert.equal(await page.locator("#tool-brush").getAttribute("aria-pressed"), "true");
  await step(page, async () => drag(page, await at(before), await at(1.5 * before), "11-brush-pulls"));
  await picture(page, "11-brush-pulled");
  await vessel(page, "root").locator(".name").click();
  const wider = await radius(page);
  assert.ok(wider > 1.03 * before, `${before} became ${wider}`);
  await step(page, async () => drag(page, await at(1.4 * before), await at(0.7 * before), "11-brush-pushes"));
  await vessel(page, "root").locator(".name").click();
  assert.ok((await radius(page)) < wider, "and pushed in again");
  await undo(page);
  await undo(page);
  assert.deepEqual(await document(page), original);

  const narrow = await page.locator("#edit-brush").inputValue();
  assert.equal(narrow, "", "as wide as the vessel asks for");
  const wall = await at(before);
  await page.mouse.move(wall.x, wall.y);
  await page.keyboard.down("Shift");
  await page.mouse.wheel(0, -100);
  await page.keyboard.up("Shift");
  await page.locator("#edit-brush").evaluate(
    input =>
      new Promise(resolve => {
        const look = () => (Number(input.value) > 0 ? resolve() : requestAnimationFrame(look));
        look();
      }),
  );
  const far = await at(-6 * before);
  await page.mouse.click(far.x, far.y);
  await reported(page, /no wall near there/, "warning");
});

story("a radius that is dragged fades along the vessel, or stays with one node", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  kissing(file);
  const page = await openVessels(t, browser, file);
  await vessel(page, "root").locator(".name").click();
  await toMiddle(page, "root");
  await page.mouse.move(2, 300);
  await frames(page, 3);
  const node = await position(page),
    before = await radius(page),
    at = mm => placeIn(page, "axial", [node[0], node[1] + mm, node[2]]);
  const beside = async () => {
    await page.keyboard.press("]");
    await frames(page);
    const there = await radius(page);
    await page.keyboard.press("[");
    await frames(page);
    return there;
  };
  const neighbour = await beside();
  const widen = async name => {
    await page.keyboard.press("v");
    await step(page, async () => drag(page, await at(before), await at(1.5 * before), name));
    await toMiddle(page, "root");
  };
  await widen("11-stretch-widens");
  await picture(page, "11-stretch-widened");
  assert.ok(Math.abs((await radius(page)) - 1.5 * before) < 0.25 * before);
  assert.ok((await beside()) > 1.2 * neighbour, "the next node goes along");
  await undo(page);
  await page.locator("#edit-stretch").fill("0");
  await page.locator("#edit-stretch").press("Tab");
  await toMiddle(page, "root");
  await widen("11-one-node-widens");
  assert.ok(Math.abs((await radius(page)) - 1.5 * before) < 0.25 * before);
  const alone = await beside();
  assert.ok(Math.abs(alone - neighbour) < 0.02, `one node alone: the next had ${neighbour} and has ${alone}`);
});

story("nodes are added and deleted, where the views show them", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  kissing(file);
  const page = await openVessels(t, browser, file);
  await vessel(page, "root").locator(".name").click();
  await toMiddle(page, "root");
  const [, count] = await cursor(page);
  await step(page, () => page.keyboard.press("Shift+A"));
  await toMiddle(page, "root");
  assert.equal((await cursor(page))[1], count + 1);
  await picture(page, "11-node-added");
  await step(page, () => page.keyboard.press("Shift+D"));
  await toMiddle(page, "root");
  assert.equal((await cursor(page))[1], count);
  await lookAt(page, [2, 2, 2]);
  await page.keyboard.press("Shift+D");
  await reported(page, /once more deletes the node there/, "warning");
  assert.equal((await cursor(page))[1], count);
});

story("a vessel is tracked on beyond its end, and several clicks end with Enter", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  firstVessel(file, "kissing");
  const page = await openVessels(t, browser, file);
  const [label] = await vessels(page);
  await vessel(page, label).locator(".name").click();
  await toMiddle(page, label);
  await step(page, () => page.keyboard.press("Shift+X"));
  const [, rest] = await vessels(page);
  await vessel(page, rest).locator(".name").click();
  await step(page, () => page.keyboard.press("Delete"));
  assert.deepEqual(await vessels(page), [label]);
  const ends = async () => (await vessel(page, label).locator(".number").first().textContent()).trim();
  const short = await ends();
  await vessel(page, label).locator(".name").click();
  for (let i = 0; i < 12; ++i) await page.keyboard.press("Shift+}"); // to its end
  await step(page, () => page.keyboard.press("Shift+T"));
  assert.equal((await vessels(page)).length, 2);
  await picture(page, "11-tracked-on");
  const onward = (await vessels(page))[1];
  assert.equal(
    await vessel(page, onward).getAttribute("aria-level"),
    "2",
    "it hangs on the vessel that went on",
  );
  await vessel(page, onward).locator(".name").click();
  await step(page, () => page.locator("#edit-merge:enabled").click());
  assert.notEqual(await ends(), short);

  const fresh = await view(t, file("volume.nrrd")),
    empty = await openPage(t, browser, fresh.address),
    truth = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches[0].points[0].position;
  await settled(empty);
  await empty.locator("#seed-kind").selectOption("path");
  await lookAt(empty, truth);
  await empty.keyboard.press("s");
  await clickIn(empty, "axial", truth);
  await reported(empty, /On the axis/);
  await clickIn(empty, "axial", [truth[0] + 1.5, truth[1], truth[2]]);
  await frames(empty, 3);
  await empty.keyboard.press("Enter");
  await empty.locator("#seed-list .item", { hasText: /2 clicks, r [\d.]+ mm/ }).waitFor();
});
