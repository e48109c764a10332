// SPDX-License-Identifier: Apache-2.0
// A second volume over or beside the first: other voxels and other axes, the same places.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { frames, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { drop, placeIn, reported } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const kTurned = Math.PI / 6, // about z, of the second volume's axes
  kBright = 1000,
  kAlong = 12, // mm from the beginning of the tube to the middle of the second volume
  kFar = 1.5; // mm, radius of the ball and of the rod

/** Writes a volume of 70 x 60 x 40 voxels of 0.4 x 0.5 x 0.8 mm about `middle`, turned about z: a bright rod along z
 * through `rod` and a bright ball at `ball`, on a ground that grows brighter along z. */
function writeTurned(path, middle, rod, ball) {
  const size = [70, 60, 40],
    spacing = [0.4, 0.5, 0.8],
    [c, s] = [Math.cos(kTurned), Math.sin(kTurned)],
    axes = [
      [c, s, 0],
      [-s, c, 0],
      [0, 0, 1],
    ];
  const origin = [0, 1, 2].map(
    r => middle[r] - axes.reduce((sum, axis, a) => sum + (axis[r] * spacing[a] * (size[a] - 1)) / 2, 0),
  );
  const voxels = new Int16Array(size[0] * size[1] * size[2]);
  for (let k = 0, at = 0; k < size[2]; ++k)
    for (let j = 0; j < size[1]; ++j)
      for (let i = 0; i < size[0]; ++i, ++at) {
        const p = [0, 1, 2].map(
          r =>
            origin[r] +
            axes[0][r] * spacing[0] * i +
            axes[1][r] * spacing[1] * j +
            axes[2][r] * spacing[2] * k,
        );
        const isRod = Math.hypot(p[0] - rod[0], p[1] - rod[1]) < kFar,
          isBall = Math.hypot(...p.map((x, a) => x - ball[a])) < kFar;
        voxels[at] = isRod || isBall ? kBright : 4 * k;
      }
  const vector = v => `(${v.join(",")})`;
  const head = [
    "NRRD0004",
    "type: short",
    "dimension: 3",
    "space: left-posterior-superior",
    `sizes: ${size.join(" ")}`,
    `space directions: ${axes.map((axis, a) => vector(axis.map(x => x * spacing[a]))).join(" ")}`,
    `space origin: ${vector(origin)}`,
    "endian: little",
    "encoding: raw",
    "",
    "",
  ].join("\n");
  writeFileSync(path, Buffer.concat([Buffer.from(head), Buffer.from(voxels.buffer)]));
}

/** A phantom's tube, a place on it, and one beside it that no line of the crosshair crosses. */
function makeVolumes(file) {
  lumen("phantom", "tube", file("volume.nrrd"), "--seeds", file("seeds.json"));
  const [{ direction, points }] = JSON.parse(readFileSync(file("seeds.json"), "utf8")).branches,
    tube = points[0].position.map((x, a) => x + kAlong * direction[a]),
    beside = [tube[0] + 5, tube[1] + 4, tube[2]];
  writeTurned(file("turned.nrrd"), tube, tube, beside);
  return { tube, beside };
}

const text = (page, id) => page.locator(id).textContent();
/** Red, green and blue of the axial slice at a place. */
async function colourAt(page, place) {
  const box = await page.locator("#view-axial").boundingBox(),
    at = await placeIn(page, "axial", place);
  await page.mouse.move(2, 300); // away: a pointer has a mark
  const { data, width } = await pixels(page, "#view-axial"),
    i = 4 * (Math.round(at.y - box.y) * width + Math.round(at.x - box.x));
  return [...data.subarray(i, i + 3)];
}
const slide = (page, id, value) =>
  page.locator(id).evaluate((field, to) => {
    field.value = String(to);
    field.dispatchEvent(new window.Event("input"));
  }, value);

async function openBoth(t, file, browser) {
  const { address } = await view(t, file("volume.nrrd"), file("turned.nrrd")),
    page = await openPage(t, browser, address);
  await settled(page);
  await page.locator("#section-second").waitFor();
  return page;
}

story("a second volume is blended over the first where its file places it", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    { tube, beside } = makeVolumes(file),
    page = await openBoth(t, file, browser);
  await page.keyboard.press("4"); // the axial slice alone
  await lookAtAxial(page, tube);
  assert.match(
    await text(page, "#second-about"),
    /turned\.nrrd: 70 × 60 × 40 voxels of 0\.40 × 0\.50 × 0\.80 mm/,
  );
  assert.ok(await page.locator("#second-doubt").isHidden());
  const at = await placeIn(page, "axial", beside);
  await page.mouse.move(at.x, at.y);
  await page.waitForFunction(() => Number(document.querySelector("#probe-second").textContent) > 900);
  await picture(page, "13-blend");

  await slide(page, "#beside-share", 1);
  const [red, , blue] = await colourAt(page, beside);
  assert.ok(red > 200, `the ball of the second volume is bright: ${red}`);
  await slide(page, "#beside-share", 0);
  const without = await colourAt(page, beside);
  assert.ok(without[0] < 0.6 * red, `without the second volume nothing is bright there: ${without}`);
  await slide(page, "#beside-share", 0.5);
  const half = (await colourAt(page, beside))[0];
  assert.ok(
    Math.abs(half - (red + without[0]) / 2) < 6,
    `${half} is half-way between ${red} and ${without[0]}`,
  );
  assert.ok(blue >= 0);

  await page.locator("#second-window-low").fill("0");
  await page.locator("#second-window-high").fill("4000");
  await page.locator("#second-window-high").press("Tab");
  const dim = (await colourAt(page, beside))[0];
  assert.ok(dim < half - 10, `a wider window of its own makes it darker: ${dim} < ${half}`);
  await page.locator("#second-window-auto").click();
  await page.locator("#beside-mode").selectOption("off");
  assert.deepEqual(await colourAt(page, beside), without, "off is as if it were not there");
});

