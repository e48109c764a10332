// SPDX-License-Identifier: Apache-2.0
// Among many vessels names can be read whatever their depth, a search takes one key, and the chosen one stands out.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { frames, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { step, type, undo, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";
import { drawn, noteDrawings } from "./turning.mjs";

const kDepth = 9,
  kRest = 0.5; // share of their brightness that the others keep beside a chosen vessel

/** SWC of a trunk, a thin vessel behind it as seen from the front, and a staircase whose branches leave one another. */
function staircase() {
  const rows = [];
  const line = (from, to, radius, parent, count = 12) => {
    for (let k = 0; k <= count; ++k) {
      const p = from.map((x, a) => x + ((to[a] - x) * k) / count);
      rows.push(`${rows.length + 1} 2 ${p.join(" ")} ${radius} ${k === 0 ? parent : rows.length}`);
    }
    return rows.length;
  };
  line([0, 0, 0], [0, 0, 60], 4, -1, 30);
  line([0, 12, 15], [0, 12, 45], 1, -1);
  let last = 30; // near the trunk's end
  for (let d = 0; d < kDepth; ++d) {
    const at = rows[last - 1].split(" ").slice(2, 5).map(Number);
    line(at, [at[0] - 10, at[1], at[2] - 4], 1, last); // a side branch, which makes a fork of the place
    last = line(at, [at[0] + 8, at[1], at[2] + (d % 2 === 0 ? 8 : -8)], 1.2, last);
    last -= 1;
  }
  return `${rows.join("\n")}\n`;
}

const sum = ({ data }, i) => data[i] + data[i + 1] + data[i + 2];

/** The share of their brightness that pixels keep, in the median of those that were bright. */
function keptShare(before, after) {
  const shares = [];
  for (let i = 0; i < before.data.length; i += 4)
    if (sum(before, i) > 150) shares.push(sum(after, i) / sum(before, i));
  return shares.sort((a, b) => a - b)[shares.length >> 1];
}

/** Sets by Shift and Ctrl, of a tree and of all in the list; hidden, deleted, kept, and brought back by one undo each. */
async function chooseSets(page, rows) {
  const row = k => rows.nth(k).locator(".name"),
    all = await rows.count(),
    count = page.locator("#set-count");
  await row(3).click();
  await row(6).click({ modifiers: ["Shift"] });
  await count.filter({ hasText: `4 of ${all}` }).waitFor();
  await row(5).click({ modifiers: ["Control"] });
  await row(0).click({ modifiers: ["Control"] });
  await count.filter({ hasText: `4 of ${all}` }).waitFor();
  await picture(page, "many-set");
  await page.locator("#set-hide").click();
  assert.equal(await page.locator("#tree-list .off").count(), 4);
  await page.keyboard.press("Shift+H");

  const labels = await vessels(page);
  await row(1).click();
  await row(4).click({ modifiers: ["Shift"] });
  await step(page, () => page.keyboard.press("Delete"));
  assert.deepEqual((await vessels(page)).toSorted(), labels.toSpliced(1, 4).toSorted());
  assert.match(await page.locator("#undo").getAttribute("title"), /deleted 4 vessels/);
  await undo(page);
  assert.deepEqual(await vessels(page), labels);

  await row(2).click();
  await page.locator("#set-choose").selectOption("tree");
  await count.filter({ hasText: `${all - 1} of ${all}` }).waitFor(); // all but the thin vessel, a tree of its own
  await step(page, () => page.locator("#set-keep").click());
  assert.deepEqual(await vessels(page), labels.slice(0, -1));
  await undo(page);
  assert.deepEqual(await vessels(page), labels);
  await page.locator("#tree-list").focus();
  await page.keyboard.press("Control+a");
  await count.filter({ hasText: `${all} of ${all}` }).waitFor();
  assert.ok(await page.locator("#set-delete").isDisabled(), "a case keeps one vessel");
  await page.locator("#set-none").click();
  await page.locator("#set-choose").selectOption("below");
  await type(page, "40 %");
  await page.locator(".toast", { hasText: `0 of ${all} vessels are below 40 %` }).waitFor(); // none has a confidence
}

story(
  "among many vessels names can be read, a search takes one key, and the chosen one stands out",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t);
    writeFileSync(file("tree.swc"), staircase());
    lumen("convert", file("tree.swc"), file("tree.lumen"));
    const server = await view(t, file("tree.lumen")),
      page = await openPage(t, browser, server.address, {
        prepare: context => context.addInitScript(noteDrawings),
      });
    await settled(page);
    await page.locator("body[data-surface=closed]").waitFor();
    const rows = page.locator("#tree-list [role=treeitem]"),
      levels = await rows.evaluateAll(all => all.map(e => Number(e.getAttribute("aria-level"))));
    assert.ok(Math.max(...levels) > 6, `levels ${levels.join(" ")}`);
    await picture(page, "many-list");
    const cut = await page
      .locator("#tree-list .name")
      .evaluateAll(all => all.filter(e => e.scrollWidth > e.clientWidth).map(e => e.textContent));
    assert.deepEqual(cut, [], "names that are cut off");

    const width = () => page.locator(".panel.left").evaluate(e => e.clientWidth),
      narrow = await width();
    await page.locator("#panel-edge").focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    assert.equal(await width(), narrow + 40);
    await page.reload();
    await page.locator("body[data-surface=closed]").waitFor();
    await settled(page);
    assert.equal(await width(), narrow + 40, "the width is kept");

    await page.keyboard.press("3");
    await page.keyboard.press("b"); // without the strip the view keeps its size
    await settled(page);
    const plain = await pixels(page, "#view-scene"),
      full = (await drawn(page)).largest;
    const wanted = (await rows.locator(".name").allTextContents()).at(-2);
    await page.keyboard.press("/");
    await page.keyboard.type(wanted);
    await page.keyboard.press("Enter");
    await page.locator("#branch-name", { hasText: wanted }).waitFor();
    assert.equal(await page.locator("#tree-list:focus").count(), 1, "the list has the keys");
    const chosen = await pixels(page, "#view-scene");
    await picture(page, "many-chosen");
    const share = keptShare(plain, chosen);
    assert.ok(Math.abs(share - kRest) < 0.04, `the others keep ${share.toFixed(2)}`);

    await page.locator("#tree-search").fill("");
    await frames(page, 5);
    const before = (await drawn(page)).triangles,
      behind = (await rows.evaluateAll(all => all.map(e => e.title))).findIndex(title =>
        title.includes(", 30.0 mm"),
      );
    assert.ok(behind >= 0, "the thin vessel");
    await rows.nth(behind).locator(".name").click();
    await settled(page);
    const triangles = (await drawn(page)).triangles - before;
    assert.ok(triangles < full / 2, `${triangles} triangles for a choice, ${full} for all`);
    const through = await pixels(page, "#view-scene");
    await picture(page, "many-through");
    let seen = 0;
    for (let i = 0; i < plain.data.length; i += 4)
      if (sum(plain, i) > 150 && sum(through, i) > (kRest + 0.15) * sum(plain, i)) ++seen;
    assert.ok(seen > 100, `${seen} pixels of it are seen through the trunk`);
    await chooseSets(page, rows);
  },
);
