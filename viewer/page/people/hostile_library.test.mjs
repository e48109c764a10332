// SPDX-License-Identifier: Apache-2.0
// Texts of a library's cases stay text, whatever somebody wrote.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { startBrowser, story } from "./browser.mjs";
import { lumen, makeFolder } from "./lumen.mjs";
import { png, writeLibrary } from "./make_library.mjs";
import { linksResolve, openSite, pagesOf } from "./site.mjs";

const kTexts = [
  "<img src=x onerror=alert(1)>",
  '"><script>alert(1)</script>',
  "'><svg onload=alert(1)>",
  "</script><script>alert(1)</script>",
  "]]></title></style><h1>x</h1>",
  "<!--",
  "${alert(1)}`",
  "javascript:alert(1)",
  "\u202Edesrever",
  "\u2028\u2029",
  "&lt;b&gt;&amp;",
  "__proto__",
  "constructor",
  "END\nrm -rf /".replace("\n", " "),
  "'; rm -rf / #",
  "\\end{document} {{{ % $",
  "é".repeat(120),
];

/** Every text of a case is the hostile one. */
const hostile = (text, i) => ({
  id: ["constructor", "index", "0", "a--"][i] ?? `case-${i}`,
  title: text,
  description: text,
  anatomy: { text, codes: [{ system: "FMA", code: "1", name: text }] },
  licence: text,
  attribution: text,
  origin: text,
  doi: `10.1234/${text.replaceAll(/\s/g, "_")}`,
  consent: text,
  deidentification: text,
  labels: [text],
  provenance: {
    case_sha256: "0".repeat(64),
    generator: `lumen ${text}`,
    source: null,
    steps: [{ name: text, tool: text, parameters: { [text]: text } }],
  },
  files: {
    "picture.png": { role: "picture", bytes: png([9, 9, 9]) },
    "+a+/_b-.html": { role: "other", bytes: Buffer.from("<script>alert(1)</script>") },
    "exports/mujoco/scene.xml": { role: "export", target: "mujoco", bytes: Buffer.from("<x/>") },
  },
});

/** Elements of a page that no text of a case may have made, and attributes that run code. */
const intruders = page =>
  page.evaluate(() =>
    [
      ...document.querySelectorAll(
        "svg, iframe, object, embed, style, script:not([src]), h1 ~ h1, body :not(html):is([onerror], [onload])",
      ),
    ]
      .map(e => e.outerHTML.slice(0, 80))
      .concat(
        [...document.querySelectorAll("a, img, script, link")]
          .map(e => e.getAttribute("href") ?? e.getAttribute("src"))
          .filter(
            address =>
              !/^(#|data:,|https:\/\/doi\.org\/|(\.\.\/)*[a-z][a-z0-9./%A-F+_-]*$|[a-z])/i.test(address) ||
              /^javascript:/i.test(address),
          ),
      ),
  );

story(
  "titles, labels and all other texts of hostile cases stay text, in pages, attributes, scripts and addresses",
  async t => {
    const file = makeFolder(),
      folder = file("library"),
      browser = await startBrowser(t),
      cases = kTexts.map(hostile);
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
    await page.locator("[data-facet=anatomy] input:checked, [data-facet=anatomy] input").first().check();
    while ((await page.locator(".more").count()) > 0) await page.locator(".more").first().click();
    assert.deepEqual(await intruders(page), []);
    const script = readFileSync(`${folder}/site/cases.js`, "utf8");
    assert.doesNotMatch(script, /<|>|[\u2028\u2029\u202E]/);

    for (const [i, { id }] of cases.entries()) {
      await page.goto(`${home}/site/case/${id}.html`);
      await page.locator("body[data-ready]").waitFor();
      assert.deepEqual(await intruders(page), [], id);
      if (!/[\u2028-\u202E]/.test(kTexts[i])) assert.equal(await page.locator("h1").textContent(), kTexts[i]);
      assert.equal(await page.locator("img").count(), 1, id);
      const commands = await page.locator("#files pre").textContent();
      assert.match(
        commands,
        /^cat > [a-z0-9-]+\.sha256 <<'END'\n([0-9a-f]{64} {2}data\/[A-Za-z0-9._+/-]+\n)+END\nLIBRARY='[^']*'\n/,
      );
      const bibtex = await page.getByText("@misc{").textContent();
      let depth = 0,
        least = 9;
      for (const c of bibtex.trim().slice(0, -1)) {
        depth += c === "{" ? 1 : c === "}" ? -1 : 0;
        if (depth > 0) least = Math.min(least, depth);
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
