// SPDX-License-Identifier: Apache-2.0
// Nothing is lost: work after a crash, files and documents that others change, broken files, cancelled work, seeds that wait, and
// the volume of another patient.
import assert from "node:assert/strict";
import { copyFileSync, readFileSync, renameSync, utimesSync } from "node:fs";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { document, drop, phantom, placeSeed, reported, step, type, undo, vessel, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

async function rename(page, from, to) {
  await vessel(page, from).locator(".name").click();
  await page.keyboard.press("F2");
  await type(page, to);
  await vessel(page, to).waitFor();
  await settled(page);
}

/** Broken files are named with their fault, and change nothing. */
async function dropBroken(page, file) {
  const before = await document(page);
  for (const [name, bytes] of [
    ["half.lumen", before.subarray(0, before.length >> 1)],
    ["what.xyz", "hello"],
    ["empty.stl", ""],
  ]) {
    await drop(page, name, bytes);
    const text = await reported(page, new RegExp(name), "error");
    assert.ok(
      text.length > name.length + 10 && !text.includes(file("").slice(0, 5)),
      `it says what is wrong, without a path: ${text}`,
    );
    await settled(page);
  }
  assert.ok(await page.locator("#undo").isDisabled(), "there is nothing to undo");
  assert.deepEqual(await document(page), before);
}

/** What one page does is seen by another. */
async function shareWith(t, browser, address, one) {
  const other = await openPage(t, browser, address);
  await settled(other);
  await rename(one, "root2", "left");
  await vessel(other, "left").locator(".name").click();
  await other.keyboard.press("Delete");
  await vessel(one, "left").waitFor({ state: "detached" });
  await one.locator("#branch-name").waitFor({ state: "detached" }); // it was selected there
  await settled(one);
  await undo(one);
  await vessel(other, "left").waitFor();
  await undo(one);
  await vessel(other, "root2").waitFor();
  await other.close();
}

/** A file that another program has changed is overwritten for an answer alone. */
async function overwrite(page, file) {
  lumen("fit", file("copy.lumen"), file("theirs.lumen"), "--accuracy", "0.5");
  renameSync(file("theirs.lumen"), file("vessels.lumen"));
  utimesSync(file("vessels.lumen"), new Date(), new Date(Date.now() + 5000));
  await reported(page, /vessels\.lumen/, "warning");
  await page.locator("#file-list .changed").first().waitFor(); // the section opens by itself
  const theirs = readFileSync(file("vessels.lumen"));
  await rename(page, "root", "mine");
  await page.keyboard.press("Control+s");
  await page.locator("dialog").waitFor();
  await picture(page, "recovered-overwrite");
  await page.keyboard.press("Escape");
  assert.deepEqual(readFileSync(file("vessels.lumen")), theirs);
  await page.keyboard.press("Control+s");
  await page.locator("dialog button", { hasText: "Overwrite" }).click();
  await page.locator("#unsaved").waitFor({ state: "hidden" });
  assert.notDeepEqual(readFileSync(file("vessels.lumen")), theirs);
}

/** A volume of another patient is not tracked into the case without an answer, and a seed that waits is saved with it. */
async function keepApart(page, file, place) {
  await drop(page, "other.nrrd", readFileSync(file("other.nrrd")));
  await page.locator("#ask-auto").click(); // in place of the volume
  await page.locator("dialog").filter({ hasText: "was made from another volume than other.nrrd" }).waitFor();
  await picture(page, "recovered-two-patients");
  await page.keyboard.press("Escape"); // no answer: the question stays, and nothing is tracked
  await page.locator("#other-source").waitFor();
  await settled(page);
  await placeSeed(page, place);
  await page.locator("#seed-list .item").first().waitFor();
  await page.locator("#track-all").click();
  await reported(page, /belong to one patient/, "error");
  await page.locator("#find").click();
  await reported(page, /belong to one patient/, "error");
  await page.locator("#answer-source").click();
  await page.locator("#ask-accept").click();
  await page.locator("#other-source").waitFor({ state: "hidden" });
  await page.keyboard.press("Control+s");
  await reported(page, /is saved, with 1 seed that waits/);
  const saved = lumen("info", file("vessels.lumen"));
  assert.equal(saved.seeds.waiting, 1);
  assert.ok(JSON.stringify(saved.provenance.steps).includes("accept-volume"));
}

story("work after a crash is taken up, others' changes are seen, and mistakes change nothing", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    [place] = phantom(file, "kissing", { "vessels.lumen": 2, "vessels.unsaved.lumen": 1 });
  copyFileSync(file("vessels.lumen"), file("copy.lumen"));
  lumen("phantom", "kissing", file("other.nrrd"), "--noise", "0.2", "--seed", "7");
  const { address } = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openPage(t, browser, address),
    question = page.locator("dialog[open]");
  await question.filter({ hasText: "vessels.unsaved.lumen holds work" }).waitFor();
  assert.match(await question.textContent(), /after vessels\.lumen/);
  await picture(page, "recovered-question");
  await step(page, () => page.locator("#ask-recover").click());
  assert.equal((await vessels(page)).length, 1);
  await page.locator("#unsaved").waitFor();
  await undo(page);
  assert.equal((await vessels(page)).length, 2);

  await dropBroken(page, file);
  await shareWith(t, browser, address, page);
  await page.locator("#find").click();
  await page.locator("#cancel").waitFor();
  await page.keyboard.press("Escape");
  await page.locator("#progress").waitFor({ state: "hidden" });
  await page.locator("#find:enabled").waitFor();
  assert.equal(await page.locator("#proposal-list .item").count(), 0, "finding was cancelled");
  await overwrite(page, file);
  await keepApart(page, file, place);
});
