// SPDX-License-Identifier: Apache-2.0
// Pages that are shipped: a case as one file, opened from disk without a network, answers what libblob answers, plays its motion
// and keeps hostile names text; so do the pages of a library.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { frames, openPage, picture, pixels, settled, startBrowser, story } from "./browser.mjs";
import { phantom, vessel, vessels } from "./hand.mjs";
import { lumen, makeFolder } from "./lumen.mjs";
import { hostileCases, intruders, kTexts } from "./hostile.mjs";
import { writeLibrary } from "./make_library.mjs";
import { linksResolve, openSite, pagesOf } from "./site.mjs";

const kMarkup = "<img src=x onerror=document.title='taken'>",
  kPhases = 3,
  kPeriod = 0.8; // s

/** The native library's distance and node at a position. */
function blobSays(model, position) {
  const { status, stdout, stderr } = spawnSync(process.env.LUMEN_ASK_BLOB, [model, ...position], {
    encoding: "utf8",
  });
  assert.equal(status, 0, stderr);
  const [distance, node] = stdout.trim().split(" ").map(Number);
  return { distance, node };
}

/** A page from disk with the network off; every request that would leave it is in `asked`. */
async function openAlone(t, browser, path, asked) {
  const page = await openPage(t, browser, pathToFileURL(path).href, { offline: true });
  page.on("request", request => {
    if (!/^(file|data|blob):/.test(request.url())) asked.push(request.url());
  });
  await settled(page);
  return page;
}

/** The probe shows what libblob answers, in slices and on the wall in 3D. */
async function probe(page, model) {
  await page.locator("#probe-distance[data-mm]").waitFor({ state: "attached" });
  let inside = 0,
    outside = 0;
  for (const name of ["axial", "coronal", "sagittal"]) {
    const box = await page.locator(`#view-${name}`).boundingBox();
    for (const [u, v] of [
      [0.5, 0.5],
      [0.52, 0.47],
      [0.71, 0.44],
    ]) {
      await page.mouse.move(box.x + u * box.width, box.y + v * box.height);
      await frames(page, 3);
      const position = (await page.locator("#probe-position").getAttribute("data-mm")).split(" "),
        answer = blobSays(model, position);
      const shown = Number(await page.locator("#probe-distance").getAttribute("data-mm"));
      assert.ok(
        Math.abs(shown - answer.distance) <= 1e-6,
        `${shown} mm at ${position} where libblob says ${answer.distance}`,
      );
      assert.equal(Number(await page.locator("#probe-node").getAttribute("data-node")), answer.node);
      if (shown < 0) ++inside;
      else ++outside;
    }
  }
  assert.ok(inside > 0 && outside > 0, `${inside} points in the lumen, ${outside} outside of it`);

  await vessel(page, "root2").locator(".name").click();
  await page.keyboard.press("o");
  const scene = await page.locator("#view-scene").boundingBox();
  for (let v = 0.2; v < 0.8 && (await page.locator("#view-scene.over-vessel").count()) === 0; v += 0.02) {
    await page.mouse.move(scene.x + scene.width / 2, scene.y + v * scene.height);
    await frames(page, 3);
  }
  assert.equal(await page.locator("#probe-branch").textContent(), "root2");
  const toWall = Number(await page.locator("#probe-distance").getAttribute("data-mm"));
  assert.ok(Math.abs(toWall) < 0.05, `a point of the surface is ${toWall} mm from the wall`);
  await picture(page, "disk-probe-on-wall");
  await page.locator("#section-gaps summary").click();
  await page.locator("#gap-find").click();
  assert.match(await page.locator("#gap-list .item").first().textContent(), /root2/);
}

story(
  "a case as one file answers what libblob answers, without a network, and a name that is markup stays text",
  async t => {
    const file = makeFolder(),
      browser = await startBrowser(t),
      asked = [];
    phantom(file, "kissing", {});
    const seeds = JSON.parse(readFileSync(file("seeds.json"), "utf8"));
    seeds.branches[0].label = kMarkup;
    writeFileSync(file("seeds.json"), JSON.stringify(seeds));
    lumen(
      "convert",
      file("volume.nrrd"),
      file("vessels.lumen"),
      "--seeds",
      file("seeds.json"),
      "--seeds-only",
    );
    lumen("view", file("volume.nrrd"), file("vessels.lumen"), "--html", file("page.html"), "--html-volume");
    const page = await openAlone(t, browser, file("page.html"), asked);
    await probe(page, file("vessels.lumen"));
    await page.locator("#tree-list [role=treeitem]").first().click();
    assert.equal((await vessels(page))[0], kMarkup);
    assert.equal(await page.locator("#branch-name").textContent(), kMarkup);
    assert.equal(await page.locator("img").count(), 0);
    assert.doesNotMatch(await page.title(), /^taken/);
    assert.deepEqual(asked, [], "no request left the page");
  },
);

const time = async page => Number(await page.locator("#motion-time").inputValue());

/** Pixels of two pictures of one size that differ clearly. */
function different(a, b) {
  let count = 0;
  for (let i = 0; i < a.data.length; i += 4)
    if ([0, 1, 2].some(c => Math.abs(a.data[i + c] - b.data[i + c]) > 40)) ++count;
  return count;
}

