// SPDX-License-Identifier: Apache-2.0
// Runs stories in a browser: run.mjs STORY..., each STORY.test.mjs beside this. Exit code 77, with what is missing, where they cannot run.
// LUMEN: the program; LUMEN_ASK_BLOB: that of ask_blob.c; CHROMIUM: the browser; LUMEN_PICTURES: the folder for screenshots.
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const kSkipped = 77;
const here = dirname(fileURLToPath(import.meta.url)),
  page = dirname(here);
const needed = [
  [process.env.CHROMIUM ?? "/usr/bin/chromium", "apt install chromium"],
  [join(page, "node_modules/playwright-core"), "npm ci in viewer/page"],
  [join(page, "dist/page.js"), "npm run build in viewer/page"],
  [join(page, "dist/blob.wasm"), "the target viewer_page, which needs what libblob/wasm/README.md names"],
];
if (process.argv.some(name => name.startsWith("firefox")))
  needed.push(
    [process.env.FIREFOX ?? "/usr/bin/firefox-esr", "apt install firefox-esr"],
    ["/usr/bin/Xvfb", "apt install xvfb"],
    [join(page, "node_modules/puppeteer-core"), "npm ci in viewer/page"],
  );
if (process.argv.some(name => name.endsWith("serverless")))
  needed.push([join(page, "dist/lumen-view.wasm"), "packages/wasm/build.sh FOLDER"]);
for (const [path, remedy] of needed)
  if (!existsSync(path)) {
    console.log(`skipped: ${path} is missing (${remedy})`);
    process.exit(kSkipped);
  }
for (const story of process.argv.slice(2)) await import(`./${story}.test.mjs`);
