// SPDX-License-Identifier: Apache-2.0
// A tree of ten vessels from a volume without a case: found without a click, and by clicks of a simulated hand. Figures are printed.
// The volume is a phase-contrast MR of a carotid, where its folder is there (LUMEN_DATA), else a phantom.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { loadavg } from "node:os";
import { fileURLToPath } from "node:url";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { placeSeed, reported, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const kRepository = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const kData = process.env.LUMEN_DATA ?? join(kRepository, "../shared/data"),
  kCarotid = join(kData, "more/carotid-pcmr.nrrd");
const kWanted = 10, // vessels
  kSeeds = 12, // clicks: two of them may lie in one vessel
  kAim = 1500; // ms in which a person finds the next vessel and aims, before the hand moves

function volumeOf(file) {
  if (existsSync(kCarotid)) return kCarotid;
  lumen("phantom", "patient", file("volume.nrrd"), "--size", "128");
  return file("volume.nrrd");
}

const seconds = since => (performance.now() - since) / 1000;

/** Prints time, vessels and load. */
async function state(t, page, how, since) {
  const count = (await vessels(page)).length;
  t.diagnostic(
    `${how}: ${count} vessels in ${seconds(since).toFixed(1)} s, at a load of ${loadavg()[0].toFixed(1)}`,
  );
  assert.ok(count >= kWanted, `${count} vessels ${how}`);
}

/** Places of the proposals, the longest first: a person would see these vessels. */
async function seenVessels(address) {
  const { proposals } = await (await fetch(new URL("state", address))).json();
  return proposals
    .filter(each => each.kind === "vessel")
    .sort((a, b) => b.length_mm - a.length_mm)
    .map(each => each.position);
}

story("ten vessels are found without a click and accepted, and the same by clicks", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    volume = volumeOf(file);
  let server = await view(t, volume, file("found.lumen"));
  let page = await openPage(t, browser, server.address),
    since = performance.now();
  await page.locator("#find").click();
  await reported(page, /vessels are proposed/);
  await settled(page);
  const places = await seenVessels(server.address);
  await page.locator("#accept-all").click();
  await page
    .locator("#tree-list [role=treeitem]")
    .nth(kWanted - 1)
    .waitFor();
  await settled(page);
  await state(t, page, "Find vessels, accept all", since);
  await picture(page, "ten-found");
  await page.close();

  server = await view(t, volume, file("clicked.lumen"));
  page = await openPage(t, browser, server.address);
  await settled(page);
  since = performance.now();
  for (const [k, place] of places.slice(0, kSeeds).entries()) {
    await page.waitForTimeout(kAim);
    await placeSeed(page, place);
    await page.waitForFunction(
      n =>
        document.querySelectorAll("#seed-list .item").length > n ||
        document.querySelector(".toast.warning, .toast.error"),
      k,
    );
  }
  await page.keyboard.press("t");
  await page.locator("#tree-list [role=treeitem]").first().waitFor();
  await settled(page);
  await state(t, page, `clicks, each with ${kAim} ms to aim`, since);
  await picture(page, "ten-clicked");
});
