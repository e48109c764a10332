// SPDX-License-Identifier: Apache-2.0
// The measures of the whole case: a click on a number shows its place.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { picture, settled, startBrowser, story } from "./browser.mjs";
import { bothVessels, openVessels } from "./hand.mjs";
import { lumen, makeFolder } from "./lumen.mjs";

const place = async page =>
  (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number);
const distance = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

story(
  "a person measures a case, and a click on a number goes to the place where it was measured",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t);
    bothVessels(file, "bifurcation");
    const page = await openVessels(t, browser, file);
    const [measured] = lumen("measure", file("vessels.lumen")).cases;

    await page.locator("#section-geometry > summary").click();
    await page.locator("#geometry-run").click();
    const rows = page.locator("#geometry-list .item");
    await rows.first().waitFor();
    await settled(page);
    assert.equal(await rows.count(), measured.vessels.length);

    await rows.first().locator("button").click();
    await settled(page);
    assert.ok(distance(await place(page), measured.vessels[0].place_mm) < 0.01, "the middle of the vessel");
    const narrowest = page.locator("#geometry-figures .item[data-column=smallest_radius_mm]");
    const shown = Number((await narrowest.locator(".figures").textContent()).split(" ")[0]);
    assert.ok(Math.abs(shown - measured.vessels[0].smallest_radius_mm.value) < 0.01);
    await narrowest.locator("button").click();
    await settled(page);
    assert.ok(
      distance(await place(page), measured.vessels[0].smallest_radius_place_mm) < 0.01,
      "its narrowest place",
    );
    await picture(page, "1-vessel");

    await page.locator("#geometry-kind").selectOption("forks");
    assert.equal(await rows.count(), measured.forks.length);
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.locator("#geometry-csv").click(),
    ]);
    const table = readFileSync(await download.path(), "utf8")
      .trim()
      .split("\n");
    assert.equal(table.length, 1 + measured.forks.length);
    assert.match(table[0], /^case,parent,larger,smaller,/);
    await picture(page, "2-forks");

    await page.locator("#tree-list [role=treeitem]").nth(1).click();
    await page.locator("#edit-delete").click();
    await settled(page);
    await page.locator("#geometry-note").filter({ hasText: "measure again" }).waitFor();
  },
);
