// SPDX-License-Identifier: Apache-2.0
// A library's site as a visitor has it: served, opened, looked over.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { dirname, join, resolve, sep } from "node:path";
import { kPatience } from "./browser.mjs";

/** A plain web server of a folder, on this machine, until the test is over. */
export async function serve(test, folder) {
  const child = spawn(
    "python3",
    ["-u", "-m", "http.server", "0", "--bind", "127.0.0.1", "--directory", folder],
    { stdio: ["ignore", "pipe", "ignore"] },
  );
  test.after(() => child.kill());
  return new Promise((resolvePort, reject) => {
    let out = "";
    child.stdout.on("data", data => {
      out += data;
      const port = /port (\d+)/.exec(out)?.[1];
      if (port !== undefined) resolvePort(`http://127.0.0.1:${port}`);
    });
    child.once("exit", code => reject(new Error(`http.server ended with ${code}`)));
  });
}

/** Chromium's words for a request that it drops because its page is left before the answer: no fault of the site. */
const kDropped = "net::ERR_ABORTED";

/** A page of a site in a browser context, which fails its test for every complaint and every request that leaves `within`. */
export async function openSite(t, browser, address, { within, ...options }) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage(),
    mistakes = [];
  t.pages.push(page);
  page.setDefaultTimeout(kPatience);
  page.on("pageerror", error => mistakes.push(String(error)));
  page.on("console", message => {
    if (["error", "warning"].includes(message.type())) mistakes.push(message.text());
  });
  page.on("dialog", dialog => {
    mistakes.push(`a dialog: ${dialog.message()}`);
    void dialog.dismiss();
  });
  page.on("request", request => {
    if (!request.url().startsWith(within) && !request.url().startsWith("data:"))
      mistakes.push(`asked for ${request.url()}`);
  });
  page.on("response", response => {
    if (response.status() >= 400) mistakes.push(`${response.status()} ${response.url()}`);
  });
  page.on("requestfailed", request => {
    const { errorText } = request.failure();
    if (errorText !== kDropped) mistakes.push(`failed: ${request.url()}: ${errorText}`);
  });
  t.after(() => {
    if (mistakes.length > 0) throw new Error(`the site complained:\n${mistakes.join("\n")}`);
  });
  await page.goto(address);
  if (options.javaScriptEnabled !== false) await page.locator("body[data-ready]").waitFor();
  return page;
}

/** Every HTML page of a library's site, relative to its folder. */
export function pagesOf(library) {
  const found = ["index.html"];
  for (const folder of ["site/case", "site/page"])
    for (const name of readdirSync(join(library, folder))) found.push(`${folder}/${name}`);
  return found;
}

const plain = text =>
  text
    .replaceAll("&amp;", "&")
    .replaceAll("&#39;", "'")
    .replaceAll("&quot;", '"')
    .replaceAll("&lt;", "<")
    .replaceAll("&gt;", ">");

/** Every address in a page is of a file of the library, a place on the page, or a DOI; gives how many were of files. */
export function linksResolve(library, pages) {
  let files = 0;
  for (const page of pages)
    for (const [, quoted] of readFileSync(join(library, page), "utf8").matchAll(
      /\s(?:href|src)="([^"]*)"/g,
    )) {
      const address = plain(quoted);
      if (address.startsWith("#") || address === "data:," || address.startsWith("https://doi.org/")) continue;
      assert.doesNotMatch(address, /^[a-z][a-z0-9+.-]*:|^\//i, `${page}: ${address} is not relative`);
      const file = resolve(library, dirname(page), decodeURIComponent(address));
      assert.ok(file.startsWith(resolve(library) + sep), `${page}: ${address} leaves the library`);
      assert.ok(existsSync(file), `${page}: ${address} is not there`);
      ++files;
    }
  return files;
}

/** Ids of the cases that the gallery shows, in its order. */
export const shownIds = page =>
  page
    .locator("#cards h2 a")
    .evaluateAll(links => links.map(link => /case\/(.*)\.html$/.exec(link.getAttribute("href"))[1]));

/** Every case that the gallery finds, from all its pages; the first is shown. */
export async function foundIds(page) {
  const all = [];
  for (let at = 1; ; ++at) {
    all.push(...(await shownIds(page)));
    const next = page.locator("#pages a[rel=next]");
    if ((await next.count()) === 0) return all;
    await next.click();
    await page
      .locator("#pages [aria-current=page]")
      .filter({ hasText: new RegExp(`^${at + 1}$`) })
      .waitFor();
  }
}

/** Words whose colour does not stand out from their ground: WCAG 2.1, contrast below 4.5. Pictures are no ground of text here. */
export function faintTexts(page) {
  return page.evaluate(() => {
    const channel = c => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    const parse = text => {
      const n = text.match(/[\d.]+/g).map(Number);
      return { rgb: n.slice(0, 3), alpha: n[3] ?? 1 };
    };
    const light = rgb => rgb.reduce((sum, c, i) => sum + [0.2126, 0.7152, 0.0722][i] * channel(c / 255), 0);
    const over = (top, alpha, bottom) => top.map((c, i) => alpha * c + (1 - alpha) * bottom[i]);
    const seen = new Set(),
      faint = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const element = walker.currentNode.parentElement;
      if (
        walker.currentNode.textContent.trim() === "" ||
        !element.checkVisibility() ||
        element.closest("noscript, .skip") !== null
      )
        continue;
      let ground = null,
        opacity = 1;
      for (let e = element; e !== null; e = e.parentElement) {
        opacity *= Number(getComputedStyle(e).opacity);
        const { rgb, alpha } = parse(getComputedStyle(e).backgroundColor);
        if (ground === null && alpha === 1) ground = rgb;
      }
      const ink = parse(getComputedStyle(element).color),
        shown = over(ink.rgb, ink.alpha * opacity, ground);
      const [a, b] = [light(shown), light(ground)].sort((x, y) => y - x),
        contrast = (a + 0.05) / (b + 0.05);
      const what = `${element.tagName.toLowerCase()}.${element.className}: ${contrast.toFixed(2)}`;
      if (contrast < 4.5 && !seen.has(what)) {
        seen.add(what);
        faint.push(`${what} "${walker.currentNode.textContent.trim().slice(0, 30)}"`);
      }
    }
    return faint;
  });
}
