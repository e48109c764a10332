// SPDX-License-Identifier: Apache-2.0
// A volume and its label map are dropped together: labels are seen with their roles, one gets another role by a click, and the
// vessels that are found have the names and systems of their labels, as `lumen convert` gives them.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { frames, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { document, dropFiles, lookAt, phantom, placeIn, reported, step, undo, vessel } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const kNames = ["femoral artery", "side vessel", "muscle"];

/** Writes the two vessels of a truth as labels 2 and 5 with names, and a corner of the volume as label 7. */
function writeLabels(path, { metadata, tree }) {
  const { size, spacing } = metadata.source,
    [nx, ny, nz] = size,
    voxels = new Uint8Array(nx * ny * nz);
  tree.centre.forEach((centre, n) => {
    const reach = Math.ceil(tree.radius[n] / spacing[0]),
      [i, j, k] = centre.map((x, a) => Math.round(x / spacing[a])),
      within = (at, count) => at >= 0 && at < count;
    for (let c = k - reach; c <= k + reach; ++c)
      for (let b = j - reach; b <= j + reach; ++b)
        for (let a = i - reach; a <= i + reach; ++a)
          if (within(a, nx) && within(b, ny) && within(c, nz) && Math.hypot(a - i, b - j, c - k) <= reach)
            voxels[a + nx * (b + ny * c)] ||= tree.branch[n] === 0 ? 2 : 5;
  });
  for (let at = 0; at < voxels.length; ++at)
    if (at % nx < 8 && Math.floor(at / nx) % ny < 8) voxels[at] ||= 7;
  const segments = kNames.flatMap((name, i) => [
    `Segment${i}_LabelValue:=${[2, 5, 7][i]}`,
    `Segment${i}_Name:=${name}`,
  ]);
  const head = [
    "NRRD0004",
    "type: uint8",
    "dimension: 3",
    "space: left-posterior-superior",
    `sizes: ${size.join(" ")}`,
    `space directions: ${spacing.map((mm, a) => `(${[0, 1, 2].map(b => (a === b ? mm : 0)).join(",")})`).join(" ")}`,
    "space origin: (0,0,0)",
    "encoding: raw",
    ...segments,
    "",
    "",
  ].join("\n");
  writeFileSync(path, Buffer.concat([Buffer.from(head), Buffer.from(voxels)]));
}

/** Red, green and blue of the axial slice at a place. */
async function colourAt(page, place) {
  const box = await page.locator("#view-axial").boundingBox(),
    at = await placeIn(page, "axial", place);
  await page.mouse.move(2, 300); // away: a pointer has a mark
  const { data, width } = await pixels(page, "#view-axial"),
    i = 4 * (Math.round(at.y - box.y) * width + Math.round(at.x - box.x));
  return [...data.subarray(i, i + 3)];
}
const spread = colour => Math.max(...colour) - Math.min(...colour);

/** The names and systems of the vessels in a file, in the order of their names. */
function vesselsOf(file) {
  return lumen("info", file)
    .branches.map(({ label, system }) => `${label}: ${system}`)
    .sort();
}

/** The labels are listed with their roles, seen in the slices, and named under the pointer. */
async function seeLabels(page, corner) {
  const rows = page.locator("#label-list .item");
  assert.deepEqual(await rows.locator(".link").allTextContents(), kNames);
  const roles = await rows.locator("select").evaluateAll(all => all.map(({ value }) => value));
  assert.deepEqual(roles, ["artery", "vessel", "organ"]);
  assert.match(await page.locator("#role-2").getAttribute("title"), /its header, its name/);
  await page.keyboard.press("4"); // the axial slice alone
  await frames(page, 3);
  const at = await placeIn(page, "axial", corner);
  await page.mouse.move(at.x, at.y);
  await page.locator("#probe-label").filter({ hasText: "7 muscle" }).waitFor();
  assert.ok(spread(await colourAt(page, corner)) > 25, "a label has a colour");
  await rows.nth(2).getByRole("button", { name: "Show or hide muscle" }).click();
  assert.ok(spread(await colourAt(page, corner)) < 6, "a hidden label leaves the volume grey");
  await page.locator("#labels-all").click();
  await page.locator("#label-mode").selectOption("outline");
  assert.ok(spread(await colourAt(page, corner)) < 6, "an outline leaves the middle of a label grey");
  await page.locator("#label-mode").selectOption("fill");
  await page.locator("#label-search").fill("organ");
  assert.equal(await rows.filter({ visible: true }).count(), 1, "a search finds labels by their roles");
  await page.locator("#label-search").fill("");
  await rows.nth(2).locator(".link").click();
  await page.keyboard.press("1");
}

story(
  "a volume and its label map are dropped, a role is changed, and the case has names and systems",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t),
      [first] = phantom(file, "kissing", {}, "--size", "64", "--truth", file("truth.lumen.json"));
    writeLabels(file("labels.seg.nrrd"), JSON.parse(readFileSync(file("truth.lumen.json"), "utf8")));
    const server = await view(t),
      page = await openPage(t, browser, server.address);
    await dropFiles(
      page,
      ["labels.seg.nrrd", "volume.nrrd"].map(name => ({ name, bytes: readFileSync(file(name)) })),
    );
    await page.locator("#ask-labels").click(); // the map comes behind the volume, and is asked about
    await page.locator("#labels-about").filter({ hasText: "labels.seg.nrrd: 3 labels" }).waitFor();
    await settled(page);
    await lookAt(page, first);
    await seeLabels(page, [0.8, 0.8, first[2]]);

    await step(page, () => page.locator("#role-5").selectOption("vein"));
    assert.match(await page.locator("#role-5").getAttribute("title"), /the page/);
    await undo(page);
    assert.equal(await page.locator("#role-5").inputValue(), "vessel");
    await step(page, () => page.locator("#role-5").selectOption("vein"));
    await lookAt(page, first);
    await picture(page, "labels-roles");

    await page.keyboard.press("Shift+F");
    await reported(page, /vessels? (is|are) proposed/);
    await settled(page);
    await page
      .locator('#proposal-list .item[data-label="side vessel"]')
      .filter({ hasText: "vein, " })
      .waitFor();
    await step(page, () => page.locator("#accept-all").click());
    await vessel(page, "side vessel").locator(".name").click();
    await page.locator("#branch-detail").filter({ hasText: "vein" }).waitFor();
    await picture(page, "labels-case");
    writeFileSync(file("page.lumen"), await document(page));
    lumen(
      "convert",
      file("volume.nrrd"),
      file("program.lumen"),
      "--label-map",
      file("labels.seg.nrrd"),
      "--role",
      "side vessel=vein",
    );
    const made = vesselsOf(file("page.lumen"));
    assert.deepEqual(made, vesselsOf(file("program.lumen")));
    for (const known of ["femoral artery: artery", "side vessel: vein"])
      assert.ok(made.includes(known), made.join());
  },
);
