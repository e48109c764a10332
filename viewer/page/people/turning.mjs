// SPDX-License-Identifier: Apache-2.0
// Counts the pictures that the 3D view draws while a hand turns it.
import { readdirSync, readFileSync } from "node:fs";

/** To be run in a page before its own script: notes each drawing of triangles. */
export const noteDrawings = () => {
  const draw = WebGL2RenderingContext.prototype.drawElements;
  window.lumenDrawn = { triangles: 0, pictures: 0, last: 0, largest: 0 }; // the last two: triangles of one picture
  let before = 0;
  WebGL2RenderingContext.prototype.drawElements = function (mode, count, ...rest) {
    window.lumenDrawn.triangles += count / 3;
    return draw.call(this, mode, count, ...rest);
  };
  const look = () => {
    const { lumenDrawn } = window;
    if (lumenDrawn.triangles !== before) {
      ++lumenDrawn.pictures;
      lumenDrawn.last = lumenDrawn.triangles - before;
      lumenDrawn.largest = Math.max(lumenDrawn.largest, lumenDrawn.last);
    }
    before = lumenDrawn.triangles;
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
};

/** Seconds of processor that the processes of a browser below `root` have used, by the type of the process. */
export function processorTime(root, name = /chrom|firefox/) {
  const kTicks = 100; // a second, on Linux
  const stat = new Map();
  for (const pid of readdirSync("/proc").filter(name => /^\d+$/.test(name)))
    try {
      const fields = readFileSync(`/proc/${pid}/stat`, "latin1")
          .replace(/^.*\) /s, "")
          .split(" "),
        command = readFileSync(`/proc/${pid}/cmdline`, "latin1");
      stat.set(Number(pid), {
        parent: Number(fields[1]),
        ticks: Number(fields[11]) + Number(fields[12]),
        type: name.test(command) ? (/--type=([a-z-]+)/.exec(command)?.[1] ?? "browser") : null,
      });
    } catch {
      /* it has ended meanwhile */
    }
  const belongs = pid => pid === root || (stat.has(pid) && pid > 1 && belongs(stat.get(pid).parent));
  const used = { all: 0 };
  for (const [pid, { ticks, type }] of stat)
    if (type !== null && belongs(pid)) {
      used[type] = (used[type] ?? 0) + ticks / kTicks;
      used.all += ticks / kTicks;
    }
  return used;
}

/** The figures that `noteDrawings` has noted. */
export const drawn = page => page.evaluate(() => window.lumenDrawn);

const kBetween = 8; // ms between two movements of the pointer

/** Reads one pixel back, which waits until all that was asked for is drawn. */
const finish = page =>
  page.evaluate(() => {
    const gl = document.querySelector("canvas.stage").getContext("webgl2");
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return { at: performance.now(), ...window.lumenDrawn };
  });

/** Turns the 3D view, or moves the crosshair of a slice, to and fro by keys, picture after picture, each of which is waited
 * for: ms on the clock and of processor for a picture, and its triangles. That is what a machine can draw, without the
 * wait for a hand, whose events come late on a busy machine. `element`: selects the view. */
export async function drawMoving(page, pictures, root, element = "#view-scene") {
  const used = processorTime(root).all,
    before = await finish(page);
  await page.evaluate(
    async ([count, which]) => {
      const view = document.querySelector(which),
        gl = document.querySelector("canvas.stage").getContext("webgl2");
      for (let k = 0; k < count; ++k) {
        view.dispatchEvent(
          new window.KeyboardEvent("keydown", {
            key: k % 20 < 10 ? "ArrowLeft" : "ArrowRight",
            bubbles: true,
            cancelable: true,
          }),
        );
        await new Promise(resolve => requestAnimationFrame(resolve));
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
      }
    },
    [pictures, element],
  );
  const after = await finish(page);
  return {
    wall: (after.at - before.at) / pictures,
    processor: (1000 * (processorTime(root).all - used)) / pictures,
    triangles: (after.triangles - before.triangles) / pictures,
  };
}

/** Turns the 3D view with the pointer for N ms: pictures a second, triangles in a picture, and ms of processor for a
 * picture, of the processes below `root`. */
export async function turn(page, duration, root) {
  const box = await page.locator("#view-scene").boundingBox(),
    middle = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(...middle);
  await page.mouse.down();
  await page.mouse.move(middle[0] + 5, middle[1]);
  const before = await finish(page),
    used = processorTime(root),
    end = Date.now() + duration;
  for (let k = 0; Date.now() < end; ++k) {
    await page.mouse.move(middle[0] + 100 * Math.sin(k / 25), middle[1] + 20 * Math.sin(k / 40));
    await new Promise(resolve => setTimeout(resolve, kBetween));
  }
  const after = await finish(page),
    now = processorTime(root);
  await page.mouse.up();
  const pictures = after.pictures - before.pictures;
  return {
    pictures,
    perSecond: (1000 * pictures) / (after.at - before.at),
    processor: (1000 * (now.all - used.all)) / Math.max(pictures, 1),
    ofWhich: Object.fromEntries(
      Object.entries(now).map(([type, s]) => [
        type,
        Math.round((1000 * (s - (used[type] ?? 0))) / Math.max(pictures, 1)),
      ]),
    ),
    triangles: (after.triangles - before.triangles) / Math.max(pictures, 1),
  };
}
