// SPDX-License-Identifier: Apache-2.0
// Two vessels that touch: a wire that is pushed through one of them stays in it.
import assert from "node:assert/strict";
import { frames, openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { kissing, placeIn, vessel } from "./hand.mjs";
import { makeFolder, view } from "./lumen.mjs";

const wire = async page => {
  const about = page.locator("#wire-about");
  return {
    nodes: ((await about.getAttribute("data-nodes")) ?? "").split(" ").map(Number),
    vessels: JSON.parse((await about.getAttribute("data-vessels")) ?? "[]"),
    text: await about.textContent(),
  };
};
const inserted = text => Number(/^([\d.]+) mm in/.exec(text)[1]);

/** The highest place of a column of pixels of the scene where the pointer would take hold of the wire. */
const firstTouched = async (page, box, x) => {
  for (let y = box.y + 0.2 * box.height; y < box.y + 0.8 * box.height; y += 8) {
    await page.mouse.move(x, y);
    await frames(page, 3);
    if ((await page.locator("#view-scene.over-wire").count()) > 0) return y + 8;
  }
  throw new Error("the wire is nowhere in the middle of the scene");
};

story("a wire is pushed past where two vessels touch, and every point of it stays in its vessel", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  kissing(file);
  const server = await view(t, file("vessels.lumen")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await page.locator("#probe-distance[data-mm]").waitFor({ state: "attached" });

  // the second vessel is drawn into the first: where they overlap, only the way along the tree tells whose a point is
  await vessel(page, "root2").locator(".name").dblclick();
  await page.locator("#edit-name").filter({ hasText: "cursor at node" }).waitFor();
  await page.keyboard.press("v");
  const node = (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number),
    kInto = 1.2; // mm to the back
  const from = await placeIn(page, "axial", node),
    to = await placeIn(page, "axial", [node[0], node[1] + kInto, node[2]]);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 5 });
  await page.mouse.up();
  await page.locator("#undo:enabled").waitFor();
  await settled(page);
  await page.locator("#probe-distance[data-mm]").waitFor({ state: "attached" });

  await page.locator("#section-gaps summary").click();
  await page.locator("#gap-find").click();
  const gap = page.locator("#gap-list .item").first();
  assert.match(await gap.textContent(), /root.*root2/);
  assert.ok(
    parseFloat(await gap.locator(".note").textContent()) < -0.2,
    `the walls overlap: ${await gap.textContent()}`,
  );
  await picture(page, "6-overlapping");

  await page.locator("#section-wire summary").click();
  for (const name of ["root2", "root"]) {
    await vessel(page, name).locator(".name").click();
    await page.keyboard.press("w");
    await page.locator("#wire-place").click();
    await page.locator("#wire-about[data-nodes]").waitFor();
    await page.locator("#view-scene").focus();
    const kLength = 29,
      kEnough = 22; // mm of the vessel; past the place in its middle where they touch
    for (let k = 0; k < 200 && inserted((await wire(page)).text) < kEnough; ++k) {
      await page.keyboard.press("ArrowUp");
      if (k % 6 === 0) await page.keyboard.press(k % 12 === 0 ? "ArrowLeft" : "ArrowRight");
      await frames(page, 1);
      assert.deepEqual((await wire(page)).vessels, [name], `after ${k} pushes`);
    }
    const now = await wire(page);
    assert.ok(inserted(now.text) >= kEnough && inserted(now.text) < kLength, now.text);
    assert.deepEqual(now.vessels, [name]);
    assert.ok(
      now.nodes.length > 20 && new Set(now.nodes).size > 15,
      "the wire lies along the vessel, not in one place",
    );
    await picture(page, `6-wire-in-${name}`);
  }

  // by the pointer: taken hold of in the vessel's middle, and drawn back along it, which runs from right to left
  const before = inserted((await wire(page)).text),
    box = await page.locator("#view-scene").boundingBox(),
    x = box.x + box.width / 2;
  const y = await firstTouched(page, box, x);
  await page.mouse.move(x, y);
  await page.locator("#view-scene.over-wire").waitFor();
  await page.mouse.down();
  await page.mouse.move(x - 60, y, { steps: 20 });
  await page.mouse.up();
  await page.waitForFunction(
    mm => parseFloat(document.getElementById("wire-about").textContent) < mm - 5,
    before,
  );
  assert.deepEqual((await wire(page)).vessels, ["root"]);
  await picture(page, "6-wire-drawn-back");
});
