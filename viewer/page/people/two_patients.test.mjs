// SPDX-License-Identifier: Apache-2.0
// A case of one volume beside another volume: the page asks before anything is mixed, and the case keeps the answer.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { drop, kissing, placeSeed, reported, vessel } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

story("a volume of another patient is not tracked into the case without an answer", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  kissing(file);
  lumen("phantom", "kissing", file("other.nrrd"), "--noise", "0.2", "--seed", "7");
  const { address } = await view(t, file("volume.nrrd"), file("vessels.lumen"));
  const page = await openPage(t, browser, address);
  await vessel(page, "root").waitFor();
  await settled(page);
  assert.equal(await page.locator("#other-source").isVisible(), false);

  await drop(page, "other.nrrd", readFileSync(file("other.nrrd")));
  await page.locator("#ask-auto").click(); // in place of the volume
  const dialog = page.locator("dialog");
  await dialog.filter({ hasText: "One patient" }).waitFor();
  assert.match(await dialog.textContent(), /vessels\.lumen was made from another volume than other\.nrrd/);
  await picture(page, "two-patients-question");
  await page.keyboard.press("Escape"); // no answer: the question stays, and nothing is tracked
  await page.locator("#other-source").waitFor();
  const [seed] = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches;
  await placeSeed(page, seed.points[0].position);
  await page.locator("#track-all").click();
  await reported(page, /belong to one patient/, "error");
  await picture(page, "two-patients-open");

  await page.locator("#answer-source").click();
  await page.locator("#ask-accept").click();
  await page.locator("#other-source").waitFor({ state: "hidden" });
  await page.keyboard.press("Control+s");
  await reported(page, /vessels\.lumen is saved/);
  const steps = lumen("info", file("vessels.lumen"), "--json").provenance.steps;
  assert.ok(
    JSON.stringify(steps).includes("accept-volume"),
    `no step of the answer among ${JSON.stringify(steps)}`,
  );
});
