// SPDX-License-Identifier: Apache-2.0
// The npm package lumen-vascular, installed without a network: the command, the module beside the program, failures. run.mjs has
// the environment.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants } from "node:zlib";

const lumen = process.env.LUMEN,
  kPhantoms = ["tube", "helix", "bifurcation", "kissing", "aneurysm", "stenosis", "coil", "fork", "right-angle", "hairpin"],
  kMostBytes = 7_500_000, // of lumen.wasm
  kMostCompressed = 2_000_000,
  kNear = 1e-5; // mm: the last digit of a float of 100 mm

const folder = mkdtempSync(join(tmpdir(), "lumen-wasm-"));
after(() => rmSync(folder, { recursive: true }));
const at = name => join(folder, name);
writeFileSync(at("package.json"), '{ "private": true, "type": "module" }');
execFileSync("npm", ["install", "--offline", "--no-audit", "--no-fund", "--silent", process.env.LUMEN_ARCHIVE], { cwd: folder });
const { LumenError, caseOf, loadEngine } = await import(at("node_modules/lumen-vascular/node.mjs"));

/** {status, out, error} of the command as people run it. */
function npx(...words) {
  const { status, stdout, stderr } = spawnSync("npx", ["--offline", "lumen-vascular", ...words], { cwd: folder, encoding: "utf8" });
  return { status, out: stdout, error: stderr };
}

/** A phantom's volume, made once. */
function phantom(name, ...options) {
  const file = at(`${name}.nrrd`);
  execFileSync(lumen, ["phantom", name, file, "--quiet", ...options]);
  return file;
}

/** The greatest difference of two lists of numbers. */
function farthest(a, b) {
  assert.equal(a.length, b.length);
  return a.reduce((most, x, i) => Math.max(most, Math.abs(x - b[i])), 0);
}

test("the module is small", () => {
  const bytes = readFileSync(at("node_modules/lumen-vascular/lumen.wasm"));
  const compressed = brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 9 } }).length;
  console.log(`lumen.wasm: ${bytes.length} bytes, ${compressed} compressed`);
  assert.ok(bytes.length <= kMostBytes && compressed <= kMostCompressed);
});

test("cases of phantoms have the tree of the program, to the last digit", async () => {
  const engine = await loadEngine();
  let equal = 0;
  for (const name of kPhantoms) {
    const file = phantom(name, "--size", "64", "--voxel", "0.4");
    execFileSync(lumen, ["convert", file, at("native.lumen"), "--quiet"]);
    const made = await engine.caseOf(readFileSync(file), { name: `${name}.nrrd` });
    const native = readFileSync(at("native.lumen")),
      here = Buffer.from(made.encode("lumen"));
    if (native.equals(here)) ++equal;
    const theirs = await engine.openCase(native);
    const of = c => JSON.parse(new TextDecoder().decode(c.encode("lumen.json"))).tree;
    const a = of(theirs),
      b = of(made);
    assert.deepEqual(made.branches, theirs.branches, name);
    const off = Math.max(farthest(a.centre.flat(), b.centre.flat()), farthest(a.radius, b.radius));
    console.log(`${name}: ${native.equals(here) ? "equal bytes" : `${off} mm apart at most`}`);
    assert.ok(off <= kNear, `${name}: ${off} mm`);
  }
  console.log(`${equal} of ${kPhantoms.length} cases have equal bytes`);
});

test("files of the conformance set are opened or refused, and none stops the module", async () => {
  const engine = await loadEngine(),
    set = join(process.env.LUMEN_BUILD, "spec/conformance");
  for (const kind of ["valid", "hostile"]) {
    const files = readdirSync(join(set, kind)).filter(name => /[.]lumen([.]json)?$/.test(name));
    assert.ok(files.length > 20, `${files.length} files in ${kind}`);
    for (const name of files) {
      try {
        const made = await engine.openCase(readFileSync(join(set, kind, name)), name);
        const again = await engine.openCase(made.encode("lumen"));
        assert.deepEqual(again.branches, made.branches, name);
      } catch (error) {
        assert.ok(kind === "hostile" && error instanceof LumenError && error.kind === "input", `${name}: ${error}`);
      }
    }
  }
});

test("the command writes what the program writes", () => {
  const file = phantom("bifurcation", "--size", "64", "--voxel", "0.4");
  const [native, here] = ["native", "here"].map(name => ending => readFileSync(at(`${name}.${ending}`)));
  for (const ending of ["lumen", "glb", "stl", "swc", "lumen.json"]) {
    execFileSync(lumen, ["convert", file, at(`native.${ending}`), "--quiet"]);
    assert.equal(npx("convert", file, at(`here.${ending}`), "--quiet").status, 0);
  }
  assert.ok(native("lumen").equals(here("lumen")));
  for (const ending of ["glb", "stl"]) {
    const [a, b] = [native(ending).length, here(ending).length]; // a surface has some other triangles within its error
    assert.ok(Math.abs(a - b) < 0.02 * a, `${ending}: ${b} bytes, ${a} of the program`);
  }
  const rows = bytes => bytes.toString().match(/^[0-9].*$/gm).flatMap(row => row.split(" ").map(Number));
  assert.ok(farthest(rows(native("swc")), rows(here("swc"))) <= kNear);
  assert.deepEqual(JSON.parse(native("lumen.json")).tree.parent, JSON.parse(here("lumen.json")).tree.parent);
  assert.ok(!readdirSync(folder).some(name => name.startsWith(".lumen-")), "no file is left beside");
});

