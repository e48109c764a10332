// SPDX-License-Identifier: Apache-2.0
// Every correction of the tree and of its walls, and its undo; seeds of several clicks, and seeds that are moved.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { frames, openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import {
  away,
  clickIn,
  document,
  drop,
  lookAt,
  phantom,
  placeIn,
  placeSeed,
  position,
  radius,
  reported,
  step,
  toMiddle,
  undo,
  vessel,
  vessels,
} from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

/** A page of a phantom's volume and case. */
async function openVessels(t, browser, file) {
  const server = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  return page;
}

async function drag(page, from, to, name) {
  await page.mouse.move(from.x, from.y);
  await frames(page, 3);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 5 });
  await picture(page, name);
  await page.mouse.up();
}

const press = (page, id) => () => page.locator(`#edit-${id}:enabled`).click();

story("every correction can be made and undone", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  phantom(file, "kissing", { "vessels.lumen": 2 });
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

  await toMiddle(page, "root");
  const narrow = await radius(page),
    wall = await placeIn(page, "axial", [node[0], node[1] + narrow, node[2]]),
    farther = await placeIn(page, "axial", [node[0], node[1] + 1.5 * narrow, node[2]]);
  await page.keyboard.press("v");
  await page.mouse.move(wall.x, wall.y);
  await page.mouse.down();
  await page.mouse.move(farther.x, farther.y, { steps: 5 });
  await picture(page, "10-widening");
  await step(page, () => page.mouse.up());
  await toMiddle(page, "root");
  assert.ok(
    Math.abs((await radius(page)) - 1.5 * narrow) < 0.25 * narrow,
    `${narrow} became ${await radius(page)}`,
  );
  await undone("move");
  await toMiddle(page, "root");
  await page.keyboard.press("r");
  await page.locator("#ask-text").fill("2.25");
  await step(page, () => page.keyboard.press("Enter"));
  await toMiddle(page, "root");
  assert.equal(await radius(page), 2.25);
  await undone("move");
  assert.ok(await page.locator("#undo").isDisabled());
});

story("a seed is moved, and a vessel is tracked through several clicks", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  phantom(file, "kissing", { "vessels.lumen": 2 });
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
  await page.locator("#section-geometry > summary").click();
  await page.locator("#geometry-run").click();
  const measured = page.locator("#geometry-list .item");
  await measured.nth(1).waitFor(); // the sac is a vessel without a place
  await page.locator("#geometry-kind").selectOption("sacs");
  assert.equal(await measured.count(), 1);
  await page.locator("#geometry-kind").selectOption("vessels");
  assert.equal(await measured.count(), 2);
});

story("the brush pushes and pulls the wall where it is dragged", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  phantom(file, "kissing", { "vessels.lumen": 2 });
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
  phantom(file, "kissing", { "vessels.lumen": 2 });
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

story("a vessel is tracked on beyond its end, and several clicks end with Enter", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  phantom(file, "kissing", { "vessels.lumen": 1 });
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
