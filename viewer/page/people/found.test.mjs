// SPDX-License-Identifier: Apache-2.0
// A whole tree without a click: vessels are found, proposed, accepted or rejected, and saved.
import assert from "node:assert/strict";
import { find, frames, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { reported, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const proposals = page => page.locator("#proposal-list .item");
const proposal = (page, label) => page.locator(`#proposal-list .item[data-label="${label}"]`);
const labels = page => proposals(page).evaluateAll(rows => rows.map(row => row.dataset.label));
const dashed = (r, g, b) => r > 215 && b > 215 && g < 110; // the magenta of proposals, which no vessel has

/** Waits until N proposals are listed, and the page rests. */
async function waiting(page, count) {
  await page.waitForFunction(n => document.querySelectorAll("#proposal-list .item").length === n, count);
  await settled(page);
}

story(
  "a volume becomes a saved tree: some vessels are accepted, one is rejected, the rest at once",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t);
    lumen("phantom", "patient", file("angiogram.nrrd"), "--size", "128");
    const server = await view(t, file("angiogram.nrrd"), file("vessels.lumen")),
      page = await openPage(t, browser, server.address);
    await settled(page);
    await page.locator("#find-about").filter({ hasText: "without a click" }).waitFor();
    await picture(page, "12-opened");

    await page.keyboard.press("Shift+F");
    await reported(page, /vessels are proposed/);
    await settled(page);
    const found = await labels(page);
    assert.ok(found.length >= 10, `${found.length} vessels are proposed`);
    assert.deepEqual(await vessels(page), [], "nothing is part of the case yet");
    assert.equal(await page.locator("#save").isDisabled(), true);
    await picture(page, "12-proposed");
    const shrunk = await proposals(page).evaluateAll(
      rows => rows.filter(row => row.clientHeight < row.scrollHeight).length,
    );
    assert.equal(shrunk, 0, "no row of the list is shorter than what it holds");
    for (const each of ["#view-scene", "#view-axial"]) {
      const { count } = find(await pixels(page, each), dashed);
      assert.ok(count > 20, `${count} pixels of proposals in ${each}`);
    }

    // a click in the list leads to the place, and marks it
    const chosen = proposal(page, found[2]);
    await chosen.locator(".link").click();
    await frames(page);
    assert.match(await chosen.getAttribute("class"), /chosen/);
    const figures = await chosen.locator(".figures").textContent();
    const [, confidence] = /confidence ([01]\.\d\d)/.exec(figures) ?? [];
    assert.ok(Number(confidence) > 0 && Number(confidence) <= 1, figures);
    await picture(page, "12-shown");

    // one that hangs on another that waits takes it along
    const child = page.locator("#proposal-list .item").filter({
      has: page.getByRole("button", { name: /and its parents/ }),
    });
    const label = await child.first().getAttribute("data-label"),
      parent = (await child.first().locator(".note").textContent()).replace("on ", "");
    await proposal(page, label)
      .getByRole("button", { name: `Accept ${label}` })
      .click();
    await reported(page, /accepted/);
    await settled(page);
    const accepted = await vessels(page);
    assert.ok(accepted.includes(label) && accepted.includes(parent), `${accepted} with ${label}, ${parent}`);
    await waiting(page, found.length - accepted.length);
    await picture(page, "12-one-accepted");

    // undo brings it back among the proposals; redo takes it again
    await page.locator("#undo").click();
    await waiting(page, found.length);
    assert.deepEqual(await vessels(page), []);
    assert.deepEqual(await labels(page), found);
    await page.locator("#redo").click();
    await waiting(page, found.length - accepted.length);

    const last = (await labels(page)).at(-1);
    await proposal(page, last)
      .getByRole("button", { name: `Reject ${last}` })
      .click();
    await waiting(page, found.length - accepted.length - 1);
    await page.locator("#accept-all").click();
    await page.locator("#proposal-list").waitFor({ state: "hidden" });
    await settled(page);
    const all = await vessels(page);
    assert.equal(all.length, found.length - 1);
    assert.ok(!all.includes(last), "the rejected one is no vessel");
    assert.equal(find(await pixels(page, "#view-axial"), dashed).count, 0, "nothing is dashed any more");
    await picture(page, "12-all-accepted");

    // what the case has is not proposed again, but for the one that was rejected
    await page.locator("#find").click();
    await reported(page, /proposed|lacks/);
    await settled(page);
    assert.ok(
      (await proposals(page).count()) <= 3,
      `${await proposals(page).count()} vessels are proposed again`,
    );
    if ((await proposals(page).count()) > 0) await page.locator("#reject-all").click();
    await page.locator("#proposal-list").waitFor({ state: "hidden" });
    await settled(page); // saving refuses a document that changes meanwhile

    await page.keyboard.press("Control+s");
    await page.locator("#unsaved").waitFor({ state: "hidden" });
    const saved = lumen("info", file("vessels.lumen"));
    assert.equal(saved.branches, found.length - 1);
    assert.ok(saved.blobs > 0, "the vessels have their models");
    assert.equal(lumen("validate", file("vessels.lumen")).valid, true);
  },
);

story("finding is cancelled, and what cannot be found is reported", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "patient", file("angiogram.nrrd"));
  const server = await view(t, file("angiogram.nrrd")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await page.locator("#find").click();
  await page.locator("#cancel").waitFor();
  await page.keyboard.press("Escape");
  await settled(page);
  assert.equal(await proposals(page).count(), 0);
  assert.equal(await page.locator("#undo").isDisabled(), true, "nothing has changed");
});

story("proposals in a light and narrow window", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "bifurcation", file("volume.nrrd"));
  const server = await view(t, file("volume.nrrd")),
    page = await openPage(t, browser, server.address, {
      viewport: { width: 900, height: 640 },
      colorScheme: "light",
    });
  await settled(page);
  await page.locator("#fold-right").click(); // in a narrow window panels are folded at first
  await page.locator("#find").click();
  await waiting(page, 2);
  await picture(page, "12-narrow-light");
  const box = await page.locator("#section-find").boundingBox();
  for (const name of ["#accept-all", "#reject-all", "#find"]) {
    const inner = await page.locator(name).boundingBox();
    assert.ok(
      inner.x >= box.x && inner.x + inner.width <= box.x + box.width,
      `${name} is inside of its panel`,
    );
  }
  // by keys alone: the button that was pressed leaves the keys to the row that follows
  await proposals(page)
    .first()
    .getByRole("button", { name: /^Reject/ })
    .focus();
  await page.keyboard.press("Enter");
  await waiting(page, 1);
  assert.match(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), /^Reject /);
});
