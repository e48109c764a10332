// SPDX-License-Identifier: Apache-2.0
// Turning a large case without a graphics processor: coarse while it moves, in full when it rests. Figures are printed.
// LUMEN_SPEED_FILE: a case to turn instead of a phantom's.
import assert from "node:assert/strict";
import { loadavg } from "node:os";
import { frames, openPage, picture, settled, startBrowser, story } from "./browser.mjs";
import { lumen, makeFolder, view } from "./lumen.mjs";
import { drawMoving, drawn, noteDrawings, turn } from "./turning.mjs";

const kTurn = 4000, // ms of turning
  kTurns = 3,
  kPictures = 30;

story("a case is turned with fewer triangles and drawn in full when it rests", async t => {
  const file = makeFolder(),
    browser = await startBrowser(t);
  let path = process.env.LUMEN_SPEED_FILE;
  if (path === undefined) {
    path = file("vessels.lumen");
    lumen("phantom", "patient", file("volume.nrrd"), "--size", "128");
    lumen("convert", file("volume.nrrd"), path);
  }
  const { address } = await view(t, path),
    page = await openPage(t, browser, address, { prepare: context => context.addInitScript(noteDrawings) });
  await settled(page);
  await page.locator("body[data-surface=closed]").waitFor();
  await frames(page, 5);
  const full = (await drawn(page)).largest;
  for (let k = 0; k < kTurns; ++k) {
    const { pictures, perSecond, triangles, processor, ofWhich } = await turn(page, kTurn, process.pid);
    console.log(
      `${pictures} pictures, ${perSecond.toFixed(1)} a second, ${Math.round(triangles)} of ${full} triangles, ` +
        `${processor.toFixed(0)} ms of processor for each (${JSON.stringify(ofWhich)}); load ${loadavg()[0].toFixed(1)}`,
    );
    assert.ok(triangles < 0.5 * full, `${triangles} triangles of ${full} while it moves`);
  }
  for (let k = 0; k < kTurns; ++k) {
    const { wall, processor, triangles } = await drawMoving(page, kPictures, process.pid);
    console.log(
      `${wall.toFixed(0)} ms a picture as fast as it can (${(1000 / wall).toFixed(1)} a second), ${processor.toFixed(0)} ms of processor, ` +
        `${Math.round(triangles)} triangles; load ${loadavg()[0].toFixed(1)}`,
    );
  }
  const before = await drawn(page);
  await page.waitForFunction(
    ([most, since]) => window.lumenDrawn.last > 0.99 * most && window.lumenDrawn.pictures >= since,
    [full, before.pictures],
  );
  await picture(page, "speed-rests");
});
