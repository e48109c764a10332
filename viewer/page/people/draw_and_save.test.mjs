// SPDX-License-Identifier: Apache-2.0
// From a volume to a saved case: clicks, tracking, corrections, and the same again after opening it anew.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { find, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { placeSeed, vessel, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

/** The tree as the list shows it: one line for each vessel, with its depth and its figures. */
const rows = page =>
  page
    .locator("#tree-list [role=treeitem]")
    .evaluateAll(items => items.map(item => `${item.getAttribute("aria-level")} ${item.title}`));

story(
  "three clicks in the demonstration's volume become a case that is corrected, saved and found again",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t);
    lumen("phantom", "patient", file("angiogram.nrrd"), "--seeds", file("seeds.json"));
    const clicks = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches.filter(seed =>
      ["root", "b02", "b03"].includes(seed.label),
    );
    let server = await view(t, file("angiogram.nrrd"), file("vessels.lumen")),
      page = await openPage(t, browser, server.address);
    await settled(page);
    await picture(page, "1-opened");

    for (const click of clicks) await placeSeed(page, click.points[0].position);
    await page.locator("#seed-list .item").nth(2).waitFor();
    await picture(page, "1-three-seeds");

    await page.locator("#track-all").click();
    await page.locator("#tree-list [role=treeitem]").nth(2).waitFor();
    await settled(page);
    assert.equal(await page.locator("#seed-list .item").count(), 0, "no seed waits any more");
    const tracked = await vessels(page);
    assert.equal(tracked.length, 3);
    await picture(page, "1-tracked");

    await vessel(page, tracked[0]).locator(".name").click();
    await page.keyboard.press("F2");
    await page.locator("#ask-text").fill("carotid");
    await page.keyboard.press("Enter");
    await vessel(page, "carotid").waitFor();
    assert.equal(
      await page.locator("#seed-list .item").count(),
      0,
      "the seed of a vessel with another name is still tracked",
    );

    const colour = await vessel(page, "carotid").locator(".swatch").inputValue(),
      [r, g, b] = [1, 3, 5].map(i => parseInt(colour.slice(i, i + 2), 16));
    // lit and shaded, the wall keeps its hue; the light adds white
    const pure = (...rgb) => rgb.map(x => x - Math.min(...rgb)),
      [p, q, s] = pure(r, g, b);
    const hue = (...rgb) => {
      const [x, y, z] = pure(...rgb);
      return (
        x + y + z > 40 &&
        Math.abs(x * q - y * p) + Math.abs(y * s - z * q) + Math.abs(x * s - z * p) <
          (0.3 * (p + q + s) * (x + y + z)) / 3
      );
    };
    await page.locator("#view-scene").hover({ position: { x: 3, y: 60 } });
    const shown = find(await pixels(page, "#view-scene"), hue).count;
    await vessel(page, "carotid").locator(".name").click();
    await page.keyboard.press("h");
    const hidden = find(await pixels(page, "#view-scene"), hue).count;
    assert.ok(
      hidden < 0.2 * shown,
      `of ${shown} pixels of the vessel's colour ${hidden} are left once it is hidden`,
    );
    await picture(page, "1-hidden");
    await page.keyboard.press("h");

    const whole = await rows(page);
    for (let i = 0; i < 3; ++i) await page.keyboard.press("Shift+}");
    await page.locator("#edit-cut").click();
    await page.locator("#tree-list [role=treeitem]").nth(3).waitFor();
    await settled(page);
    await picture(page, "1-cut");
    await page.locator("#view-scene").focus();
    await page.keyboard.press("Control+z");
    await page.locator("#tree-list [role=treeitem]").nth(3).waitFor({ state: "detached" });
    assert.deepEqual(await rows(page), whole, "undo brings the whole vessel back");

    await page.keyboard.press("Control+s");
    await page.locator("#unsaved").waitFor({ state: "hidden" });
    const saved = readFileSync(file("vessels.lumen")),
      before = await rows(page);
    assert.ok(before[0].startsWith("1 carotid"));
    await page.close();
    await server.stop();

    server = await view(t, file("angiogram.nrrd"), file("vessels.lumen"));
    page = await openPage(t, browser, server.address);
    await vessel(page, "carotid").waitFor();
    await settled(page);
    assert.deepEqual(await rows(page), before, "the case that is opened again is the one that was saved");
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.locator("#export").selectOption("lumen"),
    ]);
    assert.deepEqual(readFileSync(await download.path()), saved, "nothing has changed by opening it");
    await page.keyboard.press("Control+s");
    await page.locator("#toasts .toast").filter({ hasText: "vessels.lumen" }).last().waitFor();
    assert.deepEqual(readFileSync(file("vessels.lumen")), saved, "nor by saving it again");
    await picture(page, "1-opened-again");
  },
);
