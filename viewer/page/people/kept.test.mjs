// SPDX-License-Identifier: Apache-2.0
// The view that a person has set up is there after a reload, in a file beside the case, and work after a crash.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { bothVessels, drop, firstVessel, openVessels, vessel, vessels } from "./hand.mjs";
import { makeFolder, view } from "./lumen.mjs";

const measured = page => page.locator("#measure-list .item"),
  place = async page =>
    (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number),
  near = (a, b) => a.every((x, i) => Math.abs(x - b[i]) < 0.011);

async function goTo(page, text) {
  await page.keyboard.press("j");
  await page.locator("#ask-text").fill(text);
  await page.keyboard.press("Enter");
  await page.locator("#ask-text").waitFor({ state: "detached" });
  await page.mouse.move(5, 300); // away from the views, so that the line shows the crosshair
}

story("coordinates are typed and shown in the axes that the user chose", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  bothVessels(file, "bifurcation");
  const page = await openVessels(t, browser, file);
  await goTo(page, "10.5, 11 12");
  assert.ok(near(await place(page), [10.5, 11, 12]));
  assert.equal(await page.locator("#probe-position").textContent(), "10.50  11.00  12.00");
  await page.locator("#probe-frame").click();
  assert.equal(await page.locator("#probe-frame").textContent(), "RAS");
  assert.equal(await page.locator("#probe-position").textContent(), "-10.50  -11.00  12.00");
  await goTo(page, "-9 -8 7");
  assert.ok(near(await place(page), [9, 8, 7]), "typed in the axes that are shown");
  await goTo(page, "somewhere");
  await page.locator(".toast.warning").filter({ hasText: "is no place" }).waitFor();
});

story(
  "measurements, hidden vessels, window and colours survive a reload, and go along as a file",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t);
    bothVessels(file, "bifurcation");
    const server = await view(t, file("volume.nrrd"), file("vessels.lumen")),
      page = await openPage(t, browser, server.address);
    await settled(page);
    const [first, second] = await vessels(page);
    await vessel(page, second).click();
    await page.keyboard.press("h");
    await page.locator("#measure-probe").click();
    await measured(page).first().waitFor();
    await page.keyboard.press("2");
    await page.locator("#probe-frame").click();
    await page.waitForTimeout(600); // until the page has kept it
    await page.reload();
    await settled(page);
    await measured(page).first().waitFor();
    assert.equal(await page.locator("#probe-frame").textContent(), "RAS");
    assert.equal(await page.locator("#layout").inputValue(), "rows");
    const hidden = p => p.locator("#tree-list [role=treeitem].off").count();
    assert.equal(await hidden(page), 1, `${second} is hidden, ${first} is not`);
    await picture(page, "1-after-reload");

    const [csv] = await Promise.all([page.waitForEvent("download"), page.locator("#measure-csv").click()]);
    const rows = readFileSync(await csv.path(), "utf8")
      .trim()
      .split("\n");
    assert.equal(rows.length, 2);
    assert.match(rows[0], /^number,kind,result,about,x_mm_lps/);
    const [kept] = await Promise.all([
      page.waitForEvent("download"),
      page.locator("#export").selectOption("view"),
    ]);
    assert.match(kept.suggestedFilename(), /\.view\.json$/);
    const bytes = readFileSync(await kept.path());

    const fresh = await (await browser.newContext()).newPage();
    await fresh.goto(server.address);
    await settled(fresh);
    assert.equal(await measured(fresh).count(), 0, "another tab has its own view");
    await drop(fresh, "any.view.json", bytes);
    await measured(fresh).first().waitFor();
    assert.equal(await hidden(fresh), 1);
    await drop(fresh, "bad.view.json", Buffer.from("{}"));
    await fresh.locator(".toast.error").filter({ hasText: "bad.view.json is no view" }).waitFor();
  },
);

story("after a crash the page asks in the middle what becomes of the work, and takes it up", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  bothVessels(file, "bifurcation");
  firstVessel(file, "bifurcation", "vessels.unsaved.lumen");
  const server = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openPage(t, browser, server.address);
  const question = page.locator("dialog[open]");
  await question.filter({ hasText: "vessels.unsaved.lumen holds work" }).waitFor();
  assert.match(await question.textContent(), /after vessels\.lumen/);
  await picture(page, "2-take-up");
  await page.locator("#ask-recover").click();
  await page.locator("#tree-list [role=treeitem]").nth(1).waitFor({ state: "detached" });
  assert.equal((await vessels(page)).length, 1);
  await page.locator("#unsaved").waitFor();
});
