// SPDX-License-Identifier: Apache-2.0
// The program as a person starts it, and a folder for what it reads and writes.
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

export const kLumen = process.env.LUMEN ?? "lumen";

const folders = [];
// at the end, when no program writes into them any more
process.on("exit", () => {
  for (const folder of folders) rmSync(folder, { recursive: true, force: true });
});

/** A folder that goes with the process. */
export function makeFolder() {
  const folder = mkdtempSync(join(tmpdir(), "lumen-people-"));
  folders.push(folder);
  return name => join(folder, name);
}

/** Runs a command to its end and gives its JSON answer, if it has one. */
export function lumen(...words) {
  const { status, stdout, stderr, error } = spawnSync(kLumen, [...words, "--quiet", "--json"], {
    encoding: "utf8",
    maxBuffer: 1e9,
  });
  if (error !== undefined || status !== 0)
    throw new Error(`lumen ${words.join(" ")}: ${error?.message ?? `exit code ${status}\n${stderr}`}`);
  return stdout.trim() === "" ? null : JSON.parse(stdout);
}

/** The page without a server, in the folder LUMEN_SERVERLESS that `lumen view --serverless` has written, with the files beside it. */
async function viewServerless(test, places) {
  const { serve } = await import("./static_server.mjs"),
    files = places.filter(place => existsSync(place)), // a case that is not there yet has no place to be saved to
    named = Object.fromEntries(files.map(file => [basename(file), file])),
    query = files.map(file => `open=files/${encodeURIComponent(basename(file))}`).join("&"),
    { address } = await serve(test, process.env.LUMEN_SERVERLESS, named);
  return { address: query === "" ? address : `${address}?${query}`, stop: () => Promise.resolve("") };
}

/** `lumen view` until the test is over or `stop` is called. */
export async function view(test, ...files) {
  if (process.env.LUMEN_SERVERLESS !== undefined) return viewServerless(test, files);
  const child = spawn(kLumen, ["view", "--no-browser", "--json", ...files], {
    stdio: ["ignore", "pipe", "pipe"],
    env: { ...process.env, XDG_STATE_HOME: makeFolder()(".") }, // of a document without a file, unsaved work
  });
  const ended = new Promise(resolve => child.once("exit", resolve));
  let out = "",
    printed = "";
  child.stderr.on("data", data => {
    printed += data;
  });
  const stop = async () => {
    child.kill("SIGINT");
    await ended;
    return printed;
  };
  test.after(stop);
  const address = await new Promise((resolve, reject) => {
    child.stdout.on("data", data => {
      out += data;
      try {
        resolve(JSON.parse(out).address);
      } catch {
        /* not all of it is here yet */
      }
    });
    child.once("error", reject);
    child.once("exit", code => reject(new Error(`lumen view ended with ${code}:\n${printed}`)));
  });
  return { address, stop };
}
