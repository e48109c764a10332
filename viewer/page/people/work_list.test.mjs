// SPDX-License-Identifier: Apache-2.0
// The check is a list of work: a person walks through it by keys, and it ends with nothing left.
import assert from "node:assert/strict";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { checkCase, firstVessel, openVessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const rows = (page, kind) =>
    page.locator(`#work-list .item${kind === undefined ? "" : `[data-kind="${kind}"]`}`),
  counts = async page => (await page.locator("#work-count").textContent()).match(/\d+/g).map(Number);

/** The place of the row that is shown: crosshair and row agree. */
async function shown(page) {
  const row = page.locator("#work-list .item.chosen");
  await row.waitFor();
  return (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number);
}

async function ignore(page, reason) {
  await page.keyboard.press("i");
  await page.locator("#ask-text").fill(reason);
  await page.keyboard.press("Enter");
}

/** A page of the trunk alone, cut in two: its piece hangs on nothing, and the other vessel is missing. */
async function openCut(t, browser, file) {
  firstVessel(file, "bifurcation");
  const page = await openVessels(t, browser, file);
  await page.locator("#tree-list [role=treeitem]").first().click();
  await settled(page);
  await page.keyboard.press("Shift+X");
  await page.locator("#tree-list [role=treeitem]").nth(1).waitFor();
  await settled(page);
  await checkCase(page);
  return page;
}

story(
  "a list of places is tracked, joined and ignored by keys until nothing is left, and the case keeps why",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t);
    const page = await openCut(t, browser, file);
    const found = await rows(page).count();
    assert.deepEqual(await counts(page), [0, found]);
    assert.equal(await rows(page, "loose").count(), 1, "the piece behind the cut");
    assert.ok(
      (await rows(page, "missing").count()) + (await rows(page, "early-end").count()) > 0,
      "the second vessel",
    );

    await page.keyboard.press(".");
    await shown(page);
    assert.equal(await page.locator("#work-list .item.chosen").getAttribute("data-kind"), "loose");
    await picture(page, "1-loose");
    await page.keyboard.press("y");
    await page.locator("#work-list .item[data-kind=loose]").waitFor({ state: "detached" });
    await settled(page);
    assert.equal((await counts(page))[1], found, "the list is that of the last check");

    // walk to what is missing, and track it from there
    const before = await page.locator("#tree-list [role=treeitem]").count(),
      wanted = page.locator("#work-list .item.chosen:is([data-kind=missing], [data-kind=early-end])");
    for (let i = 0; i < found && (await wanted.count()) === 0; ++i) await page.keyboard.press(".");
    const there = await shown(page);
    await picture(page, "2-missing");
    await page.keyboard.press("y");
    await page.locator("#tree-list [role=treeitem]").nth(before).waitFor();
    await settled(page);
    assert.equal(await page.locator("#seed-list .item").count(), 0, "its seed is tracked");
    await page.keyboard.press("Control+z");
    await page.locator("#tree-list [role=treeitem]").nth(before).waitFor({ state: "detached" });
    assert.equal(await page.locator("#seed-list .item").count(), 0, "seed and vessel are one change");
    assert.ok(there.every(Number.isFinite));

    // instead, all is ignored with a reason
    await settled(page);
    for (let left = await rows(page).count(); left > 0; left = await rows(page).count()) {
      await page.keyboard.press(".");
      await shown(page);
      await ignore(page, "a vein, by its late contrast");
      await page.waitForFunction(n => document.querySelectorAll("#work-list .item").length < n, left);
    }
    await page.locator("#check-about").filter({ hasText: "Nothing is left" }).waitFor();
    assert.deepEqual(await counts(page), [found, found]);
    await page.locator("#ignored summary").click();
    await picture(page, "3-nothing-left");
    assert.ok((await page.locator("#ignored-list .item").count()) > 0);
    await page.keyboard.press("Control+s");
    await page.locator(".toast").filter({ hasText: "saved" }).waitFor();

    const fresh = await openVessels(t, browser, file);
    await checkCase(fresh);
    assert.equal(await rows(fresh).count(), 0, "what is ignored stays so in the file");
    await fresh.locator("#ignored summary").click();
    const kept = await fresh.locator("#ignored-list .item").count();
    assert.ok(kept > 0);
    await fresh.locator("#ignored-list .item .button").first().click();
    await fresh.waitForFunction(n => document.querySelectorAll("#ignored-list .item").length < n, kept);
    assert.ok((await rows(fresh).count()) > 0, "what is heeded again is back");
  },
);

story("a button that changes a vessel shows the place first, and acts when it is pressed again", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  const page = await openCut(t, browser, file);
  const remove = page.locator("#work-list .item[data-kind=loose] .button.delete");
  await remove.click();
  await page.locator(".toast").filter({ hasText: "once more deletes" }).waitFor();
  assert.equal(await page.locator("#tree-list [role=treeitem]").count(), 2, "nothing is deleted yet");
  await remove.click();
  await page.locator("#tree-list [role=treeitem]").nth(1).waitFor({ state: "detached" });
  assert.equal(await rows(page, "loose").count(), 0);
});

story(
  "in a new volume the found vessels are the list: a key shows one, another accepts or rejects it",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t);
    lumen("phantom", "kissing", file("volume.nrrd"));
    const server = await view(t, file("volume.nrrd"), file("vessels.lumen")),
      page = await openPage(t, browser, server.address);
    await settled(page);
    await page.keyboard.press("Shift+F");
    await page.locator("#proposal-list .item").nth(1).waitFor();
    await settled(page);
    await page.keyboard.press(".");
    await page.locator("#proposal-list .item.chosen").waitFor();
    await picture(page, "4-proposal");
    await page.keyboard.press("y");
    await page.locator("#tree-list [role=treeitem]").first().waitFor();
    await settled(page);
    assert.equal(await page.locator("#proposal-list .item").count(), 1);
    await page.keyboard.press(".");
    await page.locator("#proposal-list .item.chosen").waitFor();
    await page.keyboard.press("i");
    await page.locator("#proposal-list .item").waitFor({ state: "detached" });
  },
);
