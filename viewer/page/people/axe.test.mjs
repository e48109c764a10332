// SPDX-License-Identifier: Apache-2.0
// axe-core has nothing to say of the page: names, roles, contrast, order, in the dark and in the light, wide and narrow.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { settled, startBrowser, story } from "./browser.mjs";
import { drop, firstVessel, openVessels } from "./hand.mjs";
import { lumen, makeFolder } from "./lumen.mjs";

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
  const file = makeFolder(),
    browser = await startBrowser(t);
  firstVessel(file, "bifurcation");
  const page = await openVessels(t, browser, file);
  await page.emulateMedia({ reducedMotion: "reduce" }); // a colour half way between two themes is neither's
  await page.locator("#tree-list [role=treeitem]").first().click();
  await page.keyboard.press("k");
  await page.locator("#work-list .item").first().waitFor();
  await page.keyboard.press("Shift+F");
  await page.locator("#proposal-list .item").first().waitFor();
  await page.locator("#measure-probe").click();
  lumen("phantom", "tube", file("second.nrrd"), "--size", "40");
  await drop(page, "second.nrrd", readFileSync(file("second.nrrd")));
  await page.locator("#ask-second").waitFor();
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
