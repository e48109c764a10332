// SPDX-License-Identifier: Apache-2.0
// A vessel that the check finds missing is a place to click, and then a vessel.
import assert from "node:assert/strict";
import { find, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { checkCase, firstVessel, openVessels, placeIn } from "./hand.mjs";
import { makeFolder } from "./lumen.mjs";

const places = page => page.locator("#work-list .item.row:is([data-kind=missing], [data-kind=early-end])");

story(
  "a click on a ring in the 3D view places a seed in what is missing, and tracking leaves less of it",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t);
    firstVessel(file, "bifurcation");
    const page = await openVessels(t, browser, file);
    await checkCase(page);
    const before = await places(page).count();
    assert.ok(before > 0, "the second vessel is missing");
    await picture(page, "2-missing");

    const pink = (r, g, b) => r > 150 && r > 1.5 * g && b > 1.05 * g && r > 1.3 * b; // the mark, lit and shaded
    const box = await page.locator("#view-scene").boundingBox(),
      { at, count } = find(await pixels(page, "#view-scene"), pink);
    assert.ok(count > 20, `${count} pixels of the mark`);
    await page.mouse.click(box.x + at.x, box.y + at.y);
    await page.locator("#seed-list .item").first().waitFor();
    await page.mouse.click(box.x + at.x, box.y + at.y);
    await picture(page, "2-seed-there");
    assert.equal(
      await page.locator("#seed-list .item").count(),
      1,
      "a second click on the same ring places no second seed",
    );

    await page.keyboard.press("t");
    await page.locator("#tree-list [role=treeitem]").nth(1).waitFor();
    await settled(page);
    await page.locator("#check-about").filter({ hasText: "check again" }).waitFor();
    await page.keyboard.press("k");
    await page.locator("#check-about").filter({ hasNotText: "check again" }).waitFor();
    await settled(page);
    const after = await places(page).count();
    assert.ok(after < before, `${before} places before, ${after} after`);
    await picture(page, "2-tracked");
  },
);

story("a click on a ring in a slice does the same", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  firstVessel(file, "kissing");
  const page = await openVessels(t, browser, file);
  await checkCase(page);
  const before = await places(page).count();
  await page.locator("#work-list [data-kind] .link >> nth=0").click();
  const there = (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number);
  const { x, y } = await placeIn(page, "axial", there);
  await page.mouse.click(x + 3, y);
  await page.locator("#seed-list .item").first().waitFor();
  await picture(page, "2-seed-in-slice");
  await page.locator("#track-all").click();
  await page.locator("#tree-list [role=treeitem]").nth(1).waitFor();
  await settled(page);
  await page.locator("#check").click();
  await page
    .locator("#check-about")
    .filter({ hasText: "the wall is off" })
    .filter({ hasNotText: "check again" })
    .waitFor();
  const after = await places(page).count();
  assert.ok(after < before, `${before} places before, ${after} after`);
});
