// SPDX-License-Identifier: Apache-2.0
// Every correction of the tree, and its undo; seeds of several clicks, and seeds that are moved.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { frames, openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import {
  clickIn,
  document,
  drop,
  kissing,
  lookAt,
  placeIn,
  placeSeed,
  reported,
  vessel,
  vessels,
} from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const position = async page =>
  (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number);
const away = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

/** Performs one step, and waits until the page shows that it is done. */
async function step(page, act) {
  const title = await page.locator("#undo").getAttribute("title");
  await act();
  await page.locator(`#undo:enabled:not([title=${JSON.stringify(title)}])`).waitFor();
  await settled(page);
}

async function undo(page) {
  const title = await page.locator("#undo").getAttribute("title");
  await page.locator("#undo").click();
  await page.locator(`#undo:not([title=${JSON.stringify(title)}])`).waitFor({ state: "attached" });
  await settled(page);
}

/** The middle node of a vessel is the cursor's, and the crosshair is there. */
async function toMiddle(page, label) {
  await vessel(page, label).locator(".name").dblclick();
  await page
    .locator("#edit-name")
    .filter({ hasText: `${label}, cursor at node` })
    .waitFor();
  await frames(page);
}

const press = (page, id) => () => page.locator(`#edit-${id}:enabled`).click();

story("every correction can be made and undone", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  kissing(file);
  const server = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openPage(t, browser, server.address);
  await vessel(page, "root2").waitFor();
  await settled(page);
  const original = await document(page),
    undone = async what => {
      await undo(page);
      assert.deepEqual(await vessels(page), ["root", "root2"], `after undoing ${what}`);
      assert.deepEqual(await document(page), original, `after undoing ${what}`);
    };

  await toMiddle(page, "root");
  await step(page, press(page, "reverse"));
  assert.notDeepEqual(await document(page), original);
  await undone("reverse");

  await toMiddle(page, "root");
  await step(page, press(page, "kind"));
  assert.equal(await page.locator("#branch-detail .kind").textContent(), "aneurysm");
  await picture(page, "10-kind");
  await undone("kind");

  await toMiddle(page, "root2");
  await step(page, press(page, "split"));
  assert.deepEqual(await vessels(page), ["root", "root2", "root2-2"]);
  assert.equal(
    await vessel(page, "root2-2").getAttribute("aria-level"),
    "2",
    "what was split off hangs on the rest",
  );
  await vessel(page, "root2-2").locator(".name").click();
  await step(page, press(page, "root"));
  assert.equal(await vessel(page, "root2-2").getAttribute("aria-level"), "1");
  assert.equal(
    await vessel(page, "root2").getAttribute("aria-level"),
    "2",
    "the tree begins at its other end now",
  );
  await picture(page, "10-new-root");
  await undo(page);
  await vessel(page, "root2-2").locator(".name").click();
  await step(page, press(page, "merge"));
  assert.deepEqual(await vessels(page), ["root", "root2"]);
  await undo(page);
  await vessel(page, "root2").locator(".name").click();
  await step(page, () => page.keyboard.press("Shift+Delete"));
  assert.deepEqual(await vessels(page), ["root"], "what hangs on it goes with it");
  await undo(page);
  await vessel(page, "root2").locator(".name").click();
  await step(page, () => page.keyboard.press("Delete"));
  assert.deepEqual(await vessels(page), ["root", "root2-2"], "what hangs on it stays");
  await undo(page);
  await undone("split");

  await vessel(page, "root").locator(".name").click(); // the views follow the list
  const shown = (await page.locator("#probe-branch").textContent()) ?? "";
  assert.equal(shown, "root");
  await lookAt(page, [2, 2, 2]); // and leave it: a cut there would be one that nobody sees
  await page.keyboard.press("Shift+X");
  await reported(page, /once more cuts there/, "warning");
  assert.deepEqual(await vessels(page), ["root", "root2"]);
  await picture(page, "10-cut-is-shown-first");

  await toMiddle(page, "root");
  await step(page, () => page.keyboard.press("Shift+X"));
  assert.equal(
    await vessel(page, "root-2").getAttribute("aria-level"),
    "1",
    "what was cut off is a tree of its own",
  );
  await vessel(page, "root-2").locator(".name").click();
  await page.locator("#edit-target").selectOption({ label: "root" });
  await step(page, press(page, "join"));
  assert.equal(await vessel(page, "root-2").getAttribute("aria-level"), "2");
  await picture(page, "10-joined");
  await undo(page);
  await undone("cut");

  await toMiddle(page, "root");
  const node = await position(page);
  await page.keyboard.press("v");
  const { x, y } = await placeIn(page, "axial", node);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 10, y + 2, { steps: 5 });
  await picture(page, "10-moving-a-node");
  await step(page, () => page.mouse.up());
  await picture(page, "10-moved-node");
  await toMiddle(page, "root");
  await page.mouse.move(2, 300);
  await frames(page, 3);
  assert.ok(away(await position(page), node) > 0.3, "the node is elsewhere");
  await undone("move");

  const radius = async () =>
    Number((await page.locator("#strip .striphead .note").textContent()).match(/radius ([\d.]+) mm/)[1]);
  await toMiddle(page, "root");
  const narrow = await radius(),
    wall = await placeIn(page, "axial", [node[0], node[1] + narrow, node[2]]),
    farther = await placeIn(page, "axial", [node[0], node[1] + 1.5 * narrow, node[2]]);
  await page.keyboard.press("v");
  await page.mouse.move(wall.x, wall.y);
  await page.mouse.down();
  await page.mouse.move(farther.x, farther.y, { steps: 5 });
  await picture(page, "10-widening");
  await step(page, () => page.mouse.up());
  await toMiddle(page, "root");
  assert.ok(Math.abs((await radius()) - 1.5 * narrow) < 0.25 * narrow, `${narrow} became ${await radius()}`);
  await undone("move");
  await toMiddle(page, "root");
  await page.keyboard.press("r");
  await page.locator("#ask-text").fill("2.25");
  await step(page, () => page.keyboard.press("Enter"));
  await toMiddle(page, "root");
  assert.equal(await radius(), 2.25);
  await undone("move");
  assert.ok(await page.locator("#undo").isDisabled());
});