test("the command has the exit codes of the program, and leaves an output as it was", () => {
  const file = phantom("tube", "--size", "48", "--voxel", "0.5");
  writeFileSync(at("text.nrrd"), "no volume\n");
  writeFileSync(at("kept.glb"), "kept");
  const runs = [
    [["convert", file, at("kept.glb"), "--accuracy", "much"], 2],
    [["convert", file, at("kept.glb"), "--nothing"], 2],
    [["convert", file, at("kept.xyz")], 2],
    [["convert", at("absent.nrrd"), at("kept.glb")], 3],
    [["convert", at("text.nrrd"), at("kept.glb")], 3],
    [["convert", folder, at("kept.glb")], 4],
    [["unknown"], 2],
  ];
  for (const [words, code] of runs) {
    const { status, error } = npx(...words);
    assert.equal(status, code, `${words.join(" ")}: ${error}`);
    assert.match(error, /^lumen: .+\n/);
  }
  assert.equal(readFileSync(at("kept.glb"), "utf8"), "kept");
  const help = npx("convert", "--help");
  assert.equal(help.status, 0);
  assert.match(help.out, /--accuracy MM/);
});

test("a program hears of the work, ends it, and reads failures", async () => {
  const bytes = readFileSync(phantom("bifurcation", "--size", "64", "--voxel", "0.4"));
  const stages = [];
  const made = await caseOf(bytes, { name: "fork.nrrd", onStage: name => stages.push(name), options: { accuracy: 0.3 } });
  assert.ok(stages.includes("track") && stages.includes("fit"), stages.join());
  const surface = made.surface({ maxError: 0.1 });
  assert.ok(surface.positions.length > 300 && surface.triangles.every(v => v < surface.positions.length / 3));
  assert.ok(surface.groupNames.includes("wall"));

  const controller = new AbortController();
  const ended = caseOf(bytes, { name: "fork.nrrd", signal: controller.signal, onStage: name => name === "track" && controller.abort() });
  await assert.rejects(ended, { name: "LumenError", kind: "cancelled" });
  const thrown = caseOf(bytes, {
    name: "fork.nrrd",
    onStage: () => {
      throw new RangeError("mine");
    },
  });
  await assert.rejects(thrown, RangeError);

  await assert.rejects(caseOf(bytes), { kind: "usage" });
  await assert.rejects(caseOf(bytes, { name: "fork.nrrd", options: { nothing: 1 } }), { kind: "usage" });
  await assert.rejects(caseOf(bytes.subarray(0, 500), { name: "fork.nrrd" }), e => e instanceof LumenError && e.kind === "input");
  assert.throws(() => made.encode("exe"), { kind: "unsupported" });
  assert.ok(made.encode("swc").length > 0, "a failure does not harm a case");
});

test("voxels in memory give the case of their file", async () => {
  const [n, edge] = [48, 0.5];
  const data = new Int16Array(n ** 3);
  for (let k = 0, i = 0; k < n; ++k)
    for (let y = 0; y < n; ++y) for (let x = 0; x < n; ++x, ++i) data[i] = Math.hypot(x - n / 2, y - n / 2) < 5 ? 1000 : (i * 7919) % 60;
  const affine = [
    [edge, 0, 0, 0],
    [0, edge, 0, 0],
    [0, 0, edge, 0],
  ];
  const made = await caseOf({ data, size: [n, n, n], affine });
  assert.equal(made.branches.length, 1);
  await assert.rejects(caseOf({ data, size: [n, n, 3], affine }), { kind: "usage" });
});

const tsc = fileURLToPath(new URL("../../../viewer/page/node_modules/.bin/tsc", import.meta.url));
test("TypeScript knows the types, and refuses a wrong one", { skip: existsSync(tsc) ? false : "npm ci in viewer/page is missing" }, () => {
  const check = text => {
    writeFileSync(at("use.ts"), `import { caseOf, loadEngine } from "lumen-vascular";\n${text}`);
    const compilerOptions = { noEmit: true, strict: true, target: "es2022", module: "nodenext", lib: ["es2022", "dom"], types: [] };
    writeFileSync(at("tsconfig.json"), JSON.stringify({ compilerOptions, files: ["use.ts"] }));
    return () => execFileSync(tsc, ["-p", "."], { cwd: folder, encoding: "utf8", stdio: "pipe" });
  };
  const right = 'const c = await caseOf(new Uint8Array(), { name: "a.nrrd", options: { accuracy: 0.2 } });\nexport const n: number = c.surface().radii.length;';
  assert.doesNotThrow(check(right));
  assert.throws(check("export const n: number = (await loadEngine()).version();"));
  assert.throws(check('await caseOf("head.nii.gz");'));
});
