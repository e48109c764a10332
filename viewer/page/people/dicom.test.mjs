// SPDX-License-Identifier: Apache-2.0
// Series of DICOM: dropped, chosen as a folder, or named on the command line, and one of them opened as the volume.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { dropFiles, placeSeed, reported, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";
import { dicomSlices, readNrrd } from "./make_dicom.mjs";

/** Two series of one volume, a damaged image and a text. */
function makeSeries(file) {
  lumen("phantom", "bifurcation", file("volume.nrrd"), "--size", "96", "--seeds", file("seeds.json"));
  const volume = readNrrd(file("volume.nrrd"));
  const fine = dicomSlices(volume, { uid: "1.2.3.1", description: "Angiogram", modality: "XA" }),
    coarse = dicomSlices(volume, { uid: "1.2.3.2", description: "Overview", every: 4 });
  return {
    volume,
    files: [
      ...fine,
      ...coarse.map(each => ({ ...each, name: `o-${each.name}` })),
      { name: "broken.dcm", bytes: fine[0].bytes.subarray(0, 400) },
      { name: "notes.txt", bytes: Buffer.from("of the person who made this") },
    ],
  };
}

const rows = page => page.locator("#series-dialog .series");

story(
  "files of DICOM are dropped, one of their series is chosen by its picture, and a vessel tracked in it",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t),
      { files, volume } = makeSeries(file),
      { address } = await view(t);
    const page = await openPage(t, browser, address);
    await dropFiles(
      page,
      files.filter(each => each.name !== "notes.txt"),
    );
    await rows(page).nth(1).waitFor();
    assert.deepEqual(await rows(page).locator("strong").allTextContents(), ["Angiogram", "Overview"]);
    const about = await rows(page).first().textContent();
    assert.match(about, /XA, 96 slices, .* × .* × .* mm, 96 × 96 pixels/);
    assert.doesNotMatch(await page.locator("#series-dialog").textContent(), /Nobody|Real/);
    assert.match(await page.locator("#series-others").textContent(), /1 file cannot be read.*broken\.dcm/);
    const grey = await page
      .locator("#series-dialog canvas")
      .first()
      .evaluate(canvas => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        const values = data.filter((_, i) => i % 4 === 0);
        return [canvas.width, Math.min(...values), Math.max(...values)];
      });
    assert.deepEqual(grey, [96, 0, 255], "a picture of the middle slice");
    await picture(page, "dicom-series");

    await rows(page).first().click();
    await reported(page, /Angiogram is open/);
    await settled(page);
    assert.match(await page.locator("#volume-about").textContent(), /Angiogram: 96 × 96 × 96 voxels/);
    assert.equal(await page.locator("#title").textContent(), "Angiogram");
    const seeds = readFileSync(file("seeds.json"), "utf8"),
      click = JSON.parse(seeds).branches[0].points[0].position;
    assert.ok(volume.size.every(n => n === 96));
    await placeSeed(page, click);
    await page.locator("#seed-list .item").first().waitFor(); // the vessel at the click has been looked for
    await page.keyboard.press("t");
    await page.locator("#tree-list [role=treeitem]").first().waitFor();
    await settled(page);
    assert.ok((await vessels(page)).length >= 1);
    await picture(page, "dicom-tracked");

    // the other one over it, from the list that "Files" keeps, and then in its place
    await page.locator("#series-again").click();
    await rows(page).nth(1).click();
    await page.locator("#ask-second").click();
    await page.locator("#second-about").filter({ hasText: "Overview" }).waitFor();
    await settled(page);
    assert.match(await page.locator("#volume-about").textContent(), /^Angiogram/);
    await picture(page, "13-series-over-the-other");
    await page.locator("#series-again").click();
    await rows(page).nth(1).click();
    await page.locator("#ask-auto").click();
    await page.locator("#volume-about").filter({ hasText: "Overview" }).waitFor();
  },
);

story(
  "a folder of DICOM with other files in it is chosen, and what is wrong in it stops nothing",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t),
      { files } = makeSeries(file),
      folder = file("disc");
    for (const [sub, pick] of [
      ["A", each => !each.name.startsWith("o-")],
      ["B", each => each.name.startsWith("o-")],
    ]) {
      mkdirSync(join(folder, sub), { recursive: true });
      for (const { name, bytes } of files.filter(pick)) writeFileSync(join(folder, sub, name), bytes);
    }
    const { address } = await view(t),
      page = await openPage(t, browser, address);
    const [chooser] = await Promise.all([
      page.waitForEvent("filechooser"),
      page.locator("#open-folder").click(),
    ]);
    await chooser.setFiles(folder);
    await rows(page).nth(1).waitFor();
    await page.locator("#series-others summary").click();
    assert.match(
      await page.locator("#series-others").textContent(),
      /1 file cannot be read; 1 file is no image/,
    );
    await picture(page, "dicom-folder");
    await rows(page).first().click();
    await reported(page, /Angiogram is open/);
    await settled(page);
    assert.match(
      await page.locator("#assumptions, #section-assumptions").first().textContent(),
      /broken\.dcm/,
    );
  },
);

story("lumen view of a folder of several series asks which one", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    { files } = makeSeries(file);
  mkdirSync(file("head"));
  for (const { name, bytes } of files) writeFileSync(join(file("head"), name), bytes);
  const { address } = await view(t, file("head")),
    page = await openPage(t, browser, address);
  await rows(page).nth(1).waitFor();
  assert.match(await page.locator("#series-title").textContent(), /Choose a series of head/);
  await page.keyboard.press("Escape");
  await page.locator("#series-dialog").waitFor({ state: "detached" });
  await page.locator("#series-again").click();
  await rows(page).nth(1).click();
  await reported(page, /Overview is open/);
});
