// SPDX-License-Identifier: Apache-2.0
// A hand on mouse and keys. Where it points it reads off the line below the views, as a person would.
import { readFileSync, writeFileSync } from "node:fs";
import { frames, settled } from "./browser.mjs";
import { lumen } from "./lumen.mjs";

const subtract = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);

/** Position under the pointer at a pixel of a view, mm. */
async function pointedAt(page, box, x, y) {
  await page.mouse.move(box.x + x, box.y + y);
  await frames(page, 3);
  return (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number);
}

/** The pixel of the page at which a slice shows a position, which may lie before or behind the slice. */
export async function placeIn(page, view, position) {
  const box = await page.locator(`#view-${view}`).boundingBox(),
    x = Math.round(box.width / 2),
    y = Math.round(box.height / 2),
    step = 50;
  const origin = await pointedAt(page, box, x, y);
  const right = subtract(await pointedAt(page, box, x + step, y), origin),
    down = subtract(await pointedAt(page, box, x, y + step), origin);
  const wanted = subtract(position, origin);
  return {
    x: box.x + x + (step * dot(wanted, right)) / dot(right, right),
    y: box.y + y + (step * dot(wanted, down)) / dot(down, down),
  };
}

export async function clickIn(page, view, position, options = {}) {
  const { x, y } = await placeIn(page, view, position);
  await page.mouse.click(x, y, options);
  await frames(page);
}

/** Puts the crosshair on a position with two clicks: the first brings the axial slice to its height. */
export async function lookAt(page, position) {
  await page.locator("#tool-navigate").click();
  await clickIn(page, "coronal", position);
  await clickIn(page, "axial", position);
}

/** Places a seed at a position by a click in the axial slice. */
export async function placeSeed(page, position) {
  await lookAt(page, position);
  await page.keyboard.press("s");
  await clickIn(page, "axial", position);
}

/** The place that the line below the views shows, mm: that of the pointer, or of the crosshair while it is elsewhere. */
export const position = async page =>
  (await page.locator("#probe-position").getAttribute("data-mm")).split(" ").map(Number);

/** The place of the crosshair, mm. */
export async function crosshair(page) {
  await page.mouse.move(2, 300);
  await frames(page, 3);
  return position(page);
}

/** mm between two places. */
export const away = (a, b) => Math.hypot(...subtract(a, b));

/** Performs one step, and waits until the page shows that it is done. */
export async function step(page, act) {
  const title = await page.locator("#undo").getAttribute("title");
  await act();
  await page.locator(`#undo:enabled:not([title=${JSON.stringify(title)}])`).waitFor();
  await settled(page);
}

export async function undo(page) {
  const title = await page.locator("#undo").getAttribute("title");
  await page.locator("#undo").click();
  await page.locator(`#undo:not([title=${JSON.stringify(title)}])`).waitFor({ state: "attached" });
  await settled(page);
}

/** Brings the cursor and the crosshair to the middle node of a vessel. */
export async function toMiddle(page, label) {
  await vessel(page, label).locator(".name").dblclick();
  await page
    .locator("#edit-name")
    .filter({ hasText: `${label}, cursor at node` })
    .waitFor();
  await frames(page);
}

/** Radius at the cursor, mm, as the strip shows it. */
export const radius = async page =>
  Number((await page.locator("#strip .striphead .note").textContent()).match(/radius ([\d.]+) mm/)[1]);

/** Drags the pointer between two places of a slice, mm. */
export async function dragIn(page, view, from, to) {
  const begin = await placeIn(page, view, from),
    end = await placeIn(page, view, to);
  await page.mouse.move(begin.x, begin.y);
  await frames(page, 3);
  await page.mouse.down();
  await page.mouse.move(end.x, end.y, { steps: 5 });
  await page.mouse.up();
}

/** Answers a question for a text. */
export async function type(page, text) {
  await page.locator("#ask-text").fill(text);
  await page.keyboard.press("Enter");
  await page.locator("#ask-text").waitFor({ state: "detached" });
}

/** The labels of the list of vessels, from top to bottom. */
export const vessels = page => page.locator("#tree-list [role=treeitem] .name").allTextContents();

/** The row of a vessel in the list. */
export const vessel = (page, label) =>
  page
    .locator("#tree-list [role=treeitem]")
    .filter({ has: page.locator(".name", { hasText: new RegExp(`^${label}$`) }) });

/** Drops a file onto the page. */
export const drop = (page, name, bytes) => dropFiles(page, [{ name, bytes }]);

/** Drops several files at once. */
export async function dropFiles(page, files) {
  const transfer = await page.evaluateHandle(
    list => {
      const data = new DataTransfer();
      for (const [file, text] of list)
        data.items.add(new File([Uint8Array.from(atob(text), c => c.charCodeAt(0))], file));
      return data;
    },
    files.map(({ name, bytes }) => [name, Buffer.from(bytes).toString("base64")]),
  );
  for (const type of ["dragenter", "dragover", "drop"])
    await page.dispatchEvent("#views", type, { dataTransfer: transfer });
}

/** Waits for a message and gives its text. */
export async function reported(page, pattern, severity = "") {
  const toast = page
    .locator(`#toasts .toast${severity === "" ? "" : `.${severity}`}`)
    .filter({ hasText: pattern })
    .last();
  await toast.waitFor();
  return toast.locator("span").textContent();
}

/** The bytes of the document's case, as a download. */
export async function document(page) {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.locator("#export").selectOption("lumen"),
  ]);
  return readFileSync(await download.path());
}

/** A phantom: volume.nrrd and seeds.json, and for each name a case of its first vessels, { "one.lumen": 1 }. */
export function phantom(file, name, cases, ...options) {
  lumen("phantom", name, file("volume.nrrd"), "--seeds", file("seeds.json"), ...options);
  const seeds = JSON.parse(readFileSync(file("seeds.json"), "utf8"));
  for (const [target, count] of Object.entries(cases)) {
    writeFileSync(file("some.json"), JSON.stringify({ ...seeds, branches: seeds.branches.slice(0, count) }));
    lumen("convert", file("volume.nrrd"), file(target), "--seeds", file("some.json"), "--seeds-only");
  }
  return seeds.branches.map(branch => branch.points[0].position);
}

/** Checks the case against its volume by a key, until the page has the answer. */
export async function checkCase(page) {
  await page.keyboard.press("k");
  await page
    .locator("#check-about")
    .filter({ hasText: "the wall is off" })
    .filter({ hasNotText: "check again" })
    .waitFor();
  await settled(page);
}
