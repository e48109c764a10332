// SPDX-License-Identifier: Apache-2.0
// The page as one file, opened from disk without a network: what it answers is what libblob answers.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { pathToFileURL } from "node:url";
import { frames, openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { kissing, vessel } from "./hand.mjs";
import { lumen, makeFolder } from "./lumen.mjs";

/** The native library's distance and node at a position. */
function blobSays(model, position) {
  const { status, stdout, stderr } = spawnSync(process.env.LUMEN_ASK_BLOB, [model, ...position], {
    encoding: "utf8",
  });
  assert.equal(status, 0, stderr);
  const [distance, node] = stdout.trim().split(" ").map(Number);
  return { distance, node };
}

story("the page from disk, with the network off, probes what libblob answers", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t),
    asked = [];
  kissing(file);
  lumen("view", file("volume.nrrd"), file("vessels.lumen"), "--html", file("page.html"), "--html-volume");
  const address = pathToFileURL(file("page.html")).href;
  const page = await openPage(t, browser, address, {
    offline: true,
    prepare: context =>
      context.route("**", route => {
        if (route.request().url() !== address && !route.request().url().startsWith("data:"))
          asked.push(route.request().url());
        return route.continue();
      }),
  });
  page.on("request", request => {
    if (!/^(file|data|blob):/.test(request.url())) asked.push(request.url());
  });
  await vessel(page, "root").waitFor();
  await page.locator("#probe-distance[data-mm]").waitFor({ state: "attached" });
  await settled(page);
  await picture(page, "3-from-disk");

  let inside = 0,
    outside = 0;
  for (const name of ["axial", "coronal", "sagittal"]) {
    const box = await page.locator(`#view-${name}`).boundingBox();
    for (const [u, v] of [
      [0.5, 0.5],
      [0.52, 0.47],
      [0.3, 0.6],
      [0.71, 0.44],
    ]) {
      await page.mouse.move(box.x + u * box.width, box.y + v * box.height);
      await frames(page, 3);
      const position = (await page.locator("#probe-position").getAttribute("data-mm")).split(" "),
        answer = blobSays(file("vessels.lumen"), position);
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

  // on the wall, in the 3D view: the vessel is where its picture is
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
  await picture(page, "3-probe-on-wall");
  assert.deepEqual(asked, [], "no request left the page");
});
