// SPDX-License-Identifier: Apache-2.0
// The site of a library, as a visitor uses it: searched, filtered, sorted, linked, by keys, on a phone, in the dark, without a script.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { frames, picture, startBrowser, story } from "./browser.mjs";
import { lumen, makeFolder } from "./lumen.mjs";
import { manyCases, png, writeLibrary } from "./make_library.mjs";
import { faintTexts, foundIds, linksResolve, openSite, pagesOf, serve, shownIds } from "./site.mjs";

const kCases = 130; // three pages
const kAbout = {
  title: "Vessels of the tests",
  publisher: "Nobody",
  description: "Made up, to be looked at by tests.",
};
const cases = manyCases(kCases);
const idsOf = list => list.map(c => c.id).sort();
const within = folder => pathToFileURL(folder).href;

/** A library with pages, and the address of the first from disk. */
function library(t, given = cases, about = kAbout) {
  const file = makeFolder(),
    folder = file("site of cases");
  mkdirSync(folder);
  writeLibrary(folder, given, about);
  const answer = lumen("library", "index", folder);
  assert.equal(answer.cases, given.length);
  return { folder, address: pathToFileURL(`${folder}/index.html`).href, within: within(folder) };
}
const facet = (page, key, value) =>
  page.locator(`[data-facet=${key}] li`, { has: page.getByText(value, { exact: true }) });
const countOf = page => page.locator("#count").textContent();
/** The address once it has a part; it follows the search with a delay. */
const fragment = async (page, part) => {
  await page.waitForFunction(text => location.hash.includes(text), part);
  return page.evaluate(() => location.hash);
};

story(
  "search, facets and ranges find cases from disk by their records, and the address restores them",
  async t => {
    const { address, within: inside } = library(t),
      browser = await startBrowser(t),
      page = await openSite(t, browser, address, { within: inside });
    assert.equal(await countOf(page), "130 cases");
    assert.equal((await shownIds(page)).length, 48);
    await picture(page, "gallery");
    assert.deepEqual((await foundIds(page)).sort(), idsOf(cases));

    await page.locator("#words").fill("piece"); // without its accent
    assert.deepEqual((await foundIds(page)).sort(), idsOf(cases.filter((_, i) => i % 2 === 1)));
    await page.locator("#words").fill("branch77");
    assert.deepEqual(await shownIds(page), ["case-00077"]);
    await page.locator("#words").fill("siphon study");
    const both = cases.filter((c, i) => i % 3 === 0 && i % 2 === 0);
    assert.equal(await countOf(page), `${both.length} of 130 cases`);
    // of a facet, what each of its values would give
    assert.equal(
      await facet(page, "licence", "CC0-1.0").locator(".n").textContent(),
      String(both.filter(c => c.licence === "CC0-1.0").length),
    );
    await facet(page, "licence", "CC0-1.0").getByRole("checkbox").check();
    assert.equal(
      await facet(page, "licence", "CC-BY-4.0").locator(".n").textContent(),
      String(both.filter(c => c.licence !== "CC0-1.0").length),
    );
    assert.equal(await facet(page, "side", "right").locator(".n").textContent(), "0");
    assert.deepEqual((await foundIds(page)).sort(), idsOf(both.filter(c => c.licence === "CC0-1.0")));
    await page.locator("#words").fill("");
    await page.getByLabel("Length of all vessels: least").fill("150");
    await page.getByLabel("Length of all vessels: most").fill("170");
    await page.getByLabel("Greatest radius: most").fill("6");
    await page.locator("#order").selectOption("longest");
    const expected = cases
      .filter(
        c =>
          c.licence === "CC0-1.0" &&
          c.figures.length_mm >= 150 &&
          c.figures.length_mm <= 170 &&
          c.figures.radius_mm.max <= 6,
      )
      .map(c => c.id)
      .reverse();
    assert.ok(expected.length > 1);
    assert.deepEqual(await shownIds(page), expected);
    const hash = await fragment(page, "sort=longest");
    assert.deepEqual(
      [...new URLSearchParams(hash.slice(1))],
      [
        ["licence", "CC0-1.0"],
        ["length", "150..170"],
        ["widest-radius", "..6"],
        ["sort", "longest"],
      ],
    );

    await page.locator("#cards h2 a").first().click();
    await page.locator("body.one[data-ready]").waitFor();
    await page.getByRole("link", { name: `‹ ${kAbout.title}` }).click();
    await page.locator("body.gallery[data-ready]").waitFor();
    assert.deepEqual(await shownIds(page), expected, "the way back leads to the search");

    const again = await openSite(t, browser, address + hash, { within: inside });
    assert.deepEqual(await shownIds(again), expected);
    assert.ok(await facet(again, "licence", "CC0-1.0").getByRole("checkbox").isChecked());
    await again.getByRole("button", { name: "Clear all" }).click();
    assert.equal(await countOf(again), "130 cases");
  },
);

