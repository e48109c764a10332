// SPDX-License-Identifier: Apache-2.0
// A report opened from disk: nothing is fetched, nothing runs, texts stay texts, and it fits on paper.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { kPatience, picture, startBrowser, story } from "../../viewer/page/people/browser.mjs";
import { lumen, makeFolder } from "../../viewer/page/people/lumen.mjs";

const kPaper = Math.round((182 / 25.4) * 96); // CSS pixels: A4 without the margins
const kPictures = process.env.LUMEN_PICTURES ?? "people-pictures";

/** The report as a page whose mistakes and requests are kept. */
async function open(t, file, name) {
  const browser = await startBrowser(t), context = await browser.newContext({ viewport: { width: kPaper, height: 1000 }, offline: true });
  const page = await context.newPage(), address = pathToFileURL(file(name)).href;
  const seen = { mistakes: [], requests: [] };
  t.pages.push(page);
  page.setDefaultTimeout(kPatience);
  page.on("pageerror", error => seen.mistakes.push(String(error)));
  page.on("console", message => seen.mistakes.push(message.text()));
  page.on("dialog", dialog => { seen.mistakes.push(dialog.message()); return dialog.dismiss(); });
  page.on("request", request => { if (request.url() !== address && !request.url().startsWith("data:")) seen.requests.push(request.url()); });
  await page.goto(address, { timeout: kPatience });
  await page.emulateMedia({ media: "print" });
  return { page, seen };
}

/** Elements that reach beyond the paper, or whose text does. */
const tooWide = page => page.evaluate(() => [...document.querySelectorAll("body *")].filter(element => {
  const box = element.getBoundingClientRect();
  return box.right > innerWidth + 1 || box.left < -1;
}).map(element => `${element.tagName} ${element.textContent.slice(0, 40)}`));

