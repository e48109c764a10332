// SPDX-License-Identifier: Apache-2.0
// The shader query.wgsl in Chromium, against blob.wasm, which has the bits of the native library.
//
//   device_webgpu.mjs LIBBLOB QUERY.wgsl BLOB.wasm CASE...    LIBBLOB: the folder of libblob's sources
//
// Prints what it compared. Exit code 1: answers differ by more than blob_device.h allows; 77: no browser, or no adapter.
// CHROMIUM: the browser.
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { basename, join, resolve } from "node:path";

const kSkipped = 77, kPoints = 25_000;
const kDistance = 1e-5; // radii, at points within a radius of the wall; else relative
const kSameNode = 0.99999, kExact = 2;
const kSameFoot = 0.99; // exact distances: elsewhere another place of the wall is nearest about it
const kAddress = "http://localhost/"; // a secure context, which WebGPU needs; no request leaves the browser

const [libblob, shaderFile, wasm, ...cases] = process.argv.slice(2);
const browserFile = process.env.CHROMIUM ?? "/usr/bin/chromium";

function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(kSkipped);
}
if (!existsSync(browserFile)) skip(`${browserFile} is missing (apt install chromium)`);
let chromium;
try {
  ({ chromium } = createRequire(resolve(libblob, "../viewer/page/package.json"))("playwright-core"));
} catch {
  skip("playwright-core is missing (npm ci in viewer/page)");
}

const kTypes = { mjs: "text/javascript", html: "text/html" };
const kFiles = {
  "page.html": () => "<!doctype html><title>WebGPU</title>",
  "blob.mjs": () => readFileSync(join(libblob, "wasm/blob.mjs")),
  "gpu.mjs": () => readFileSync(join(libblob, "wasm/gpu.mjs")),
  "query.wgsl": () => readFileSync(shaderFile),
  "blob.wasm": () => readFileSync(wasm),
  ...Object.fromEntries(cases.map(file => [basename(file), () => readFileSync(file)])),
};

/** In the page: a device and the modules, or why there is none. */
async function start() {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) return "no adapter of WebGPU";
  const [{ load, NOWHERE }, { GpuVessels }] = await Promise.all([import("./blob.mjs"), import("./gpu.mjs")]);
  const fetched = async name => (await fetch(name)).arrayBuffer();
  const shader = new TextDecoder().decode(await fetched("query.wgsl"));
  const device = await adapter.requestDevice();
  device.addEventListener("uncapturederror", e => (globalThis.mistake = e.error.message));
  const messages = (await device.createShaderModule({ code: shader }).getCompilationInfo()).messages;
  if (messages.length > 0) throw new Error(messages.map(m => `${m.lineNum}: ${m.message}`).join("\n"));
  Object.assign(globalThis, { NOWHERE, GpuVessels, fetched, shader, device, blob: await load(await fetched("blob.wasm")) });
  return null;
}

/** In the page: how the answers for points about all nodes of a case agree, both ways with cursors that know their node. The
 * case is the second of the buffer's two vessels. */
async function compare({ name, count, flags, near }) {
  const model = blob.open(new Uint8Array(await fetched(name))), words = blob.pack([model, model]);
  const row = 4 + 8, nodes = words[row + 1], first = words[row + 2], floats = new Float32Array(words.buffer);
  const vessels = new GpuVessels(device, shader, words);
  const there = vessels.batch(count), here = model.batch(count);
  let seed = 7;
  const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
  for (let i = 0; i < count; ++i) {
    const node = Math.floor((i * nodes) / count), at = first + 16 * node;
    for (let k = 0; k < 3; ++k) there.points[3 * i + k] = floats[at + k] + floats[at + 3] * (3 * random() - 1.5);
    there.cursors[i] = i % 1000 === 0 ? NOWHERE : node;
  }
  here.points.set(there.points);
  here.cursors.set(there.cursors);
  here.query(flags);
  await there.query(flags, 1);
  const refused = await there.query(flags, 2).then(() => false, error => error instanceof RangeError);
  const result = { refused, same: 0, leaks: 0, inside: 0, distance: 0, near: 0, normal: 0, value: 0, mistake: globalThis.mistake };
  for (let i = 0; i < count; ++i) {
    const a = here.sample(i), b = there.sample(i);
    result.inside += Number(a.inside);
    result.leaks += Number(a.inside !== b.inside && Math.abs(a.distance) > near);
    if (a.node !== b.node) continue;
    ++result.same;
    const radius = floats[first + 16 * a.node + 3], steep = Math.hypot(...a.gradient);
    const error = Math.abs(a.distance - b.distance) / Math.max(radius, a.distance);
    result.distance = Math.max(result.distance, error);
    result.near += Number(error <= near);
    result.value = Math.max(result.value, Math.abs(a.value - b.value) / (1 + a.value));
    for (let k = 0; k < 3 && steep > 0.1; ++k) result.normal = Math.max(result.normal, Math.abs(a.normal[k] - b.normal[k]));
  }
  here.free();
  there.free();
  vessels.destroy();
  model.close();
  return result;
}

const browser = await chromium.launch({
  executablePath: browserFile,
  args: ["--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan"],
});
let failed = false;
try {
  const page = await browser.newPage();
  await page.route(`${kAddress}**`, route => {
    const name = new URL(route.request().url()).pathname.slice(1), file = kFiles[name];
    return file === undefined
      ? route.fulfill({ status: 404 })
      : route.fulfill({ contentType: kTypes[name.split(".").pop()] ?? "application/octet-stream", body: file() });
  });
  await page.goto(`${kAddress}page.html`);
  const missing = await page.evaluate(start);
  if (missing !== null) {
    console.log(`skipped: ${missing}`);
    process.exitCode = kSkipped;
  } else
    for (const file of cases)
      for (const [title, flags] of [["blended", 0], ["local", 1], ["exact", kExact]]) {
        const r = await page.evaluate(compare, { name: basename(file), count: kPoints, flags, near: kDistance });
        console.log(
          `${basename(file)}, ${title}: ${kPoints} points, ${r.inside} inside; same node ${((100 * r.same) / kPoints).toFixed(4)} %, ` +
            `distance within ${r.distance.toExponential(1)} R, ${((100 * r.near) / kPoints).toFixed(3)} % within 1e-5 R, normal ${r.normal.toExponential(1)}, value ${r.value.toExponential(1)}, ${r.leaks} leaks`,
        );
        if (r.mistake) console.log(r.mistake);
        const isSameWall = flags === kExact ? r.near >= kSameFoot * kPoints : r.distance <= kDistance && r.normal <= 1e-4;
        const agree = r.same >= kSameNode * kPoints && r.leaks === 0 && isSameWall && r.value <= kDistance;
        failed ||= !agree || !r.refused || r.mistake !== undefined || r.inside < kPoints / 20 || r.inside > 0.95 * kPoints;
      }
} finally {
  await browser.close();
}
if (failed) process.exitCode = 1;
