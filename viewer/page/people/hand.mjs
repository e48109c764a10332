// SPDX-License-Identifier: Apache-2.0
// A hand on mouse and keys. Where it points it reads off the line below the views, as a person would.
import { readFileSync, writeFileSync } from "node:fs";
import { frames, openPage, settled } from "./browser.mjs";
import { lumen, view } from "./lumen.mjs";

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

/** Two vessels of a phantom: volume.nrrd, seeds.json and vessels.lumen. */
export function bothVessels(file, phantom) {
  lumen("phantom", phantom, file("volume.nrrd"), "--seeds", file("seeds.json"));
  lumen("convert", file("volume.nrrd"), file("vessels.lumen"), "--seeds", file("seeds.json"), "--seeds-only");
}

/** Two vessels that touch. */
export const kissing = file => bothVessels(file, "kissing");

/** The same phantom, with a case of its first vessel alone. */
export function firstVessel(file, phantom, target = "vessels.lumen") {
  lumen("phantom", phantom, file("volume.nrrd"), "--seeds", file("seeds.json"));
  const seeds = JSON.parse(readFileSync(file("seeds.json"), "utf8"));
  writeFileSync(file("one.json"), JSON.stringify({ ...seeds, branches: seeds.branches.slice(0, 1) }));
  lumen("convert", file("volume.nrrd"), file(target), "--seeds", file("one.json"), "--seeds-only");
}

/** A page of the phantom's volume and case. */
export async function openVessels(t, browser, file) {
  const server = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  return page;
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
