// SPDX-License-Identifier: Apache-2.0
// Slices: windows, slabs, a second volume over the first, names, coordinates, and a view that survives a reload.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { frames, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { away, crosshair, drop, lookAt, phantom, placeIn, position, type, vessel } from "./hand.mjs";
import { makeFolder, view } from "./lumen.mjs";

const kTurned = Math.PI / 6, // about z, of the second volume's axes
  kBright = 1000,
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
        const isRod = Math.hypot(p[0] - rod[0], p[1] - rod[1]) < kFar;
        voxels[at] = isRod || away(p, ball) < kFar ? kBright : 4 * k;
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

const value = (page, id) => page.locator(id).inputValue();

/** Red, green and blue of the axial slice at a place. */
async function colourAt(page, place) {
  const box = await page.locator("#view-axial").boundingBox(),
    at = await placeIn(page, "axial", place);
  await page.mouse.move(2, 300); // away: a pointer has a mark
  const { data, width } = await pixels(page, "#view-axial"),
    i = 4 * (Math.round(at.y - box.y) * width + Math.round(at.x - box.x));
  return [...data.subarray(i, i + 3)];
}
const slide = (page, id, to) =>
  page.locator(id).evaluate((field, text) => {
    field.value = text;
    field.dispatchEvent(new window.Event("input"));
  }, String(to));

async function goTo(page, text) {
  await page.keyboard.press("j");
  await type(page, text);
}

/** Waits until the page has kept its view with such a part of it. */
const kept = (page, part) =>
  page.waitForFunction(
    text => Object.values(globalThis.sessionStorage).some(view => String(view).includes(text)),
    part,
  );

/** A slab shows the tube beside the plane, and a click in it takes the tube. */
async function clickInASlab(page, [x, y, z]) {
  await lookAt(page, [x, y, z]);
  await page.locator("#view-coronal").focus();
  for (let i = 0; i < 15; ++i) await page.keyboard.press("Shift+PageUp"); // away from the tube
  const plane = await crosshair(page),
    at = await placeIn(page, "coronal", [x, plane[1], z]); // in a slab, the line shows what is drawn
  assert.ok(await page.locator("#slab-coronal-mm").isHidden());
  await page.locator("#view-coronal").focus();
  await page.keyboard.press("7");
  assert.equal(await value(page, "#slab-coronal"), "max");
  assert.equal(await value(page, "#slab-axial"), "off", "each slice has its own");
  for (let i = 0; i < 8; ++i) await page.keyboard.press("9");
  assert.ok(Number(await value(page, "#slab-coronal-mm")) > 2 * Math.abs(plane[1] - y));
  await page.keyboard.press("n");
  await page.mouse.click(at.x, at.y);
  const taken = await crosshair(page);
  assert.ok(
    Math.abs(taken[1] - y) < 1.5,
    `the click at depth ${plane[1]} took ${taken[1]}, the tube is at ${y}`,
  );
  await picture(page, "slices-slab");
  await page.locator("#slab-coronal").selectOption("off");
}

/** The second volume is blended over the first with a share and a window of its own, and beside it. */
async function blend(page, tube, beside) {
  await page.keyboard.press("4"); // the axial slice alone
  await goTo(page, tube.join(" "));
  const at = await placeIn(page, "axial", beside);
  await page.mouse.move(at.x, at.y);
  await page.waitForFunction(() => Number(document.querySelector("#probe-second").textContent) > 900);
  await slide(page, "#beside-share", 1);
  const [red] = await colourAt(page, beside);
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
  await page.locator("#second-window-low").fill("0");
  await page.locator("#second-window-high").fill("4000");
  await page.locator("#second-window-high").press("Tab");
  const dim = (await colourAt(page, beside))[0];
  assert.ok(dim < half - 10, `a wider window of its own makes it darker: ${dim} < ${half}`);
  await page.locator("#second-window-auto").click();

  await page.locator("#beside-mode").selectOption("split");
  const line = page.locator("#view-axial .splitline"),
    box = await page.locator("#view-axial").boundingBox();
  const dragTo = async x => {
    const now = await line.boundingBox();
    await page.mouse.move(now.x + now.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(x, box.y + box.height / 2, { steps: 4 });
    await page.mouse.up();
    await frames(page, 3);
  };
  await dragTo(at.x - 25);
  const right = await colourAt(page, beside);
  await picture(page, "slices-side-by-side");
  await dragTo(at.x + 25);
  const left = await colourAt(page, beside);
  assert.ok(right[0] > 200 && left[0] < 150, `right of the line ${right}, left of it ${left}`);
}

story("slices show windows, slabs and a second volume, and keep what a person has set up", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    [tube] = phantom(file, "tube", { "tube.lumen": 1 }, "--size", "64"),
    beside = [tube[0] + 5, tube[1] + 4, tube[2]];
  writeTurned(file("turned.nrrd"), tube, tube, beside);
  const server = await view(t, file("volume.nrrd"), file("tube.lumen")),
    page = await openPage(t, browser, server.address);
  await settled(page);

  await page.locator("#window-preset").selectOption("abdomen");
  assert.deepEqual([await value(page, "#window-low"), await value(page, "#window-high")], ["-160", "240"]);
  await page.locator("#window-auto").click();
  assert.equal(await value(page, "#window-preset"), "");
  await clickInASlab(page, tube);

  // a volume that is dropped on another is asked about
  await drop(page, "turned.nrrd", readFileSync(file("turned.nrrd")));
  await page.locator("#ask-second").click();
  await page.locator("#second-about").filter({ hasText: "turned.nrrd: 70 × 60 × 40 voxels" }).waitFor();
  await settled(page);
  assert.ok(await page.locator("#second-doubt").isHidden());
  await blend(page, tube, beside);

  // coordinates are typed and shown in the axes that were chosen
  await goTo(page, "10.5, 11 12");
  assert.ok(away(await crosshair(page), [10.5, 11, 12]) < 0.02);
  await page.locator("#probe-frame").click();
  assert.equal(await page.locator("#probe-position").textContent(), "-10.50  -11.00  12.00");
  await goTo(page, "-9 -8 7");
  assert.ok(away(await position(page), [9, 8, 7]) < 0.02, "typed in the axes that are shown");

  // a reload keeps the view; hidden vessels stay hidden
  await page.keyboard.press("2");
  await vessel(page, "root").locator(".name").click();
  await page.keyboard.press("h");
  await page.locator("#measure-probe").click();
  await page.locator("#measure-list .item").first().waitFor();
  await kept(page, '"kind":"probe"');
  await page.reload();
  await settled(page);
  await page.locator("#measure-list .item").first().waitFor();
  assert.equal(await page.locator("#probe-frame").textContent(), "RAS");
  assert.equal(await value(page, "#layout"), "rows");
  assert.equal(await value(page, "#beside-mode"), "split");
  assert.equal(await page.locator("#tree-list [role=treeitem].off").count(), 1);
  await picture(page, "slices-after-reload");
});
