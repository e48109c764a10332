// SPDX-License-Identifier: Apache-2.0
// Debian's Chromium without a window, with WebGL 2 in software.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { chromium } from "playwright-core";

export const kChromium = process.env.CHROMIUM ?? "/usr/bin/chromium";
const kPictures = process.env.LUMEN_PICTURES ?? "people-pictures";
export const kPatience = Number(process.env.LUMEN_PATIENCE ?? 180_000); // ms: other work may keep the machine busy; no test is about time

/** A test that leaves a picture of every page behind where it fails. */
export function story(name, steps) {
  test(name, async t => {
    const pages = [];
    try {
      await steps(Object.assign(t, { pages }));
    } catch (error) {
      for (const [i, page] of pages.entries())
        if (!page.isClosed())
          await picture(page, `failed-${name.replaceAll(/[^a-z]+/gi, "-")}-${i + 1}`).catch(() => undefined);
      throw error;
    }
  });
}

/** A browser that is closed with the test. */
export async function startBrowser(t) {
  const browser = await chromium.launch({
    executablePath: kChromium,
    timeout: kPatience,
    // root, as on a machine that only tests, has no sandbox; /dev/shm is small in containers
    args: [
      "--no-sandbox",
      "--disable-dev-shm-usage",
      "--enable-unsafe-swiftshader",
      "--use-angle=swiftshader",
      "--force-color-profile=srgb",
    ],
  });
  t.after(() => browser.close());
  return browser;
}

/** A page whose mistakes fail the test at its end: what it throws, what its policy refuses, what it warns of. */
export async function openPage(t, browser, address, { prepare = () => undefined, ...options } = {}) {
  const context = await browser.newContext({
    viewport: { width: 1100, height: 720 }, // the less, the less is drawn by the processor
    colorScheme: "dark",
    acceptDownloads: true,
    ...options,
  });
  await prepare(context);
  const page = await context.newPage(),
    mistakes = [];
  t.pages.push(page);
  page.setDefaultTimeout(kPatience);
  page.on("pageerror", error => mistakes.push(String(error)));
  page.on("console", message => {
    if (["error", "warning"].includes(message.type()) && !isOfTheDriver(message.text()))
      mistakes.push(message.text());
  });
  t.after(() => {
    if (mistakes.length > 0) throw new Error(`the page complained:\n${mistakes.join("\n")}`);
  });
  await page.goto(address, { timeout: kPatience });
  await page.locator("body[data-ready]").waitFor();
  return page;
}
// software WebGL says so, and that reading pixels back is slow; a refusal by the server is logged as such
const isOfTheDriver = text =>
  /GPU stall|swiftshader|GL Driver Message/i.test(text) ||
  /Failed to load resource.*(400|404|409)/.test(text);

/** Until nothing works any more, and the list of vessels is that of the document as it is. */
export async function settled(page) {
  await page.locator("#progress").waitFor({ state: "hidden" });
  await page.locator("#tree-list[aria-busy=false]").waitFor({ state: "attached" }); // its panel may be folded
  await frames(page, 3);
}

/** Waits for N pictures of the browser. */
export async function frames(page, count = 2) {
  await page.evaluate(
    n =>
      new Promise(resolve => {
        const next = k => (k === 0 ? resolve() : requestAnimationFrame(() => next(k - 1)));
        next(n);
      }),
    count,
  );
}

/** Keeps a picture for people to look at. */
export async function picture(page, name) {
  await frames(page, 3);
  mkdirSync(kPictures, { recursive: true });
  await page.screenshot({ path: join(kPictures, `${name}.png`), timeout: kPatience });
}

/** The picture of an element: width, height and RGBA bytes. */
export async function pixels(page, selector) {
  await frames(page, 3);
  const png = await page.locator(selector).screenshot({ timeout: kPatience });
  const { width, height, data } = await page.evaluate(async text => {
    const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0)),
      bitmap = await createImageBitmap(new Blob([bytes]));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height),
      context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const rgba = context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    let binary = "";
    for (let i = 0; i < rgba.length; i += 8192) binary += String.fromCharCode(...rgba.subarray(i, i + 8192));
    return { width: bitmap.width, height: bitmap.height, data: btoa(binary) };
  }, png.toString("base64"));
  return { width, height, data: Buffer.from(data, "base64") };
}

/** Pixels for which `is(r, g, b)` holds: how many, and the one nearest their middle. */
export function find({ width, height, data }, is) {
  const found = [];
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const i = 4 * (y * width + x);
      if (is(data[i], data[i + 1], data[i + 2])) found.push([x, y]);
    }
  if (found.length === 0) return { count: 0, at: null };
  const middle = [0, 1].map(a => found.reduce((sum, p) => sum + p[a], 0) / found.length);
  const away = p => Math.hypot(p[0] - middle[0], p[1] - middle[1]);
  const at = found.reduce((best, p) => (away(p) < away(best) ? p : best));
  return { count: found.length, at: { x: at[0], y: at[1] } };
}
