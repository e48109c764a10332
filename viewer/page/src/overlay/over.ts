// SPDX-License-Identifier: Apache-2.0
/** Letters, measured lines and the scale bar over any view, on its 2D canvas. */
import type { Vec3 } from "../base/types";
import type { View } from "../model/model";
import type { Pixel } from "../model/slice_frame";

type Context = CanvasRenderingContext2D;

/** The canvas, as large as its view and cleared, to be drawn on in CSS pixels. */
export function clearedContext(
  canvas: HTMLCanvasElement,
  width: number,
  height: number,
): CanvasRenderingContext2D {
  const ratio = window.devicePixelRatio;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const c = canvas.getContext("2d")!;
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, width, height);
  return c;
}

export function label(
  c: Context,
  text: string,
  x: number,
  y: number,
  colour: string,
  align: CanvasTextAlign = "left",
): void {
  c.font = "500 11px system-ui, sans-serif";
  c.textAlign = align;
  c.textBaseline = "middle";
  c.lineWidth = 3;
  c.strokeStyle = "rgb(0 0 0 / 0.7)";
  c.strokeText(text, x, y);
  c.fillStyle = colour;
  c.fillText(text, x, y);
}

/** The longest length of 1, 2 or 5 times a power of ten with at most `most` pixels. */
export function niceLength(mmPerPixel: number, most: number): number {
  const longest = most * mmPerPixel,
    power = 10 ** Math.floor(Math.log10(longest)),
    share = longest / power;
  return power * (share >= 5 ? 5 : share >= 2 ? 2 : 1);
}

export function drawScaleBar(c: Context, mmPerPixel: number, width: number, height: number): void {
  const mm = niceLength(mmPerPixel, Math.min(140, width / 3)),
    pixels = mm / mmPerPixel,
    x = width - 14,
    y = height - 12;
  c.strokeStyle = "#e8edf4";
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(x - pixels, y - 4);
  c.lineTo(x - pixels, y);
  c.lineTo(x, y);
  c.lineTo(x, y - 4);
  c.stroke();
  label(c, mm >= 10 ? `${mm / 10} cm` : `${mm} mm`, x - pixels / 2, y - 9, "#e8edf4", "center");
}

/** Measured points and the lines between them, in a slice or a projection. */
export function drawMeasurements(
  c: Context,
  view: Pick<View, "tools">,
  project: (p: Vec3) => Pixel | null,
  reach: number,
): void {
  const groups = [
    ...view.tools.measurements.map(m => ({ points: m.points, text: m.text, kind: m.kind as string })),
    ...(view.tools.pending.length > 0 ? [{ points: view.tools.pending, text: "", kind: "pending" }] : []),
    ...(view.tools.clicks.length > 0
      ? [{ points: view.tools.clicks.map(click => click.position), text: "", kind: "pending" }]
      : []),
  ];
  for (const { points, text, kind } of groups) {
    const pixels = points.map(project);
    if (pixels.every(p => p === null || Math.abs(p.depth) > reach)) continue;
    const shown = pixels.filter(p => p !== null);
    c.strokeStyle = c.fillStyle = kind === "pending" ? "#ffd166" : "#ffe08a";
    c.lineWidth = 1.5;
    c.setLineDash(pixels.some(p => p !== null && Math.abs(p.depth) > reach / 4) ? [4, 3] : []);
    c.beginPath();
    shown.forEach((p, i) => {
      if (i === 0) c.moveTo(p.x, p.y);
      else c.lineTo(p.x, p.y);
    });
    if (kind === "section" && shown.length > 2) c.closePath();
    c.stroke();
    c.setLineDash([]);
    if (kind !== "section")
      for (const p of shown) {
        c.beginPath();
        c.arc(p.x, p.y, 3, 0, 2 * Math.PI);
        c.fill();
      }
    const last = shown.at(-1);
    if (last !== undefined && text !== "") label(c, text, last.x + 8, last.y - 8, "#ffe08a");
  }
}
