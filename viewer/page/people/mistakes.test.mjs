// SPDX-License-Identifier: Apache-2.0
// Mistakes: broken files, hostile names, cancelled work, files and documents that others change.
import assert from "node:assert/strict";
import { copyFileSync, readFileSync, utimesSync, writeFileSync } from "node:fs";
import { openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { document, drop, phantom, reported, vessel, vessels } from "./hand.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";

story("a broken file that is dropped is named with its fault, and changes nothing", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  phantom(file, "kissing", { "vessels.lumen": 2 });
  const server = await view(t, file("vessels.lumen")),
    page = await openPage(t, browser, server.address);
  await vessel(page, "root").waitFor();
  await settled(page);
  const before = await document(page),
    cut = before.subarray(0, before.length >> 1);
  const broken = [
    ["half.lumen", cut, /half\.lumen/],
    [
      "noise.nrrd",
      "NRRD0004\ntype: float\ndimension: 3\nsizes: 99999 99999 99999\nencoding: raw\n\n",
      /noise\.nrrd/,
    ],
    ["what.xyz", "hello", /what\.xyz/],
    ["empty.stl", "", /empty\.stl/],
  ];
  for (const [name, bytes, pattern] of broken) {
    await drop(page, name, bytes);
    const text = await reported(page, pattern, "error");
    assert.ok(
      text.length > name.length + 10 && !text.includes(file("").slice(0, 5)),
      `it says what is wrong, without a path: ${text}`,
    );
    await settled(page);
  }
  await picture(page, "4-broken-files");
  assert.ok(await page.locator("#undo").isDisabled(), "there is nothing to undo");
  assert.ok(await page.locator("#unsaved").isHidden());
  assert.deepEqual(await document(page), before);

  // a good one is still taken, by the dialog for files too, and can be undone
  for (const by of ["drop", "dialog"]) {
    if (by === "drop") await drop(page, "seeds.json", readFileSync(file("seeds.json")));
    else {
      const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.locator("#open").click()]);
      await chooser.setFiles(file("seeds.json"));
    }
    await page.locator("#undo:enabled").waitFor();
    await settled(page);
    await page.locator("#view-axial").focus();
    await page.keyboard.press("Control+z");
    await page.locator("#undo:disabled").waitFor({ state: "attached" });
    await settled(page);
  }
  assert.deepEqual(await document(page), before);
});

story("a vessel whose name is markup has that name, and nothing else happens", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    name = "<img src=x onerror=document.title='taken'>";
  lumen("phantom", "kissing", file("volume.nrrd"), "--seeds", file("seeds.json"));
  const seeds = JSON.parse(readFileSync(file("seeds.json"), "utf8"));
  seeds.branches[0].label = name;
  writeFileSync(file("seeds.json"), JSON.stringify(seeds));
  lumen("convert", file("volume.nrrd"), file("vessels.lumen"), "--seeds", file("seeds.json"), "--seeds-only");
  const server = await view(t, file("volume.nrrd"), file("vessels.lumen"), file("seeds.json"));
  lumen("view", file("vessels.lumen"), "--html", file("page.html"));
  for (const [i, address] of [server.address, `file://${file("page.html")}`].entries()) {
    const page = await openPage(t, browser, address);
    await page.locator("#tree-list [role=treeitem]").first().click();
    await page.keyboard.press("q");
    await settled(page);
    assert.equal((await vessels(page))[0], name);
    assert.equal(await page.locator("#branch-name").textContent(), name);
    assert.equal(await page.locator("img").count(), 0);
    assert.doesNotMatch(await page.title(), /^taken/);
    await picture(page, i === 0 ? "7-markup-as-name" : "7-markup-as-name-from-disk");
    await page.close();
  }
});

