// SPDX-License-Identifier: Apache-2.0
// Builds the npm packages and uses them as their users would: run.mjs blob|browser|viewer. Exit code 77 where that cannot be done.
// LUMEN: the program; LUMEN_BUILD: the build folder; CHROMIUM: the browser; LUMEN_PICTURES: the folder for screenshots.
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const kSkipped = 77,
  page = join(dirname(fileURLToPath(import.meta.url)), "../../../viewer/page");
for (const [path, remedy] of [
  [process.env.CHROMIUM ?? "/usr/bin/chromium", "apt install chromium"],
  [join(page, "node_modules/playwright-core"), "npm ci in viewer/page"],
  [join(page, "dist/blob.wasm"), "the target viewer_page, which needs what libblob/wasm/README.md names"],
])
  if (!existsSync(path)) {
    console.log(`skipped: ${path} is missing (${remedy})`);
    process.exit(kSkipped);
  }
for (const story of process.argv.slice(2)) await import(`./${story}.test.mjs`);
