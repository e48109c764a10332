// SPDX-License-Identifier: Apache-2.0
// axe-core has nothing to say of the page: names, roles, contrast, order, in the dark and in the light, wide and narrow.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { openPage, settled, startBrowser, story } from "./browser.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

async function findings(page) {
  await page.evaluate(axe); // not as a script of the page, which its policy would refuse
  const { violations } = await page.evaluate(() => globalThis.axe.run(document));
  return violations.map(
    v =>
      `${v.id}: ${v.help}\n${v.nodes.map(n => `  ${n.target.join(" ")}\n  ${n.failureSummary}`).join("\n")}`,
  );
}

story("axe-core finds no fault in the page, whatever it shows", async t => {
  const file = makeFolder(t),
    browser = await startBrowser(t);
  lumen("phantom", "bifurcation", file("volume.nrrd"), "--seeds", file("seeds.json"));
  const seeds = JSON.parse(readFileSync(file("seeds.json"), "utf8"));
  writeFileSync(file("one.json"), JSON.stringify({ ...seeds, branches: seeds.branches.slice(0, 1) }));
  lumen("convert", file("volume.nrrd"), file("vessels.lumen"), "--seeds", file("one.json"), "--seeds-only");
  const server = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await page.locator("#tree-list [role=treeitem]").first().click();
  await page.keyboard.press("k");
  await page.locator("#work-list .item").first().waitFor();
  await page.keyboard.press("Shift+F");
  await page.locator("#proposal-list .item").first().waitFor();
  await page.locator("#measure-probe").click();
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