story("a heart as one file beats, rests and shows a chosen time", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    phases = Array.from({ length: kPhases }, (_, i) => file(`beat-0${i}.nrrd`));
  lumen(
    "phantom",
    "coronary",
    file("beat.nrrd"),
    "--voxel",
    "1",
    "--motion",
    "heart",
    "--phases",
    `${kPhases}`,
  );
  lumen("convert", phases[0], file("rest.lumen"));
  lumen("motion", file("rest.lumen"), ...phases, "--out", file("beating.lumen"), "--period", `${kPeriod}`);
  lumen("view", file("beating.lumen"), "--time", "0.3", "--html", file("beating.html"));
  const asked = [],
    page = await openAlone(t, browser, file("beating.html"), asked);
  await page.keyboard.press("3"); // 3D alone
  assert.equal(await time(page), 0.3, "the page begins at the time of --time");
  await settled(page);
  const systole = await pixels(page, "#view-scene");
  await picture(page, "disk-heart");
  await page.locator("#motion-rest").click();
  await page.locator("#motion-rest[aria-pressed=true]").waitFor();
  let moved = 0;
  for (let k = 0; k < 50 && moved < 1000; ++k) moved = different(systole, await pixels(page, "#view-scene"));
  assert.ok(moved >= 1000, `${moved} pixels differ at rest`);

  await page.locator("#motion-slider").focus();
  await page.keyboard.press("End");
  assert.ok(Math.abs((await time(page)) - kPeriod) < 1e-9);
  await page.keyboard.press("Home");
  assert.equal(await time(page), 0);
  await page.locator("#view-scene").focus();
  await page.keyboard.press("Space");
  const seen = new Set();
  for (let k = 0; k < 200 && seen.size < 3; ++k) {
    seen.add(await time(page));
    await frames(page, 2);
  }
  assert.ok(
    seen.size >= 3 && [...seen].every(s => s >= 0 && s <= kPeriod),
    `the time stands at ${[...seen]}`,
  );
  await page.getByRole("button", { name: "Stop the motion" }).click();
  await page.getByRole("button", { name: "Play the motion" }).waitFor();
  assert.deepEqual(asked, []);
});

story(
  "texts of a library's hostile cases stay text, in pages, attributes, scripts and addresses",
  async t => {
    const file = makeFolder(),
      folder = file("library"),
      browser = await startBrowser(t),
      cases = hostileCases();
    mkdirSync(folder);
    writeLibrary(folder, cases, {
      title: kTexts[1],
      description: kTexts[0],
      publisher: kTexts[4],
      licence: kTexts[2],
    });
    lumen("library", "index", folder);
    linksResolve(folder, pagesOf(folder));
    const home = pathToFileURL(folder).href,
      page = await openSite(t, browser, `${home}/index.html`, { within: home });
    assert.equal(await page.locator("#count").textContent(), `${kTexts.length} cases`);
    const titles = await page.locator("#cards h2").allTextContents();
    for (const text of kTexts.filter(text => !/[\u2028-\u202E]/.test(text)))
      assert.ok(titles.includes(text), text);
    assert.deepEqual(await intruders(page), []);
    await page.locator("#words").fill(kTexts[0]);
    assert.equal(await page.locator("#count").textContent(), `1 of ${kTexts.length} cases`);
    await page.locator("[data-facet=anatomy] input").first().check();
    while ((await page.locator(".more").count()) > 0) await page.locator(".more").first().click();
    assert.deepEqual(await intruders(page), []);
    assert.doesNotMatch(readFileSync(`${folder}/site/cases.js`, "utf8"), /<|>|[\u2028\u2029\u202E]/);

    for (const [i, { id }] of cases.entries()) {
      await page.goto(`${home}/site/case/${id}.html`);
      await page.locator("body[data-ready]").waitFor();
      assert.deepEqual(await intruders(page), [], id);
      if (!/[\u2028-\u202E]/.test(kTexts[i])) assert.equal(await page.locator("h1").textContent(), kTexts[i]);
      assert.equal(await page.locator("img").count(), 1, id);
      assert.match(
        await page.locator("#files pre").textContent(),
        /^cat > [a-z0-9-]+\.sha256 <<'END'\n([0-9a-f]{64} {2}data\/[A-Za-z0-9._+/-]+\n)+END\nLIBRARY='[^']*'\n/,
      );
      const bibtex = await page.getByText("@misc{").textContent();
      let depth = 0;
      for (const c of bibtex.trim().slice(0, -1)) {
        depth += c === "{" ? 1 : c === "}" ? -1 : 0;
        assert.ok(depth >= 0);
      }
      assert.equal(depth, 1, bibtex);
    }
    await page.goto(
      `${home}/index.html#q=${encodeURIComponent(kTexts[0])}&anatomy=${encodeURIComponent(kTexts[1])}&length=a..b&sort=__proto__&page=-1`,
    );
    await page.reload();
    await page.locator("body[data-ready]").waitFor();
    assert.deepEqual(await intruders(page), []);
  },
);
