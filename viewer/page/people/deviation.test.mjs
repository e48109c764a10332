// SPDX-License-Identifier: Apache-2.0
// A mesh beside a case has the colours of its distance from the wall, with a legend and figures.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { find, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const kShift = 0.5; // mm

/** The mesh in OBJ, moved along x. */
const moved = text => text.replaceAll(/^v (\S+)/gm, (_, x) => `v ${(Number(x) + kShift).toFixed(6)}`);

/** Median and 90th percentile, mm, as the row of that mesh shows them; waits until they are there. */
async function figures(page, name) {
  const output = page.locator(".mesh", { hasText: name }).locator(".deviation");
  await output.filter({ hasText: /^median / }).waitFor();
  return (await output.textContent())
    .match(/median ([\d.]+) mm, 90 % within ([\d.]+) mm/)
    .slice(1)
    .map(Number);
}

const isBlue = (r, g, b) => b > 70 && b > 1.6 * r,
  isRed = (r, g, b) => r > 70 && r > 1.6 * b;

story("a mesh that was moved is blue where it is in the lumen and red where it is outside", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "bifurcation", file("volume.nrrd"), "--size", "64", "--seeds", file("seeds.json"));
  lumen("convert", file("volume.nrrd"), file("fork.lumen"), "--seeds", file("seeds.json"));
  lumen("convert", file("fork.lumen"), file("same.obj"));
  writeFileSync(file("moved.obj"), moved(readFileSync(file("same.obj"), "utf8")));
  const server = await view(t, file("fork.lumen"), file("same.obj"), file("moved.obj")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await page.keyboard.press("3"); // 3D alone
  const box = name => page.locator(".mesh", { hasText: name }).getByLabel("Colour by deviation");
  assert.ok(await page.locator("#deviation-legend").isHidden());

  await box("same.obj").check();
  const [median, most] = await figures(page, "same.obj");
  assert.ok(median <= 0.02 && most <= 0.2, `the case's own mesh is ${median} and ${most} mm from its wall`);
  await box("same.obj").uncheck();
  await page.locator("#deviation-legend").waitFor({ state: "hidden" });
  await page.getByLabel("Opacity of same.obj").fill("0");

  await box("moved.obj").check();
  const [aside, farAside] = await figures(page, "moved.obj");
  assert.ok(
    aside > 0.1 && farAside > aside && farAside <= kShift + 0.02,
    `median ${aside}, 90 % ${farAside}`,
  );
  const legend = page.locator("#deviation-legend");
  assert.match(await legend.textContent(), /Mesh from wall, mm.*median .* mm, 90 % within/);
  const ends = (await legend.locator(".ends span").allTextContents()).map(Number);
  assert.ok(ends[0] === -ends[2] && ends[1] === 0 && ends[2] > 0.3 && ends[2] < 0.6, String(ends));
  await settled(page);
  await picture(page, "13-mesh-by-deviation");
  const shown = await pixels(page, "#view-scene");
  const blue = find(shown, isBlue),
    red = find(shown, isRed);
  assert.ok(blue.count > 500 && red.count > 500, `${blue.count} pixels are blue and ${red.count} red`);
  // seen from the front, the patient's left (greater x, where the mesh was moved to) is on the right
  assert.ok(red.at.x > blue.at.x, `red at ${red.at.x}, blue at ${blue.at.x}`);

  await box("same.obj").check();
  await figures(page, "same.obj");
  const both = await legend.textContent();
  assert.ok(
    ["same.obj", "moved.obj"].every(name => both.includes(`${name}: median `)),
    both,
  );
  await box("same.obj").uncheck();
});

story("the colours follow the wall that the case has", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "bifurcation", file("volume.nrrd"), "--size", "64", "--seeds", file("seeds.json"));
  lumen("convert", file("volume.nrrd"), file("fork.lumen"), "--seeds", file("seeds.json"));
  lumen("convert", file("fork.lumen"), file("same.obj"));
  const server = await view(t, file("fork.lumen"), file("same.obj")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  const output = page.locator(".mesh .deviation");
  await page.getByLabel("Colour by deviation").check();
  const before = await figures(page, "same.obj");
  const text = await output.textContent(),
    names = await vessels(page);
  await page.locator("#tree-list [role=treeitem]").last().click();
  await page.keyboard.press("Delete");
  await output
    .filter({ hasNotText: text })
    .filter({ hasText: /^median / })
    .waitFor();
  const after = await figures(page, "same.obj");
  assert.ok(after[1] > before[1] + 1, `without a vessel 90 % are within ${after[1]} mm, before ${before[1]}`);
  assert.ok((await vessels(page)).length < names.length);
  await picture(page, "13-deviation-of-a-vessel-that-was-deleted");
  await page.keyboard.press("Control+z");
  await output.filter({ hasText: text }).waitFor();

  writeFileSync(file("same.obj"), moved(readFileSync(file("same.obj"), "utf8")));
  await page.locator("#section-files .changed").waitFor();
  await page.getByRole("button", { name: "Read same.obj again" }).click();
  await output
    .filter({ hasNotText: text })
    .filter({ hasText: /^median / })
    .waitFor();
  const again = await figures(page, "same.obj");
  assert.ok(
    again[0] > before[0] + 0.05,
    `the mesh as it is on disk is ${again[0]} mm away, before ${before[0]}`,
  );
  assert.ok(await page.getByLabel("Colour by deviation").isChecked(), "it looks as it was made to look");

  lumen("view", file("fork.lumen"), file("same.obj"), "--html", file("page.html"));
  const alone = await openPage(t, browser, pathToFileURL(file("page.html")).href, { offline: true });
  await settled(alone);
  await alone.getByLabel("Colour by deviation").check();
  assert.deepEqual(await figures(alone, "same.obj"), again, "the page as one file has the same figures");
  await alone.keyboard.press("3");
  const sides = await pixels(alone, "#view-scene"),
    blue = find(sides, isBlue),
    red = find(sides, isRed);
  assert.ok(blue.count > 300 && red.count > 300, `${blue.count} pixels are blue and ${red.count} red`);
  assert.ok(
    red.at.x > blue.at.x + 5,
    `each vertex has its own distance: red at ${red.at.x}, blue at ${blue.at.x}`,
  );
  await picture(alone, "13-deviation-from-disk");
});