story("measures are ranges, and a case without the measure is in none of them", async t => {
  const { address, within: inside } = library(t),
    browser = await startBrowser(t),
    page = await openSite(t, browser, address, { within: inside });
  await picture(page, "gallery_measures");
  await page.getByLabel("Greatest stenosis (NASCET): least").fill("0");
  const has = cases.filter(c => typeof c.figures.geometry?.nascet_percent === "number");
  assert.ok(has.length > 20 && has.length < cases.length);
  assert.deepEqual((await foundIds(page)).sort(), idsOf(has));
  await page.getByLabel("Greatest stenosis (NASCET): least").fill("50");
  await page.getByLabel("Greatest stenosis (NASCET): most").fill("70");
  await page.locator("#order").selectOption("stenosed");
  const expected = has.filter(
    c => c.figures.geometry.nascet_percent >= 50 && c.figures.geometry.nascet_percent <= 70,
  );
  assert.deepEqual(await shownIds(page), expected.map(c => c.id).reverse());
  await fragment(page, "stenosis=50..70");
  assert.equal(await page.getByLabel("Greatest take-off angle: least").count(), 0, "no case has it");
  await page.locator("#cards h2 a").first().click();
  await page.locator("body.one[data-ready]").waitFor();
  await page.getByText("Greatest stenosis (NASCET)").waitFor();
  await picture(page, "case_measures");
});

story("all that the gallery does can be done by keys, and is named", async t => {
  const { address, within: inside } = library(t),
    browser = await startBrowser(t),
    page = await openSite(t, browser, address, { within: inside });
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Skip to the cases");
  await page.keyboard.press("Tab");
  await page.keyboard.type("study 31");
  await page.getByRole("checkbox", { name: /^carotid siphon/ }).focus();
  await page.keyboard.press("Space");
  assert.equal(await page.getByRole("status").textContent(), await countOf(page));
  assert.deepEqual(await shownIds(page), ["case-00030"]);
  await page.locator("#words").fill("nothing has these words");
  await page.getByText("No case has all of this").waitFor();
  await page.locator("#words").fill("");
  await page.getByRole("checkbox", { name: /^carotid siphon/ }).uncheck();
  await page.getByRole("link", { name: "Next" }).focus();
  await page.keyboard.press("Enter");
  assert.equal(await page.evaluate(() => document.activeElement.id), "cases");
  assert.equal(await page.locator("#pages [aria-current=page]").textContent(), "2");
  await page.goBack();
  await page.waitForFunction(() => document.querySelector("#pages [aria-current=page]")?.textContent === "1");
  const nameless = await page
    .locator("input, button, select, a")
    .evaluateAll(list =>
      list
        .filter(
          e =>
            e.checkVisibility() &&
            (e.labels?.length ?? 0) === 0 &&
            !e.ariaLabel &&
            e.textContent.trim() === "",
        )
        .map(e => e.outerHTML),
    );
  assert.deepEqual(nameless, []);
});

story(
  "without a script every case is listed, page by page, and every link of every page leads to a file",
  async t => {
    const { folder, address, within: inside } = library(t),
      browser = await startBrowser(t);
    const files = linksResolve(folder, pagesOf(folder));
    assert.ok(files > 10 * kCases, `${files} links`);
    const page = await openSite(t, browser, address, { within: inside, javaScriptEnabled: false });
    assert.equal(await page.locator("#find").isVisible(), false);
    assert.deepEqual((await foundIds(page)).sort(), idsOf(cases));
    await page.locator("#cards h2 a").first().click();
    await page.getByRole("heading", { level: 1 }).waitFor();
    assert.match(await page.locator("#files").textContent(), /sha256sum -c case-\d+\.sha256/);
  },
);

