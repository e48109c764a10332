// SPDX-License-Identifier: Apache-2.0
// The page without a server in Firefox: vessels are found in the tab, a search is cancelled, and a case is saved.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { count, dropFiles, keep, openInFirefox, settle, text, untilText } from "./firefox.mjs";
import { phantom } from "./hand.mjs";
import { lumen, makeFolder } from "./lumen.mjs";
import { serve } from "./static_server.mjs";

const rows = "#tree-list [role=treeitem]";

test("vessels are found in a tab of Firefox, and a search ends where it is cancelled", async t => {
  const file = makeFolder();
  phantom(file, "bifurcation", {}, "--size", "64");
  lumen("view", "--serverless", file("site"));
  const { address, asked } = await serve(t, file("site")),
    page = await openInFirefox(t, address);
  assert.equal(await text(page, "#status"), "Engine: this tab, no upload");
  await dropFiles(page, [{ name: "volume.nrrd", bytes: readFileSync(file("volume.nrrd")) }]);
  await untilText(page, "#toasts .toast", /volume.nrrd is open/);
  await settle(page);
  await page.click("#find");
  await page.keyboard.press("Escape");
  await untilText(page, "#toasts .toast", /cancelled; nothing has changed/);
  await settle(page);
  await page.click("#find");
  await untilText(page, "#toasts .toast", /proposed/);
  await settle(page);
  await page.click("#accept-all");
  await page.waitForSelector(rows);
  await page.waitForSelector("body[data-surface=closed]");
  await settle(page);
  assert.ok((await count(page, rows)) >= 2);
  await keep(page, "firefox-serverless");
  assert.deepEqual(
    asked.filter(request => !request.startsWith("GET ")),
    [],
  );
});
