// SPDX-License-Identifier: Apache-2.0
// Bundles the page into dist/: index.html, page.css and page.js, a classic script without any import, so that the
// same file also works inside of one HTML file that is opened from disk.
import { copyFileSync, mkdirSync, statSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const outdir = process.argv[2] ?? join(here, "dist");
const kMostBytes = 3e6; // of the script, before compression

mkdirSync(outdir, { recursive: true });
const result = await build({
  absWorkingDir: here,
  entryPoints: { page: "src/main.ts" },
  outdir,
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "eof",
  logLevel: "warning",
  metafile: true,
});
await build({
  absWorkingDir: here,
  entryPoints: ["src/style/page.css"],
  outdir,
  bundle: true,
  minify: true,
  logLevel: "warning",
});
copyFileSync(join(here, "src/index.html"), join(outdir, "index.html"));
const size = statSync(join(outdir, "page.js")).size;
console.log(`page.js: ${size} bytes`);
if (result.warnings.length > 0 || size > kMostBytes) {
  console.error(
    size > kMostBytes ? `page.js is larger than ${kMostBytes} bytes` : "esbuild warned, see above",
  );
  process.exit(1);
}
