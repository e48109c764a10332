// SPDX-License-Identifier: Apache-2.0
// Seeds live in the case: those that wait wait again when it is opened, and those that were tracked are named.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { firstVessel, openVessels, placeSeed, reported, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

story("a seed that waits is saved with the case, waits again, and is tracked then", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  firstVessel(file, "kissing");
  const second = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches[1].points[0].position;
  const page = await openVessels(t, browser, file);
  await page.locator("#seed-tracked summary", { hasText: "One seed was tracked" }).waitFor();
  await placeSeed(page, second);
  const waiting = page.locator("#seed-list .item");
  await waiting.first().waitFor();
  const label = await waiting.first().locator(".link").textContent();
  await page.keyboard.press("Control+s");
  await reported(page, /is saved, with 1 seed that waits/);
  await page.locator("#unsaved").waitFor({ state: "hidden" });
  assert.deepEqual(lumen("info", file("vessels.lumen")).seeds, { tracked: 1, waiting: 1 });

  const again = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    fresh = await openPage(t, browser, again.address);
  await settled(fresh);
  const waits = fresh.locator("#seed-list .item");
  assert.equal(await waits.count(), 1);
  assert.equal(await waits.first().locator(".link").textContent(), label);
  assert.ok(await fresh.locator("#unsaved").isHidden(), "nothing has changed by opening it");
  await picture(fresh, "13-waits-again");
  await fresh.keyboard.press("t");
  await fresh.locator("#tree-list [role=treeitem]").nth(1).waitFor();
  await settled(fresh);
  assert.equal((await vessels(fresh)).length, 2);
  await fresh.locator("#seed-tracked summary", { hasText: "2 seeds were tracked" }).click();
  await picture(fresh, "13-tracked-seeds");
  await fresh.keyboard.press("Control+s");
  await reported(fresh, /is saved/);
  assert.deepEqual(lumen("info", file("vessels.lumen")).seeds, { tracked: 2, waiting: 0 });
  lumen("seeds", file("vessels.lumen"), file("out.mrk.json"));
  assert.equal(JSON.parse(readFileSync(file("out.mrk.json"), "utf8")).markups.length, 2);
});
