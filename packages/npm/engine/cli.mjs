#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// @ts-check
// lumen-vascular convert IN OUT: `lumen convert` of the module, with the options and exit codes of the program.
import { randomBytes } from "node:crypto";
import { open, readFile, rename, stat, unlink } from "node:fs/promises";
import { basename, dirname, join } from "node:path";
import { LumenError, loadEngine } from "./node.mjs";

const kExitCodes = { failed: 1, usage: 2, input: 3, unsupported: 4, memory: 1, cancelled: 130 };
const kFormats = ["lumen.json", "lumen", "glb", "gltf", "vtp", "obj", "stl", "ply", "swc", "tre", "centerline.vtp", "mrk.json", "graphml", "am", "vmv"];
/** Options that name files. @type {Record<string, "seeds" | "corrected" | "labelMap" | "labelTable" | "centerline">} */
const kFiles = { seeds: "seeds", corrections: "corrected", "label-map": "labelMap", "label-table": "labelTable", centerline: "centerline" };

const kUsage = `Usage: lumen-vascular convert INPUT OUTPUT [--OPTION VALUE]...
       lumen-vascular convert --help
       lumen-vascular --version

INPUT   volume (.nii, .nii.gz, .nrrd, .mha), surface of vessels (.stl, .ply, .obj, .glb, .gltf, .vtp, .vtk), centerline (.swc, .tre,
        .centerline.vtp, .mrk.json) or case (.lumen, .lumen.json)
OUTPUT  case, .lumen or .lumen.json; surface, .glb, .gltf, .vtp, .obj, .stl or .ply; centerline, .swc, .tre, .centerline.vtp,
        .mrk.json, .graphml, .am or .vmv
`;
const kEnd = `
Exit codes: 0 done, 1 failed, 2 usage, 3 invalid input, 4 unsupported, 130 interrupted.
`;

/** @param {string} message */
const usage = (message) => new LumenError("usage", message);

/** The help of every option, by groups. @param {import("./index.js").OptionRow[]} rows */
function help(rows) {
  let text = `${kUsage}\nFiles beside the input:\n`;
  for (const name of Object.keys(kFiles)) text += `  --${name} FILE\n`;
  text += "  --to F\n  --quiet\n";
  for (const group of new Set(rows.map((row) => row.group))) {
    text += `\n${group}:\n`;
    for (const row of rows.filter((r) => r.group === group)) {
      const value = row.value && ` ${row.value}${row.default && `=${row.default}`}`;
      text += `  ${`--${row.name}${value}`.padEnd(33)} ${row.help}\n`;
    }
  }
  return text + kEnd;
}

/** @param {string[]} words
 * @param {import("./index.js").OptionRow[]} rows */
function parse(words, rows) {
  const byName = new Map(rows.map((row) => [row.name, row]));
  /** @type {string[]} */ const places = [];
  /** @type {Record<string, string[]>} */ const options = {};
  /** @type {Record<string, string>} */ const files = {};
  let to = "";
  let quiet = false;
  for (let at = 0; at < words.length; ++at) {
    const word = words[at];
    if (!word.startsWith("--")) {
      places.push(word);
      continue;
    }
    const equal = word.indexOf("=");
    const name = word.slice(2, equal < 0 ? undefined : equal);
    const value = () => {
      const found = equal < 0 ? words[++at] : word.slice(equal + 1);
      if (found === undefined) throw usage(`--${name} has no value`);
      return found;
    };
    const row = byName.get(name);
    const opposite = byName.get(name.replace(/^no-/, ""));
    if (name === "quiet") quiet = true;
    else if (name === "to") to = value();
    else if (row && row.value === "") options[name] = ["true"];
    else if (name.startsWith("no-") && opposite?.value === "") options[opposite.name] = ["false"];
    else if (name === "label-table") {
      const given = value();
      if (/[./\\]/.test(given)) files[name] = given;
      else options[name] = [given];
    } else if (name in kFiles) {
      if (files[name] !== undefined) throw usage(`--${name} is given twice; expected one file`);
      files[name] = value();
    } else if (row) (options[name] ??= []).push(value());
    else throw usage(`--${name}: there is no such option; lumen-vascular convert --help lists all`);
  }
  if (places.length !== 2) throw usage(`found ${places.length} files; expected an input and an output`);
  const [input, output] = places;
  const format = to || kFormats.filter((f) => output.toLowerCase().endsWith(`.${f}`)).sort((a, b) => b.length - a.length)[0];
  if (!kFormats.includes(format ?? ""))
    throw usage(`${to ? `--to: found "${to}"` : `${output}: its ending names no format`}; expected one of ${kFormats.join(", ")}`);
  return { input, output, format, options, files, quiet };
}