story(
  "from a plain web server, in a folder below its root, the commands of a page fetch and check the case",
  async t => {
    const { folder } = library(t),
      browser = await startBrowser(t),
      server = await serve(t, `${folder}/..`),
      base = `${server}/site%20of%20cases`;
    const page = await openSite(t, browser, `${base}/site/page/2.html`, { within: `${base}/` });
    assert.equal(await page.locator("#pages [aria-current=page]").textContent(), "2");
    await page.locator("#cards h2 a").first().click();
    await page.locator("body.one[data-ready]").waitFor();
    await picture(page, "gallery-case");
    const commands = await page.locator("#files pre").textContent(),
      id = /site\/case\/(.*)\.html/.exec(page.url())[1],
      file = makeFolder();
    mkdirSync(file("fetched"));
    const { status, stdout, stderr } = spawnSync("bash", ["-e"], {
      input: commands,
      cwd: file("fetched"),
      encoding: "utf8",
    });
    assert.equal(status, 0, stderr);
    assert.equal(stdout, `data/${id}/case.lumen: OK\ndata/${id}/picture.png: OK\n`);
    assert.deepEqual(
      readFileSync(file(`fetched/data/${id}/case.lumen`)),
      readFileSync(`${folder}/data/${id}/case.lumen`),
    );
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("link", { name: "Download the case" }).click(),
    ]);
    assert.equal(download.suggestedFilename(), "case.lumen");
  },
);

story("a phone scrolls in one direction, and in the dark and in the light all words stand out", async t => {
  const long = {
    ...cases[0],
    id: "long",
    title: "W".repeat(255),
    attribution: "x".repeat(1024),
    labels: Array.from({ length: 40 }, (_, i) => `vessel${i}${"y".repeat(200)}`),
  };
  const { address, within: inside, folder } = library(t, [long, ...cases.slice(0, 9)]),
    browser = await startBrowser(t);
  const phone = { viewport: { width: 360, height: 740 }, isMobile: true, hasTouch: true };
  for (const scheme of ["light", "dark"])
    for (const [size, options] of Object.entries({ phone, desk: {} }))
      for (const where of [
        address,
        `${within(folder)}/site/case/long.html`,
        `${within(folder)}/site/case/case-00000.html`,
      ]) {
        const page = await openSite(t, browser, where, { within: inside, colorScheme: scheme, ...options });
        await page.evaluate(() => {
          for (const details of document.querySelectorAll("details")) details.open = true;
        });
        const wide = await page.evaluate(
          () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
        );
        assert.equal(wide, 0, `${where} on a ${size} is ${wide} pixels too wide`);
        assert.deepEqual(await faintTexts(page), [], `${where}, ${scheme}, ${size}`);
        await picture(page, `gallery-${scheme}-${size}${where === address ? "" : "-case"}`);
      }
});

story("a turntable turns by dragging and by keys", async t => {
  const shades = [10, 80, 150, 220],
    files = Object.fromEntries(
      shades.map((shade, i) => [`turn-00${i}.png`, { role: "picture", bytes: png([shade, shade, shade]) }]),
    );
  const { folder, within: inside } = library(t, [{ ...cases[0], files }]),
    browser = await startBrowser(t);
  const page = await openSite(t, browser, `${within(folder)}/site/case/case-00000.html`, { within: inside }),
    shot = page.locator("#shot img");
  await page.getByLabel("Turn the vessels").focus();
  await page.keyboard.press("ArrowRight");
  assert.equal(await shot.getAttribute("data-frame"), "1");
  assert.match(await shot.getAttribute("src"), /turn-001\.png$/);
  const box = await shot.boundingBox();
  await page.mouse.move(box.x + 100, box.y + 100);
  await page.mouse.down();
  await page.mouse.move(box.x + 100 + 180 * 2, box.y + 100, { steps: 5 }); // half a turn on
  await page.mouse.up();
  await frames(page);
  assert.equal(await shot.getAttribute("data-frame"), "3");
});
