// SPDX-License-Identifier: Apache-2.0
// Uses the package lumen-vascular as its users would. Exit code 77 where it is not built.
// LUMEN: the program; LUMEN_ARCHIVE: the package, which packages/wasm/build.sh makes.
import { existsSync } from "node:fs";

if (!existsSync(process.env.LUMEN_ARCHIVE)) {
  console.log(`skipped: ${process.env.LUMEN_ARCHIVE} is missing (packages/wasm/build.sh FOLDER makes it)`);
  process.exit(77);
}
await import("./engine.test.mjs");