story("a seed is moved, and a vessel is tracked through several clicks", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  kissing(file);
  const truth = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches[0].points[0].position;
  const server = await view(t, file("volume.nrrd")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await placeSeed(page, truth);
  const link = page.locator("#seed-list .item .link").first();
  await link.waitFor();
  await link.click();
  await page.mouse.move(2, 300);
  await frames(page, 3);
  const placed = await position(page);
  assert.ok(away(placed, truth) < 0.5, `placed at ${placed}, clicked at ${truth}`);
  const { x, y } = await placeIn(page, "axial", placed);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 30, y, { steps: 5 });
  await step(page, () => page.mouse.up());
  await link.click();
  await page.mouse.move(2, 300);
  await frames(page, 3);
  const moved = await position(page);
  assert.ok(away(moved, placed) > 1 && Math.abs(moved[2] - placed[2]) < 0.05, `from ${placed} to ${moved}`);
  assert.equal(await page.locator("#seed-list .item").count(), 1, "it was moved, and no other was placed");
  await drop(page, "others.json", readFileSync(file("seeds.json")));
  await page.locator("dialog[open]").filter({ hasText: "One seed waits" }).waitFor();
  await page.keyboard.press("Escape");
  await page.locator("dialog[open]").waitFor({ state: "detached" });
  assert.equal(await page.locator("#seed-list .item").count(), 1, "seeds that wait are not replaced unasked");
  await undo(page);
  await undo(page);
  assert.equal(await page.locator("#seed-list .item").count(), 0);

  await page.locator("#seed-kind").selectOption("path");
  await lookAt(page, truth);
  await page.keyboard.press("s");
  await clickIn(page, "axial", truth);
  await page.locator("#toasts .toast").filter({ hasText: "On the axis" }).last().waitFor();
  await clickIn(page, "axial", [truth[0] + 2, truth[1], truth[2]]);
  await page.locator("#seed-finish").click();
  await page.locator("#seed-list .item", { hasText: "2 clicks" }).waitFor();
  await picture(page, "10-several-clicks");
  await page.keyboard.press("t");
  await page.locator("#tree-list [role=treeitem]").first().waitFor();
  await settled(page);
  await picture(page, "10-tracked-through-clicks");
});

story("an aneurysm is a chain of clicks", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "aneurysm", file("volume.nrrd"), "--seeds", file("seeds.json"));
  const [vesselSeed, sac] = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches;
  const server = await view(t, file("volume.nrrd")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await placeSeed(page, vesselSeed.points[0].position);
  await page.locator("#seed-list .item").first().waitFor();
  await page.locator("#seed-kind").selectOption("aneurysm");
  for (const [i, point] of sac.points.entries()) {
    await placeSeed(page, point.position);
    if (i === 0) await picture(page, "10-aneurysm-begun");
  }
  await page.locator("#seed-finish").click();
  await page.locator("#seed-list .item", { hasText: `aneurysm, ${sac.points.length} clicks` }).waitFor();
  await picture(page, "10-aneurysm-seeds");
  await page.keyboard.press("t");
  await page.locator("#tree-list .aneurysm").waitFor();
  await settled(page);
  await picture(page, "10-aneurysm");
  assert.equal((await vessels(page)).length, 2);
});
