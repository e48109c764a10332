// SPDX-License-Identifier: Apache-2.0
// Bundles the page into dist/: index.html, page.css and page.js, a classic script without any import, so that the
// same file also works inside of one HTML file that is opened from disk. For the page without a server also serverless.html, which
// is its index.html, worker.js with the engine, and offline.js, which keeps its files.
import { copyFileSync, mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const outdir = process.argv[2] ?? join(here, "dist");
const kMostBytes = 3e6; // of the script, before compression

mkdirSync(outdir, { recursive: true });
const result = await build({
  absWorkingDir: here,
  entryPoints: { page: "src/main.ts", worker: "src/engine_worker.ts", offline: "src/offline_worker.ts" },
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
// requests go to the place of the page alone, so that nothing can be uploaded
const policy =
  "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; connect-src 'self' blob:; " +
  "img-src 'self' data: blob:; base-uri 'none'; form-action 'none'";
writeFileSync(
  join(outdir, "serverless.html"),
  readFileSync(join(here, "src/index.html"), "utf8").replace(
    "    <title>",
    `    <meta http-equiv="Content-Security-Policy" content="${policy}" />\n` +
      `    <link rel="lumen-engine" href="lumen-view.wasm" />\n    <title>`,
  ),
);
const size = statSync(join(outdir, "page.js")).size;
console.log(`page.js: ${size} bytes`);
if (result.warnings.length > 0 || size > kMostBytes) {
  console.error(
    size > kMostBytes ? `page.js is larger than ${kMostBytes} bytes` : "esbuild warned, see above",
  );
  process.exit(1);
}
