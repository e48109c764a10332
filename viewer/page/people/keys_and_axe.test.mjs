// SPDX-License-Identifier: Apache-2.0
// Without a pointer: from an empty list to a vessel. And axe-core finds no fault in names, roles, contrast and order of the page,
// in the dark and in the light, wide and narrow.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { drop, phantom, position, step } from "./hand.mjs";
import { makeFolder, view } from "./lumen.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const kMostTabs = 60;

async function findings(page) {
  const { violations } = await page.evaluate(() => globalThis.axe.run(document));
  return violations.map(
    v =>
      `${v.id}: ${v.help}\n${v.nodes.map(n => `  ${n.target.join(" ")}\n  ${n.failureSummary}`).join("\n")}`,
  );
}

/** Goes on to an element by the tabulator alone. */
async function tabTo(page, selector, key = "Tab") {
  for (let k = 0; k < kMostTabs && (await page.locator(`${selector}:focus`).count()) === 0; ++k)
    await page.keyboard.press(key);
  assert.equal(await page.locator(`${selector}:focus`).count(), 1, `${selector} is reached by ${key}`);
}

/** Steps of voxels to a place, along one axis after the other. */
async function stepTo(page, wanted) {
  for (const [axis, more, less] of [
    [0, "ArrowRight", "ArrowLeft"],
    [1, "ArrowDown", "ArrowUp"],
    [2, "PageUp", "PageDown"],
  ])
    for (let at = await position(page); Math.abs(at[axis] - wanted[axis]) > 0.15; at = await position(page)) {
      await page.keyboard.press(at[axis] < wanted[axis] ? more : less);
      await page.waitForFunction(
        ([a, x]) => Number(document.getElementById("probe-position").dataset.mm.split(" ")[a]) !== x,
        [axis, at[axis]],
      );
    }
}

story("a vessel is tracked by keys alone, and axe-core finds no fault whatever the page shows", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    [place] = phantom(file, "bifurcation", {}, "--size", "48"),
    server = await view(t, file("volume.nrrd")),
    page = await openPage(t, browser, server.address, { reducedMotion: "reduce" }); // half-way between two themes is neither
  await settled(page);
  await tabTo(page, "#view-axial");
  await page.keyboard.press("s");
  await stepTo(page, place);
  await page.keyboard.press("Enter");
  await page.locator("#seed-list .item").first().waitFor();
  await step(page, () => page.keyboard.press("t"));
  await tabTo(page, "#tree-list", "Shift+Tab");
  await page.keyboard.press("ArrowDown");
  await page.locator("#branch-name").waitFor();
  await picture(page, "keys-tracked");

  await page.keyboard.press("k");
  await page.locator("#work-list .item").first().waitFor();
  await page.keyboard.press("Shift+F");
  await page.locator("#proposal-list .item").first().waitFor();
  await page.locator("#measure-probe").click();
  await drop(page, "second.nrrd", readFileSync(file("volume.nrrd")));
  await page.locator("#ask-second").waitFor();
  await page.evaluate(axe); // not as a script of the page, which its policy would refuse
  assert.deepEqual(await findings(page), [], "a question");
  await page.locator("#ask-second").click();
  await page.locator("#section-second").waitFor();
  await page.locator("#beside-mode").selectOption("split");
  for (const closed of await page.locator("details:not([open]) > summary").all())
    if (await closed.isVisible()) await closed.click();
  await settled(page);
  for (const theme of ["dark", "light"]) {
    assert.deepEqual(await findings(page), [], `${theme}, wide`);
    await page.keyboard.press("?");
    await page.locator("#help-page").waitFor();
    assert.deepEqual(await findings(page), [], `${theme}, help`);
    await page.keyboard.press("Escape");
    await page.locator("#help-page").waitFor({ state: "detached" });
    await page.keyboard.press("Shift+L");
  }
  await page.setViewportSize({ width: 390, height: 780 });
  assert.deepEqual(await findings(page), [], "narrow");
  const wide = await page.evaluate(() =>
    [...document.body.querySelectorAll("*")]
      .filter(
        e =>
          e.checkVisibility() && e.getBoundingClientRect().right > document.documentElement.clientWidth + 0.5,
      )
      .map(e => `${e.tagName}#${e.id}.${e.className}`),
  );
  assert.ok(
    await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth),
    `a phone scrolls in one direction: ${wide.join(" ")}`,
  );
  await page.locator("#fold-right").click();
  assert.deepEqual(await findings(page), [], "narrow, with a panel");
});
