// SPDX-License-Identifier: Apache-2.0
// @lumen/blob in Node, in its threads, and as TypeScript sees it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { expectedDistances, installed, kAsk, kCase, kRoot, near } from "./made.mjs";

const kMostBytes = 180_000; // bound on the archive

test("the archive is small, and answers as the native library in Node and its threads", t => {
  const { folder, size } = installed(t),
    { places, distances } = expectedDistances(process.env.LUMEN, folder);
  assert.ok(size("blob") <= kMostBytes, `${size("blob")} bytes`);
  writeFileSync(join(folder, "ask.mjs"), kAsk);
  writeFileSync(join(folder, "places.json"), JSON.stringify(places));
  writeFileSync(
    join(folder, "main.mjs"),
    `import * as blob from "@lumen/blob";
import { readFileSync } from "node:fs";
import { isMainThread, parentPort, Worker } from "node:worker_threads";
import { ask } from "./ask.mjs";
const places = JSON.parse(readFileSync("places.json", "utf8")), bytes = readFileSync(process.argv[2]);
const own = await ask(blob, bytes, places);
if (!isMainThread) parentPort.postMessage(own);
else new Worker(new URL(import.meta.url), { argv: [process.argv[2]] }).once("message", of => console.log(JSON.stringify([own, of])));
`,
  );
  const [own, ofThread] = JSON.parse(execFileSync(process.execPath, ["main.mjs", kCase], { cwd: folder, encoding: "utf8" }));
  near(own, distances, "Node");
  near(ofThread, distances, "a thread of Node");
});

test("the module of WebGPU has the text of the shader", t => {
  const { folder } = installed(t);
  writeFileSync(join(folder, "text.mjs"), 'import { shader } from "@lumen/blob/webgpu";\nprocess.stdout.write(shader);\n');
  const text = execFileSync(process.execPath, ["text.mjs"], { cwd: folder, encoding: "utf8" });
  assert.equal(text, readFileSync(join(process.env.LUMEN_BUILD, "libblob/query.wgsl"), "utf8"));
});

test("TypeScript knows the types, and refuses a wrong one", t => {
  const { folder } = installed(t),
    tsc = join(kRoot, "viewer/page/node_modules/.bin/tsc"),
    check = (name, text) => {
      writeFileSync(join(folder, name), text);
      const compilerOptions = { noEmit: true, strict: true, target: "es2022", module: "nodenext", lib: ["es2022", "dom"], types: [] };
      writeFileSync(join(folder, "tsconfig.json"), JSON.stringify({ compilerOptions, files: [name] }));
      return () => execFileSync(tsc, ["-p", "."], { cwd: folder, encoding: "utf8", stdio: "pipe" });
    };
  const head = 'import { loadBlob, Flags, type Model } from "@lumen/blob";\nimport { gpuVessels, shader } from "@lumen/blob/webgpu";\nimport { LumenCase } from "@lumen/viewer";\n';
  const right = check(
    "good.ts",
    `${head}const model: Model = (await loadBlob()).open(new Uint8Array(3));
const batch = model.batch(2);
batch.query(Flags.LOCAL);
const distance: number = batch.sample(0).distance + model.describe().isoLevel;
const cloud = gpuVessels(null, [model]).batch(3);
cloud.points.set(new Float32Array(9));
const near: Promise<void> = cloud.query(Flags.LOCAL, 0);
const text: string = shader + cloud.distances()[0] + String(near);
const element: LumenCase = document.createElement("lumen-case");
element.src = text + String(distance);\n`,
  );
  right();
  assert.throws(check("bad.ts", `${head}const text: string = (await loadBlob()).open(new Uint8Array(3)).batch(2).distances();\nvoid [LumenCase, gpuVessels, shader];\n`));
});
