// SPDX-License-Identifier: Apache-2.0
// The page without a server: a folder of static files in which vessels are found, corrected, measured and saved, without the
// network and with nothing uploaded.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { drop, phantom, reported, step, vessels } from "./hand.mjs";
import { lumen, makeFolder } from "./lumen.mjs";
import { serve } from "./static_server.mjs";

/** The folder of the page, as `lumen view --serverless` writes it. */
function writePage(file) {
  lumen("view", "--serverless", file("site"));
  return file("site");
}

/** The bytes of the document in that format, as a download. */
async function saved(page, format, to) {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    format === "lumen" ? page.keyboard.press("Control+s") : page.locator("#export").selectOption(format),
  ]);
  await download.saveAs(to);
  return readFileSync(to);
}

async function findAll(page) {
  await page.locator("#find").click();
  await reported(page, /proposed/);
  await settled(page);
  await page.locator("#accept-all").click();
  await page.locator("#tree-list [role=treeitem]").first().waitFor();
  await settled(page);
}

story(
  "without a server vessels are found, corrected, measured and saved, and nothing is uploaded",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t);
    phantom(file, "bifurcation", {}, "--size", "64");
    const { address, asked } = await serve(t, writePage(file)),
      page = await openPage(t, browser, address),
      beyond = [];
    page.on("request", request => {
      const url = request.url().replace(/^blob:/, ""); // an address within the tab
      if (request.method() !== "GET" || !url.startsWith(address)) beyond.push(url);
    });
    assert.equal(await page.locator("#status").textContent(), "Engine: this tab, no upload");
    await drop(page, "volume.nrrd", readFileSync(file("volume.nrrd")));
    await reported(page, /volume.nrrd is open/);
    await findAll(page);
    const found = await vessels(page);
    assert.ok(found.length >= 2, `${found}`);

    await page.locator("#tree-list .name").last().click();
    await step(page, () => page.keyboard.press("Delete"));
    assert.equal((await vessels(page)).length, found.length - 1);
    await step(page, () => page.keyboard.press("Control+z"));
    assert.deepEqual(await vessels(page), found);
    await page.locator("body[data-surface=closed]").waitFor();
    await picture(page, "serverless-found");

    if ((await page.locator("#section-geometry[open]").count()) === 0)
      await page.locator("#section-geometry > summary").click();
    await page.locator("#geometry-run").click();
    await page.locator("#geometry-list .item").first().waitFor();
    await settled(page);

    await saved(page, "lumen", file("saved.lumen"));
    lumen("validate", file("saved.lumen"));
    assert.deepEqual(
      lumen("info", file("saved.lumen")).branches.map(branch => branch.label),
      found,
    );
    lumen("info", (await saved(page, "glb", file("saved.glb")), file("saved.glb")));
    assert.ok((await saved(page, "html", file("saved.html"))).includes('id="lumen-embedded"'));
    const zip = await saved(page, "sofa.zip", file("scene.zip"));
    for (const name of ["sofa/README.md", "sofa/lumen-export.json", "sofa/scene.py"])
      assert.ok(zip.includes(name), `${name} is in the zip`);
    assert.deepEqual(beyond, []);
    assert.deepEqual(
      asked.filter(request => !request.startsWith("GET ")),
      [],
    );
  },
);

story("the page opens without the network once it was open, and work in it can be cancelled", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "patient", file("volume.nrrd"), "--voxel", "0.5");
  const { address, stop } = await serve(t, writePage(file)),
    page = await openPage(t, browser, address);
  await page.evaluate(() => globalThis.navigator.serviceWorker.ready);
  stop();
  await page.reload();
  await page.locator("body[data-ready]").waitFor();
  await drop(page, "volume.nrrd", readFileSync(file("volume.nrrd")));
  await reported(page, /volume.nrrd is open/);
  await settled(page);
  await page.locator("#find").click();
  await page.locator("#progress").waitFor();
  await page.keyboard.press("Escape");
  await reported(page, /cancelled; nothing has changed/);
  await settled(page);
  assert.ok(await page.locator("#find").isEnabled());
});

story(
  "a volume that is too large is reported before it is opened, and a smaller copy of it is opened",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t),
      site = writePage(file);
    phantom(file, "bifurcation", {}, "--size", "64");
    const index = readFileSync(`${site}/index.html`, "utf8");
    writeFileSync(
      `${site}/index.html`,
      index.replace('rel="lumen-engine"', 'rel="lumen-engine" data-most-bytes="4000000"'),
    );
    const { address } = await serve(t, site),
      page = await openPage(t, browser, address);
    const bytes = readFileSync(file("volume.nrrd"));
    await drop(page, "volume.nrrd", bytes);
    const dialog = page.locator("dialog");
    await dialog.waitFor();
    assert.match(await dialog.textContent(), /has 64 × 64 × 64 voxels/);
    await picture(page, "serverless-too-large");
    await page.locator("#ask-halve").click();
    await reported(page, /volume.nrrd is open/);
    await settled(page);
    await findAll(page);
    await drop(page, "volume.nrrd", bytes);
    await page.locator("#ask-auto").click();
    await page.locator("#ask-crop").click();
    await page.locator("#ask-text").fill("20-51");
    await page.keyboard.press("Enter");
    await page.locator("#ask-text").waitFor({ state: "detached" });
    await settled(page);
    await reported(page, /volume.nrrd is open/);
  },
);
