// SPDX-License-Identifier: Apache-2.0
// Debian's Firefox, driven by WebDriver BiDi (puppeteer-core), with WebGL 2 in software. Mesa's software needs a display
// for it, which Xvfb is.
import { spawn } from "node:child_process";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import puppeteer from "puppeteer-core";
import { kPatience } from "./browser.mjs";

const kFirefox = process.env.FIREFOX ?? "/usr/bin/firefox-esr",
  kXvfb = "/usr/bin/Xvfb";
const kPictures = process.env.LUMEN_PICTURES ?? "people-pictures";

/** A display that ends with the test; gives its name. */
async function startDisplay(t) {
  const kNumber = 3; // descriptor at which Xvfb writes the number of its display
  const child = spawn(kXvfb, ["-displayfd", String(kNumber), "-screen", "0", "1400x1000x24"], {
    stdio: ["ignore", "ignore", "ignore", "pipe"],
  });
  t.after(() => child.kill());
  const number = await new Promise((resolve, reject) => {
    child.stdio[kNumber].once("data", data => resolve(String(data).trim()));
    child.once("exit", code => reject(new Error(`Xvfb ended with ${code}`)));
  });
  return `:${number}`;
}

/** A page whose mistakes fail the test at its end. */
export async function openInFirefox(t, address) {
  const browser = await puppeteer.launch({
    browser: "firefox",
    executablePath: kFirefox,
    timeout: kPatience,
    protocolTimeout: kPatience,
    env: { ...process.env, DISPLAY: await startDisplay(t) },
    extraPrefsFirefox: { "webgl.force-enabled": true },
  });
  t.after(() => browser.close());
  const page = await browser.newPage(),
    mistakes = [];
  page.setDefaultTimeout(kPatience);
  page.on("pageerror", error => mistakes.push(String(error)));
  page.on("console", message => {
    if (["error", "warn"].includes(message.type()) && !isOfTheDriver(message.text()))
      mistakes.push(message.text());
  });
  t.after(() => {
    if (mistakes.length > 0) throw new Error(`the page complained:\n${mistakes.join("\n")}`);
  });
  await page.setViewport({ width: 1280, height: 800 });
  await page.goto(address);
  await page.waitForSelector("body[data-ready]");
  return page;
}
const isOfTheDriver = text => /WEBGL_debug_renderer_info is deprecated|WebGL warning/i.test(text);

export const count = (page, selector) => page.$$eval(selector, found => found.length);
export const text = (page, selector) => page.$eval(selector, found => found.textContent);

/** Waits until an element has such a text. */
export async function untilText(page, selector, pattern) {
  await page.waitForFunction(
    (where, source) =>
      [...document.querySelectorAll(where)].some(each => new RegExp(source).test(each.textContent)),
    {},
    selector,
    pattern.source,
  );
}

/** Waits for N pictures of the browser, and for the end of work. */
export async function settle(page) {
  await page.waitForSelector("#progress", { hidden: true });
  await page.waitForSelector("#tree-list[aria-busy=false]");
  await page.evaluate(
    () =>
      new Promise(resolve => {
        requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(resolve)));
      }),
  );
}

export async function keep(page, name) {
  await settle(page);
  mkdirSync(kPictures, { recursive: true });
  await page.screenshot({ path: join(kPictures, `${name}.png`) });
}

/** Presses a key while another one is held. */
export async function chord(page, held, key) {
  await page.keyboard.down(held);
  await page.keyboard.press(key);
  await page.keyboard.up(held);
}

/** Drops files, {name, bytes}, onto the views. */
export async function dropFiles(page, files) {
  await page.evaluate(
    list => {
      const data = new DataTransfer();
      for (const [name, base64] of list)
        data.items.add(new File([Uint8Array.from(atob(base64), c => c.charCodeAt(0))], name));
      for (const type of ["dragenter", "dragover", "drop"])
        document
          .querySelector("#views")
          .dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true }));
    },
    files.map(({ name, bytes }) => [name, bytes.toString("base64")]),
  );
}

/** The pixel at which a slice shows a position, mm, read off the line below the views. */
export async function placeIn(page, name, position) {
  const box = await (await page.$(`#view-${name}`)).boundingBox(),
    x = Math.round(box.width / 2),
    y = Math.round(box.height / 2),
    step = 50;
  const pointedAt = async (dx, dy) => {
    await page.mouse.move(box.x + x + dx, box.y + y + dy);
    await settle(page);
    return (await page.$eval("#probe-position", e => e.dataset.mm)).split(" ").map(Number);
  };
  const origin = await pointedAt(0, 0),
    minus = (a, b) => a.map((value, i) => value - b[i]),
    dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0),
    right = minus(await pointedAt(step, 0), origin),
    down = minus(await pointedAt(0, step), origin),
    wanted = minus(position, origin);
  return {
    x: box.x + x + (step * dot(wanted, right)) / dot(right, right),
    y: box.y + y + (step * dot(wanted, down)) / dot(down, down),
  };
}
