// SPDX-License-Identifier: Apache-2.0
// A heart's arteries beat: play, a time by the slider, a pick at that time, and corrections at rest.
import assert from "node:assert/strict";
import { pathToFileURL } from "node:url";
import { find, frames, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { clickIn, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const kPeriod = 0.8; // s
const kPhases = 4;

/** rest.lumen, beating.lumen and volumes beat-00.nrrd and so on of a phantom. */
function beatingHeart(file) {
  lumen(
    "phantom",
    "coronary",
    file("beat.nrrd"),
    "--voxel",
    "0.8",
    "--motion",
    "heart",
    "--phases",
    `${kPhases}`,
  );
  const phases = Array.from({ length: kPhases }, (_, i) => file(`beat-0${i}.nrrd`));
  lumen("convert", phases[0], file("rest.lumen"));
  lumen("motion", file("rest.lumen"), ...phases, "--out", file("beating.lumen"), "--period", `${kPeriod}`);
}

/** Pixels of two pictures of one size that differ clearly. */
function different(a, b) {
  assert.deepEqual([a.width, a.height], [b.width, b.height]);
  let count = 0;
  for (let i = 0; i < a.data.length; i += 4)
    if ([0, 1, 2].some(c => Math.abs(a.data[i + c] - b.data[i + c]) > 40)) ++count;
  return count;
}

const time = async page => Number(await page.locator("#motion-time").inputValue());
const isAtRest = page => page.locator("#motion-rest[aria-pressed=true]").waitFor();
const kDrawn = 700; // ms after which a view that has come to rest is drawn in full

/** The 3D view when it has come to rest, without the bar. */
async function scene(page) {
  await page.waitForTimeout(kDrawn);
  await page.locator("#motion").evaluate(bar => (bar.style.visibility = "hidden"));
  const shown = await pixels(page, "#view-scene");
  await page.locator("#motion").evaluate(bar => (bar.style.visibility = ""));
  return shown;
}

story("a heart beats in the 3D view, and stands still where it is told to", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  beatingHeart(file);
  const server = await view(t, file("beating.lumen"), "--time", "0.3"),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await page.locator("body[data-surface=closed]").waitFor();
  await page.keyboard.press("3"); // 3D alone
  assert.equal(await time(page), 0.3, "the page begins at the time of --time");
  const systole = await scene(page);
  await picture(page, "15-motion-at-0.3");

  await page.locator("#motion-rest").click();
  await isAtRest(page);
  const rest = await scene(page);
  await picture(page, "15-motion-at-rest");
  assert.ok(different(systole, rest) > 2000, `${different(systole, rest)} pixels differ from those at rest`);

  // the slider by keys; --time and the slider show one picture of one time
  await page.locator("#motion-slider").focus();
  await page.keyboard.press("End");
  assert.ok(Math.abs((await time(page)) - kPeriod) < 1e-9);
  await page.keyboard.press("ArrowLeft");
  assert.ok((await time(page)) < kPeriod && (await time(page)) > 0.9 * kPeriod, "an arrow is a small step");
  await page.keyboard.press("Home");
  assert.equal(await time(page), 0);
  await page.locator("#motion-time").fill("0.3");
  await page.keyboard.press("Enter");
  assert.ok(different(systole, await scene(page)) < 50, "the same time has the same picture");

  // a vessel is picked where it is
  const { at } = find(systole, (r, g, b) => r < 40 && g > 90 && b > 120),
    box = await page.locator("#view-scene").boundingBox(),
    selected = page.locator("#tree-list [role=treeitem][aria-selected=true] .name");
  await page.mouse.click(box.x + at.x, box.y + at.y);
  await selected.filter({ hasText: "vessel-2" }).waitFor();
  await page.locator("#motion-rest").click();
  await isAtRest(page);
  await page.mouse.click(box.x + at.x, box.y + at.y);
  await selected.waitFor({ state: "detached" });

  // play and pause by the key and by the button
  await page.locator("#view-scene").focus();
  await page.keyboard.press("Space");
  await page.getByRole("button", { name: "Stop the motion" }).waitFor();
  const seen = new Set();
  for (let k = 0; k < 200 && seen.size < 5; ++k) {
    seen.add(await time(page));
    await frames(page, 2);
  }
  assert.ok(seen.size >= 5, `the time stands at ${[...seen]}`);
  assert.ok([...seen].every(s => s >= 0 && s <= kPeriod));
  await page.getByRole("button", { name: "Stop the motion" }).click();
  await page.getByRole("button", { name: "Play the motion" }).waitFor();
  const stopped = await time(page);
  await frames(page, 5);
  assert.equal(await time(page), stopped, "a motion that was stopped stays");
});

story("outlines move over the volume, and vessels are corrected at rest", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  beatingHeart(file);
  const server = await view(t, file("beat-00.nrrd"), file("beating.lumen")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await page.locator("body[data-surface=closed]").waitFor();
  await isAtRest(page);
  const wall = page.locator("#probe-distance");
  assert.match(await wall.textContent(), /mm/);

  // outlines move over the volume, which stays
  await page.waitForTimeout(kDrawn);
  const before = await pixels(page, "#view-axial");
  await page.locator("#motion-time").fill("0.3");
  await page.keyboard.press("Enter");
  await page.locator("#motion-hint", { hasText: "the volume does not" }).waitFor();
  await page.waitForTimeout(kDrawn);
  assert.ok(different(before, await pixels(page, "#view-axial")) > 20, "outlines have moved");
  assert.equal(await wall.textContent(), "–", "libblob answers for the case at rest");
  await picture(page, "15-motion-over-a-volume");

  // a correction goes back to rest first, and is done when it is asked for again
  const names = await vessels(page);
  await page.locator("#tree-list [role=treeitem]").last().click();
  await page.keyboard.press("Delete");
  await isAtRest(page);
  await page.locator("#toasts .toast", { hasText: "at rest" }).waitFor();
  assert.deepEqual(await vessels(page), names, "nothing is deleted at another time");
  await page.keyboard.press("Delete");
  await page.waitForFunction(
    n => document.querySelectorAll("#tree-list [role=treeitem]").length < n,
    names.length,
  );
  await settled(page);
  await page.locator("#motion").waitFor(); // the vessels that are left go on moving

  // a tool, too
  await page.locator("#motion-play").click();
  await page.locator("#motion-rest[aria-pressed=false]").waitFor();
  await page.keyboard.press("d");
  await isAtRest(page);
  await page.getByRole("button", { name: "Play the motion" }).waitFor();
});

story("a page as one file plays, and a case that stands still has no bar", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  beatingHeart(file);
  lumen("view", file("beating.lumen"), "--time", "0.3", "--html", file("beating.html"));
  const page = await openPage(t, browser, pathToFileURL(file("beating.html")).href, { offline: true });
  await settled(page);
  await page.keyboard.press("3");
  assert.equal(await time(page), 0.3);
  const systole = await scene(page);
  await page.locator("#motion-rest").click();
  await isAtRest(page);
  const moved = different(systole, await scene(page));
  assert.ok(moved > 2000, `${moved} pixels differ from those at rest`);

  const still = await view(t, file("rest.lumen")),
    other = await openPage(t, browser, still.address);
  await settled(other);
  assert.ok(await other.locator("#motion").isHidden());
  await clickIn(other, "axial", [0, 0, 0]);
  await other.locator("#view-scene").focus();
  await other.keyboard.press("Space");
  assert.ok(await other.locator("#motion").isHidden());
});
