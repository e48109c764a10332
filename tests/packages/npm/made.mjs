// SPDX-License-Identifier: Apache-2.0
// A folder in which the packages are installed from their archives, and a server of such a folder.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

export const kRoot = join(dirname(fileURLToPath(import.meta.url)), "../../..");
export const kCase = join(kRoot, "tests/data/cases-0.1.0/fork.lumen");
const kTypes = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };

/** Both packages as archives, made once: a folder that goes with the process. */
const archives = (() => {
  let made = "";
  return () => {
    if (made !== "") return made;
    made = mkdtempSync(join(tmpdir(), "lumen-npm-made-"));
    process.once("exit", () => rmSync(made, { recursive: true }));
    execFileSync(join(kRoot, "packages/npm/build.sh"), [made], { stdio: "pipe" });
    return made;
  };
})();

/** {folder, size(name)}: a folder with both packages, installed without a network. */
export function installed(t) {
  const folder = mkdtempSync(join(tmpdir(), "lumen-npm-"));
  t.after(() => rmSync(folder, { recursive: true }));
  writeFileSync(join(folder, "package.json"), '{ "private": true, "type": "module" }');
  const { version } = JSON.parse(readFileSync(join(kRoot, "packages/npm/blob/package.json"), "utf8")),
    archive = name => join(archives(), `lumen-${name}-${version}.tgz`),
    options = ["--offline", "--no-audit", "--no-fund", "--silent"];
  execFileSync("npm", ["install", ...options, archive("blob"), archive("viewer")], { cwd: folder });
  return { folder, size: name => statSync(archive(name)).size };
}

/** The address of a server of a folder's files, which sends the policy that a careful site has. */
export function served(t, folder, policy = "") {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
    try {
      const bytes = readFileSync(join(folder, path));
      const head = { "Content-Type": kTypes[extname(path)] ?? "application/octet-stream" };
      response.writeHead(200, policy === "" ? head : { ...head, "Content-Security-Policy": policy }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  t.after(() => server.close());
  return new Promise(resolve => server.listen(0, "127.0.0.1", () => resolve(`http://127.0.0.1:${server.address().port}/`)));
}

/** Places beside every fifth node of kCase and the native library's distances there, mm: those of ../check_old_cases.py. */
export function expectedDistances(lumen, folder) {
  execFileSync(lumen, ["convert", kCase, join(folder, "tree.lumen.json"), "--quiet"]);
  const { centre, radius } = JSON.parse(readFileSync(join(folder, "tree.lumen.json"), "utf8")).tree,
    ways = [
      [1, 0, 0],
      [0, 0.6, -0.8],
    ],
    places = [];
  for (let node = 0; node < centre.length; node += 5)
    for (const share of [0.3, 0.95, 1.6])
      for (const way of ways) places.push(...centre[node].map((c, a) => c + share * radius[node] * way[a]));
  const answers = JSON.parse(readFileSync(join(dirname(kCase), "answers.json"), "utf8"));
  return { places, distances: answers["fork.lumen"].distances };
}

const kNear = 1e-6; // mm

/** A module that asks the package for distances, wherever it runs. */
export const kAsk = `
export async function ask({ loadBlob }, bytes, places) {
  const model = (await loadBlob()).open(bytes), batch = model.batch(places.length / 3);
  batch.points.set(places);
  batch.query();
  const distances = [...batch.distances()];
  batch.free();
  model.close();
  return distances;
}
`;

/** Asserts that distances are those expected. */
export function near(found, expected, where) {
  assert.equal(found.length, expected.length, where);
  for (const [i, x] of found.entries()) assert.ok(Math.abs(x - expected[i]) < kNear, `${where}: ${x} for ${expected[i]}`);
}