story("long work that is cancelled has changed nothing", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  lumen("phantom", "patient", file("volume.nrrd"), "--seeds", file("seeds.json"));
  const server = await view(t, file("volume.nrrd"), file("seeds.json")),
    page = await openPage(t, browser, server.address);
  await settled(page);
  await page.locator("#seed-list .item").nth(39).waitFor({ state: "attached" }); // forty seeds take a while
  const seeds = await page.locator("#seed-list .item").allTextContents();
  for (const by of ["button", "key"]) {
    await page.locator("#track-all:enabled").click();
    await page.locator("#progress").waitFor();
    // at once: a picture would take as long as the work
    if (by === "button") await page.locator("#cancel").click();
    else await page.keyboard.press("Escape");
    await page.locator("#progress").waitFor({ state: "hidden" });
    await page.locator("#track-all:enabled").waitFor();
    await settled(page);
    assert.deepEqual(await vessels(page), []);
    assert.deepEqual(await page.locator("#seed-list .item").allTextContents(), seeds);
    assert.ok(await page.locator("#undo").isDisabled(), "there is nothing to undo");
    assert.ok(await page.locator("#redo").isDisabled());
    assert.ok(await page.locator("#unsaved").isHidden());
    assert.ok(await page.locator("#save").isDisabled(), "there is still no case");
  }
  await picture(page, "5-cancelled");
});

story("two pages on one document see each other's changes", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  phantom(file, "kissing", { "vessels.lumen": 2 });
  const server = await view(t, file("volume.nrrd"), file("vessels.lumen")),
    one = await openPage(t, browser, server.address),
    other = await openPage(t, browser, server.address);
  await settled(one);
  await settled(other);
  await vessel(one, "root2").locator(".name").click();
  await one.keyboard.press("F2");
  await one.locator("#ask-text").fill("left");
  await one.keyboard.press("Enter");
  await vessel(other, "left").waitFor();
  await vessel(other, "left").locator(".name").click();
  await other.keyboard.press("Delete");
  await vessel(one, "left").waitFor({ state: "detached" });
  await one.locator("#branch-name").waitFor({ state: "detached" }); // what was selected there is gone
  await one.locator("#view-axial").focus();
  await one.keyboard.press("Control+z");
  await vessel(other, "left").waitFor();
  await picture(other, "8-other-page");
  await settled(one);
  assert.deepEqual(await vessels(one), await vessels(other));
  await one.close();
  await vessel(other, "root").locator(".name").click(); // and the one that is left goes on
  await other.keyboard.press("Control+z");
  await vessel(other, "root2").waitFor();
});

story("a change of the file by another program is reported, and not overwritten unasked", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  phantom(file, "kissing", { "vessels.lumen": 2 });
  copyFileSync(file("vessels.lumen"), file("copy.lumen"));
  const server = await view(t, file("vessels.lumen")),
    page = await openPage(t, browser, server.address);
  await vessel(page, "root").waitFor();
  await settled(page);
  lumen("fit", file("copy.lumen"), file("vessels.lumen"), "--accuracy", "0.5");
  utimesSync(file("vessels.lumen"), new Date(), new Date(Date.now() + 5000));
  await reported(page, /vessels\.lumen/, "warning");
  await page.locator("#file-list .changed").waitFor(); // the section opens by itself
  await picture(page, "9-changed-on-disk");
  const theirs = readFileSync(file("vessels.lumen"));
  await vessel(page, "root").locator(".name").click();
  await page.keyboard.press("F2");
  await page.locator("#ask-text").fill("mine");
  await page.keyboard.press("Enter");
  await vessel(page, "mine").waitFor();
  await page.keyboard.press("Control+s");
  await page.locator("dialog").waitFor();
  await picture(page, "9-overwrite");
  await page.keyboard.press("Escape");
  assert.deepEqual(readFileSync(file("vessels.lumen")), theirs);
  await page.keyboard.press("Control+s");
  await page.locator("dialog button", { hasText: "Overwrite" }).click();
  await page.locator("#unsaved").waitFor({ state: "hidden" });
  assert.notDeepEqual(readFileSync(file("vessels.lumen")), theirs);
});
