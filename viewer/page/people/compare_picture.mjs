// SPDX-License-Identifier: Apache-2.0
// Makes the picture docs/viewer-compare.png: LUMEN=... LUMEN_PICTURES=docs node people/compare_picture.mjs, with the
// demonstration (./bootstrap.sh demo) in LUMEN_DEMO.
import { join } from "node:path";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { vessel } from "./hand.mjs";
import { view } from "./lumen.mjs";

const demo = name => join(process.env.LUMEN_DEMO ?? "demo", name);

story("two cases of the demonstration are compared in the light theme", async t => {
  const browser = await startBrowser(t),
    { address } = await view(t, demo("angiogram.nrrd"), demo("vessels.lumen"), demo("truth.lumen")),
    page = await openPage(t, browser, address, {
      viewport: { width: 1360, height: 800 },
      colorScheme: "light",
    });
  await settled(page);
  await page.locator("body[data-surface=closed]").waitFor();
  await vessel(page, "b02").locator(".name").dblclick();
  await page.locator("#colour-by").selectOption("compare");
  await page.locator("#legend").filter({ hasText: "truth" }).waitFor();
  await page.waitForTimeout(15_000); // until all outlines are there, and the finest surface
  await settled(page);
  await picture(page, "viewer-compare");
});
