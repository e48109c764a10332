// SPDX-License-Identifier: Apache-2.0
// Without a pointer: from an empty list to a vessel.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

story("a vessel is tracked without a pointer", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "tube", file("volume.nrrd"), "--seeds", file("seeds.json"));
  const server = await view(t, file("volume.nrrd")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  // with the tabulator alone into the axial slice, then S, steps of voxels to a place in the vessel, and Enter
  for (let k = 0; k < 60 && (await page.locator("#view-axial:focus").count()) === 0; ++k)
    await page.keyboard.press("Tab");
  assert.equal(await page.locator("#view-axial:focus").count(), 1, "the slice is reached by the tabulator");
  await page.keyboard.press("s");
  const wanted = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches[0].points[0].position;
  const at = async () =>
    (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number);
  for (const [axis, more, less] of [
    [0, "ArrowRight", "ArrowLeft"],
    [1, "ArrowDown", "ArrowUp"],
    [2, "PageUp", "PageDown"],
  ])
    for (let k = 0; k < 200 && Math.abs((await at())[axis] - wanted[axis]) > 0.15; ++k) {
      const key = (await at())[axis] < wanted[axis] ? more : less,
        was = (await at())[axis];
      await page.keyboard.press(key);
      await page.waitForFunction(
        ([a, x]) => Number(document.getElementById("probe-position").dataset.mm.split(" ")[a]) !== x,
        [axis, was],
      );
    }
  await page.keyboard.press("Enter");
  await page.locator("#seed-list .item").first().waitFor();
  await picture(page, "11-seed-by-keys");
  await page.keyboard.press("t");
  await page.locator("#tree-list [role=treeitem]").first().waitFor();
  await settled(page);
  for (let k = 0; k < 60 && (await page.locator("#tree-list:focus").count()) === 0; ++k)
    await page.keyboard.press("Shift+Tab");
  await page.keyboard.press("ArrowDown");
  await page.locator("#branch-name").waitFor();
  await page.keyboard.press("Enter");
  await picture(page, "11-tracked-by-keys");
});