/** @param {string} file
 * @param {string} role */
async function bytesOf(file, role) {
  try {
    if ((await stat(file)).isDirectory())
      throw new LumenError("unsupported", `${file}: found a folder, expected a file; the installed program lumen reads folders of DICOM`);
    return await readFile(file);
  } catch (error) {
    if (error instanceof LumenError) throw error;
    const { code, message } = /** @type {NodeJS.ErrnoException} */ (error);
    throw new LumenError("input", code === "ENOENT" ? `${file}: there is no such ${role}` : `${file}: this ${role} cannot be read: ${message}`);
  }
}

/** Writes a file that appears under its name in one step.
 * @param {string} file
 * @param {Uint8Array} bytes */
async function replaceFile(file, bytes) {
  const beside = join(dirname(file), `.lumen-${randomBytes(8).toString("hex")}`);
  try {
    const handle = await open(beside, "wx", 0o666);
    try {
      await handle.writeFile(bytes);
      await handle.sync();
    } finally {
      await handle.close();
    }
    await rename(beside, file);
  } catch (error) {
    await unlink(beside).catch(() => {});
    throw new LumenError("failed", `${file}: cannot write this file: ${/** @type {Error} */ (error).message}`);
  }
}

/** @param {string[]} words */
async function convert(words) {
  const engine = await loadEngine();
  const rows = await engine.options();
  if (words.includes("--help") || words.includes("-h")) return process.stdout.write(help(rows));
  const { input, output, format, options, files, quiet } = parse(words, rows);
  const folder = await stat(dirname(output)).catch(() => undefined);
  if (!folder?.isDirectory()) throw new LumenError("failed", `${output}: its folder does not exist`);
  /** @type {import("./index.js").Inputs} */
  const inputs = { name: basename(input), options };
  for (const [name, file] of Object.entries(files))
    inputs[kFiles[name]] = { name: basename(file), bytes: await bytesOf(file, `file of --${name}`) };
  const live = !quiet && process.stderr.isTTY;
  let stage = "";
  const listener = {
    onStage: (/** @type {string} */ name) => live && process.stderr.write(`\r\x1b[K${(stage = name)}`),
    onProgress: (/** @type {number} */ done) => live && process.stderr.write(`\r\x1b[K${stage} ${Math.round(100 * done)} %`),
    onWarning: (/** @type {string} */ text) => quiet || process.stderr.write(`${live ? "\r\x1b[K" : ""}lumen: warning: ${text}\n`),
  };
  const made = await engine.caseOf(await bytesOf(input, "input"), { ...inputs, ...listener });
  const bytes = made.encode(format, { ...options, ...listener });
  await replaceFile(output, bytes);
  if (live) process.stderr.write("\r\x1b[K");
  if (!quiet) process.stdout.write(`${output}: ${made.branches.length} branches, ${bytes.length} bytes\n`);
}

/** @param {string[]} words */
async function run(words) {
  const [command, ...rest] = words;
  if (command === "--version") return process.stdout.write(`lumen-vascular ${await (await loadEngine()).version()}\n`);
  if (command === "--help" || command === "-h") return process.stdout.write(kUsage + kEnd);
  if (command === "convert") return convert(rest);
  throw usage(`${command === undefined ? "no command is given" : `"${command}" is no command`}; expected convert\n${kUsage}`);
}

run(process.argv.slice(2)).catch((error) => {
  process.stderr.write(`lumen: ${error.message}\n`);
  process.exitCode = error instanceof LumenError ? kExitCodes[error.kind] : 1;
});