/** Brings the axial slice, alone, to the height of a place by the field for coordinates. */
async function lookAtAxial(page, place) {
  await page.keyboard.press("j");
  await page.locator("#ask-text").fill(place.join(" "));
  await page.keyboard.press("Enter");
  await frames(page, 3);
}

story("both volumes are side by side, and the line between them can be dragged", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    { tube, beside } = makeVolumes(file),
    page = await openBoth(t, file, browser);
  await page.locator("#beside-mode").selectOption("split");
  await picture(page, "13-side-by-side");
  await page.keyboard.press("4");
  await lookAtAxial(page, tube);
  const line = page.locator("#view-axial .splitline"),
    box = await page.locator("#view-axial").boundingBox(),
    at = await placeIn(page, "axial", beside);
  const dragTo = async x => {
    const now = await line.boundingBox();
    await page.mouse.move(now.x + now.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(x, box.y + box.height / 2, { steps: 4 });
    await page.mouse.up();
    await frames(page, 3);
  };
  await dragTo(at.x - 25);
  const second = await colourAt(page, beside);
  await picture(page, "13-line-left-of-the-ball");
  await dragTo(at.x + 25);
  const first = await colourAt(page, beside);
  assert.ok(second[0] > 200 && first[0] < 150, `right of the line ${second}, left of it ${first}`);
  assert.deepEqual(second, [second[0], second[0], second[0]], "side by side both are grey");

  const windows = () =>
    Promise.all(["#window-high", "#second-window-high"].map(id => page.locator(id).inputValue()));
  const before = await windows();
  await page.mouse.move(box.x + box.width - 60, box.y + 120);
  await page.mouse.down({ button: "right" });
  await page.mouse.move(box.x + box.width - 20, box.y + 120, { steps: 4 });
  await page.mouse.up({ button: "right" });
  const after = await windows();
  assert.equal(after[0], before[0], "the window of the volume on the other side stays");
  assert.notEqual(after[1], before[1]);

  await page.waitForTimeout(600); // until the page has kept it
  await page.reload();
  await settled(page);
  await line.waitFor();
  assert.equal(await page.locator("#beside-mode").inputValue(), "split", "the view is kept");
});

story(
  "a volume that is dropped on another is asked about, and one that lies elsewhere is warned of",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t),
      { tube, beside } = makeVolumes(file);
    writeTurned(
      file("elsewhere.nrrd"),
      tube.map(x => x + 500),
      tube,
      beside,
    );
    const { address } = await view(t, file("volume.nrrd")),
      page = await openPage(t, browser, address);
    await settled(page);
    assert.ok(await page.locator("#section-second").isHidden());
    await drop(page, "turned.nrrd", readFileSync(file("turned.nrrd")));
    await page.locator("#ask-second").waitFor();
    await picture(page, "13-question");
    await page.locator("#ask-second").click();
    await page.locator("#section-second").waitFor();
    await settled(page);
    assert.match(await text(page, "#volume-about"), /^volume\.nrrd/);
    assert.ok(await page.locator("#second-doubt").isHidden());

    await drop(page, "elsewhere.nrrd", readFileSync(file("elsewhere.nrrd")));
    await page.locator("#ask-second").click();
    assert.match(
      await reported(page, /elsewhere/, "warning"),
      /elsewhere\.nrrd and volume\.nrrd do not overlap/,
    );
    await page.locator("#second-doubt").filter({ hasText: "do not overlap" }).waitFor();
    await picture(page, "13-elsewhere");

    await page.keyboard.press("Control+z");
    await page.locator("#second-about").filter({ hasText: "turned.nrrd" }).waitFor();
    await drop(page, "turned.nrrd", readFileSync(file("turned.nrrd")));
    await page.locator("#ask-auto").click();
    await page.locator("#volume-about").filter({ hasText: "turned.nrrd" }).waitFor();
    assert.match(await page.locator("#second-doubt").textContent(), /is the same volume as/);
    await page.locator("#section-files > summary").click();
    await page.getByRole("button", { name: "Close turned.nrrd" }).last().click();
    await page.locator("#section-second").waitFor({ state: "hidden" });
  },
);
