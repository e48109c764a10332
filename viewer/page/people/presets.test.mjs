// SPDX-License-Identifier: Apache-2.0
// Windows by which CT is read.
import assert from "node:assert/strict";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

story("a preset sets the window, and another window is no preset", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "bifurcation", file("volume.nrrd"), "--size", "64");
  const { address } = await view(t, file("volume.nrrd")),
    page = await openPage(t, browser, address);
  await settled(page);
  assert.equal(await page.locator("#window-preset").inputValue(), "", "the window that it came with");
  await page.locator("#window-preset").selectOption("abdomen");
  assert.equal(Number(await page.locator("#window-low").inputValue()), -160);
  assert.equal(Number(await page.locator("#window-high").inputValue()), 240);
  await picture(page, "preset-abdomen");
  await page.locator("#window-auto").click();
  assert.equal(await page.locator("#window-preset").inputValue(), "");
});
