// SPDX-License-Identifier: Apache-2.0
// Uses the package lumen-vascular as its users would. Exit code 77 where it is not built.
// LUMEN: the program; LUMEN_BUILD: the build folder; LUMEN_ARCHIVE: the package, which packages/wasm/build.sh makes.
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

if (!existsSync(process.env.LUMEN_ARCHIVE)) {
  console.log(`skipped: ${process.env.LUMEN_ARCHIVE} is missing (packages/wasm/build.sh FOLDER makes it)`);
  process.exit(77);
}
await import("./engine.test.mjs");
const page = join(dirname(fileURLToPath(import.meta.url)), "../../../viewer/page");
if (existsSync(process.env.CHROMIUM ?? "/usr/bin/chromium") && existsSync(join(page, "node_modules/playwright-core"))) await import("./page.test.mjs");
else console.log("without a page: chromium (apt install chromium) or npm ci in viewer/page is missing");
