#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// lumen-page OUT: writes the page without a server as the folder OUT, which may not exist.
import { cpSync, existsSync } from "node:fs";
import { fileURLToPath } from "node:url";

const [out, ...more] = process.argv.slice(2);
if (out === undefined || more.length > 0 || out.startsWith("-")) {
  process.stderr.write("Usage: lumen-page OUT\n");
  process.exitCode = 2;
} else if (existsSync(out)) {
  process.stderr.write(`lumen-page: ${out}: found something of that name, expected none\n`);
  process.exitCode = 1;
} else cpSync(fileURLToPath(new URL("./site", import.meta.url)), out, { recursive: true });
