// SPDX-License-Identifier: Apache-2.0
// Times of the page, in Chromium without a graphics processor: LUMEN=... node times.mjs FILE..., which `lumen view` is given.
// Prints milliseconds: from asking for the page to the first whole picture, and from a click in the list of vessels to the next
// one with that vessel marked, for twelve clicks; of a volume, for one picture while the crosshair moves through slabs of
// 60 mm in all slices, on the clock and of processor. And MiB of the page's process, and the load of the machine.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { chromium } from "playwright-core";
import { kChromium, kPatience } from "./browser.mjs";
import { view } from "./lumen.mjs";
import { drawMoving, noteDrawings } from "./turning.mjs";

const kSettle = 1000 * Number(process.env.SETTLE ?? 30); // ms until finer surfaces are there
const kClicks = 12,
  kSlab = 60, // mm
  kPictures = 15,
  kBetween = 1500; // ms

const endings = [],
  t = { after: call => endings.unshift(call) };
const { address } = await view(t, ...process.argv.slice(2));
const browser = await chromium.launch({
  executablePath: kChromium,
  args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"],
});
t.after(() => browser.close());
const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
await page.addInitScript(noteDrawings);
await page.goto(address);
await page.waitForFunction(() => performance.getEntriesByName("lumen-first-picture").length > 0, null, {
  timeout: kPatience,
  polling: 20,
});
const firstPicture = await page.evaluate(
  () => performance.getEntriesByName("lumen-first-picture")[0].startTime,
);
await page.waitForTimeout(kSettle);
const vessels = await page.locator("#tree-list [role=treeitem]").count(),
  selected = [];
for (let i = 0; vessels > 1 && i < kClicks; ++i) {
  selected.push(
    await page.evaluate(
      async k => {
        const begin = performance.now();
        document.querySelectorAll("#tree-list [role=treeitem]")[k].click();
        await new Promise(drawn => requestAnimationFrame(() => setTimeout(drawn, 0))); // after the frame's own work
        return performance.now() - begin;
      },
      1 + (i % (vessels - 1)),
    ),
  );
  await page.waitForTimeout(kBetween);
}
let slab = null;
if (await page.locator("#section-volume").isVisible()) {
  for (const name of ["axial", "coronal", "sagittal"]) {
    await page.locator(`#slab-${name}`).selectOption("max");
    await page.locator(`#slab-${name}-mm`).fill(String(kSlab));
    await page.locator(`#slab-${name}-mm`).press("Tab");
  }
  await drawMoving(page, kPictures, process.pid, "#view-axial"); // the first ones are slower
  slab = await drawMoving(page, kPictures, process.pid, "#view-axial");
}
const sorted = selected.toSorted((a, b) => a - b),
  rounded = x => Math.round(x ?? NaN);
const resident = execFileSync("ps", ["-eo", "rss,args"], { encoding: "utf8" })
  .split("\n")
  .filter(line => line.includes("--type=renderer"))
  .map(line => Number.parseInt(line, 10) / 1024);
console.log(
  JSON.stringify({
    firstPicture: rounded(firstPicture),
    select: { median: rounded(sorted[kClicks >> 1]), greatest: rounded(sorted.at(-1)) },
    slab: slab === null ? null : { wall: rounded(slab.wall), processor: rounded(slab.processor) },
    page: rounded(Math.max(...resident)),
    load: Number(readFileSync("/proc/loadavg", "utf8").split(" ")[0]),
  }),
);
for (const end of endings) await end();
