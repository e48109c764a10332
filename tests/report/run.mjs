// SPDX-License-Identifier: Apache-2.0
// Checks pages of `lumen report` in a browser. Exit code 77, with what is missing, where that cannot be.
// LUMEN: the program; CHROMIUM: the browser; LUMEN_PICTURES: the folder for screenshots and PDF.
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const kSkipped = 77;
const page = join(dirname(fileURLToPath(import.meta.url)), "../../viewer/page");
const needed = [[process.env.CHROMIUM ?? "/usr/bin/chromium", "apt install chromium"], [join(page, "node_modules/playwright-core"), "npm ci in viewer/page"]];
for (const [path, remedy] of needed)
  if (!existsSync(path)) {
    console.log(`skipped: ${path} is missing (${remedy})`);
    process.exit(kSkipped);
  }
await import("./report.test.mjs");