/** How many colours each picture has once it is decoded. */
const coloursOfPictures = page => page.evaluate(() => Promise.all([...document.images].map(async image => {
  await image.decode();
  const canvas = Object.assign(document.createElement("canvas"), { width: image.naturalWidth, height: image.naturalHeight });
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  return new Set(new Uint32Array(context.getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size;
})));

/** Prints to A4 and gives the number of sheets. */
async function print(page, name) {
  const pdf = await page.pdf({ preferCSSPageSize: true, printBackground: true, timeout: kPatience });
  mkdirSync(kPictures, { recursive: true });
  writeFileSync(join(kPictures, `${name}.pdf`), pdf);
  assert.equal(pdf.subarray(0, 5).toString(), "%PDF-");
  const text = pdf.toString("latin1"), sheets = text.match(/\/Type\s*\/Page\b(?!s)/g)?.length ?? 0;
  assert.match(text, /\/MediaBox\s*\[0 0 59[45][.\d]* 84[12][.\d]*\]/, "A4");
  return sheets;
}

function fork(file) {
  lumen("phantom", "bifurcation", file("fork.nrrd"), "--size", "64", "--seeds", file("fork.json"));
  lumen("convert", file("fork.nrrd"), file("fork.lumen"), "--seeds", file("fork.json"), "--seeds-only");
}

story("a report opens from disk without a network, and all its pictures show something", async t => {
  const file = makeFolder();
  fork(file);
  const answer = lumen("report", file("fork.lumen"), file("fork.html"), "--volume", file("fork.nrrd"));
  const { page, seen } = await open(t, file, "fork.html");
  const colours = await coloursOfPictures(page);
  assert.equal(colours.length, answer.pictures);
  for (const [i, count] of colours.entries()) assert.ok(count > 20, `picture ${i} has ${count} colours`);
  assert.equal(await page.locator("#branch-table tbody tr").count(), answer.branches);
  assert.equal(await page.locator("#wall-table tbody tr").count(), answer.branches + 1, "each vessel, and all");
  assert.equal(await page.locator("figure.profile svg path.radius").count(), answer.branches);
  assert.equal(await page.locator("script, iframe, object, embed, link, form, base").count(), 0);
  assert.deepEqual(await tooWide(page), []);
  assert.ok((await print(page, "report-fork")) >= 3);
  await picture(page, "report-fork");
  assert.deepEqual(seen, { mistakes: [], requests: [] });
});

story("texts of a hostile case stay texts, and break nothing", async t => {
  const file = makeFolder();
  fork(file);
  lumen("convert", file("fork.lumen"), file("fork.lumen.json"));
  const value = JSON.parse(readFileSync(file("fork.lumen.json"), "utf8"));
  const labels = ['<script>document.title = "ran"</script>', '"><img src=http://example.org/x onerror=alert(1)>', `${"W".repeat(250)}`,
    "</td></tr></table><h1>", "شريان < الدماغ", "'; alert(1) //", "&lt;b&gt;"];
  value.tree.branches.forEach((branch, i) => { branch.label = labels[i]; });
  const used = labels.slice(0, value.tree.branches.length);
  value.metadata.note = `</section><style>body { display: none }</style>${"M".repeat(10_000)}`;
  for (const label of labels) value.metadata.steps[0].parameters[label] = label.repeat(Math.floor(3000 / label.length));
  writeFileSync(file("hostile.lumen.json"), JSON.stringify(value));
  const title = "<title></title><script>alert(2)</script>";
  lumen("report", file("hostile.lumen.json"), file("hostile.html"), "--volume", file("fork.nrrd"), "--title", title);
  const { page, seen } = await open(t, file, "hostile.html");
  assert.equal(await page.title(), title);
  assert.equal(await page.locator("h1").count(), 1);
  assert.equal(await page.locator("h1").textContent(), title);
  assert.equal(await page.locator("style").count(), 1);
  assert.equal(await page.locator("script, iframe, object, embed, link, form, base").count(), 0);
  assert.deepEqual(await page.evaluate(() => [...document.querySelectorAll("*")].flatMap(e => e.getAttributeNames()).filter(n => n.startsWith("on"))), []);
  const shown = await page.locator("#branch-table tbody bdi").allTextContents();
  assert.deepEqual(shown.sort(), used.sort());
  const parameters = await page.locator("#parameters li > bdi").allTextContents();
  for (const label of labels) assert.ok(parameters.includes(label), label);
  assert.deepEqual(await tooWide(page), []);
  assert.ok((await print(page, "report-hostile")) >= 3);
  await picture(page, "report-hostile");
  assert.deepEqual(seen, { mistakes: [], requests: [] });
});

story("a hundred vessels and more have a row and a plot each, and no two plots overlap", async t => {
  const file = makeFolder(), vessels = 120, lines = [];
  // a helix that a vessel leaves outwards at every step
  const at = (i, reach) => [(20 + reach) * Math.cos(i / 5), (20 + reach) * Math.sin(i / 5), i].map(x => x.toFixed(3)).join(" ");
  for (let i = 0; i <= vessels; ++i) lines.push(`${i + 1} 3 ${at(i, 0)} 1 ${i === 0 ? -1 : i}`);
  for (let i = 1, next = vessels + 2; i < vessels; ++i)
    for (let k = 1; k <= 4; ++k, ++next) lines.push(`${next} 3 ${at(i, 2 * k)} ${(0.3 + 0.001 * i).toFixed(3)} ${k === 1 ? i + 1 : next - 1}`);
  writeFileSync(file("comb.swc"), `${lines.join("\n")}\n`);
  lumen("convert", file("comb.swc"), file("comb.lumen"));
  const answer = lumen("report", file("comb.lumen"), file("comb.html"));
  assert.ok(answer.branches >= vessels, `${answer.branches} branches`);
  const { page, seen } = await open(t, file, "comb.html");
  assert.equal(await page.locator("#branch-table tbody tr").count(), answer.branches);
  const boxes = await page.locator("figure.profile").evaluateAll(figures => figures.map(f => f.getBoundingClientRect().toJSON()));
  assert.equal(boxes.length, answer.branches);
  for (const [i, a] of boxes.entries())
    for (const b of boxes.slice(i + 1))
      assert.ok(a.right <= b.left + 0.5 || b.right <= a.left + 0.5 || a.bottom <= b.top + 0.5 || b.bottom <= a.top + 0.5, `plot ${i + 1} overlaps another`);
  assert.deepEqual(await tooWide(page), []);
  const sheets = await print(page, "report-comb");
  assert.ok(sheets >= 8 && sheets <= 20, `${sheets} sheets`);
  for (const id of ["agreement", "projection"]) assert.match(await page.locator(`#${id}`).textContent(), /o volume was given \(--volume\)/);
  assert.deepEqual(seen, { mistakes: [], requests: [] });
});
