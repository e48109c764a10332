// SPDX-License-Identifier: Apache-2.0
/** Lines and letters over a slice. */
import { toCss } from "./colour";
import { colourOf, isShown, shownTree, type View } from "./model";
import type { Pixel, SliceProjection } from "./slice_frame";
import { reachOf } from "./slab";
import { drawStroke } from "./stroke";
import type { Surface } from "./surface";
import type { MissingVessel, Vec3 } from "./types";
import { dot, orientation, scale } from "./vec";
import { missingPlaces } from "./work_items";

interface Cut {
  surface: Surface;
  key: string;
  parts: (number[] | null)[];
}
const cuts = new WeakMap<SliceProjection, Cut>();

/** The surface's outlines in the slice, kept until plane or surface change. Null for a part whose bounding-volume
 * hierarchy is not built yet: a picture does not wait for it. */
function outlines(slice: SliceProjection, surface: Surface): (number[] | null)[] {
  const { normal } = slice.frame,
    origin = slice.centre(),
    key = [surface.poses, ...[...normal, dot(normal, origin)].map(x => x.toFixed(5))].join();
  let cut = cuts.get(slice);
  if (cut?.surface !== surface || cut.key !== key) {
    cut = { surface, key, parts: surface.parts.map(() => null) };
    cuts.set(slice, cut);
  }
  const { parts } = cut;
  surface.parts.forEach((part, i) => {
    if (part.bvh !== null) parts[i] ??= surface.cut(part, normal, origin);
  });
  return parts;
}

type Context = CanvasRenderingContext2D;

function drawOutlines(c: Context, slice: SliceProjection, view: View): void {
  const { surface } = view;
  if (surface === null || !view.layers.contours) return;
  const parts = outlines(slice, surface),
    map = slice.toPixels(),
    x = map.x.by,
    y = map.y.by,
    o = { x: map.x.offset, y: map.y.offset };
  surface.parts.forEach((part, i) => {
    const points = parts[i];
    if (points === null || points.length === 0 || !isShown(view, part.branch)) return;
    c.beginPath();
    for (let k = 0; k < points.length; k += 6) {
      c.moveTo(
        o.x + points[k] * x[0] + points[k + 1] * x[1] + points[k + 2] * x[2],
        o.y + points[k] * y[0] + points[k + 1] * y[1] + points[k + 2] * y[2],
      );
      c.lineTo(
        o.x + points[k + 3] * x[0] + points[k + 4] * x[1] + points[k + 5] * x[2],
        o.y + points[k + 3] * y[0] + points[k + 4] * y[1] + points[k + 5] * y[2],
      );
    }
    c.strokeStyle = toCss(colourOf(view, part.branch), part.branch === view.selected ? 1 : 0.8);
    c.lineWidth = part.branch === view.selected ? 2 : 1.2;
    c.stroke();
  });
}

function drawLines(c: Context, slice: SliceProjection, view: View): void {
  const tree = shownTree(view);
  if (tree === null || !view.layers.lines) return;
  const near = reachOf(view, slice, 2 * slice.mmPerPixel + (tree.voxelSize || 0.5)),
    { x, y, depth } = slice.toPixels(),
    p = tree.centre;
  const on = (row: { by: Vec3; offset: number }, k: number): number =>
    p[k] * row.by[0] + p[k + 1] * row.by[1] + p[k + 2] * row.by[2] + row.offset;
  for (const branch of tree.branches) {
    if (!isShown(view, branch.index)) continue;
    c.fillStyle = toCss(colourOf(view, branch.index), 0.9);
    for (let k = 3 * branch.firstNode; k < 3 * (branch.firstNode + branch.nodeCount); k += 3)
      if (Math.abs(on(depth, k)) < near) c.fillRect(on(x, k) - 1, on(y, k) - 1, 2, 2);
  }
}

/** A ring, fainter with distance from the plane and absent beyond `reach` mm. */
function ring(
  c: Context,
  slice: SliceProjection,
  p: Vec3,
  radius: number,
  colour: string,
  reach: number,
  filled = false,
): void {
  const at = slice.toPixel(p),
    far = Math.abs(at.depth);
  if (far > reach) return;
  c.globalAlpha = 1 - (0.75 * far) / reach;
  c.strokeStyle = c.fillStyle = colour;
  c.lineWidth = 1.5;
  c.beginPath();
  c.arc(at.x, at.y, Math.max(radius, 3), 0, 2 * Math.PI);
  if (filled) c.fill();
  else c.stroke();
  c.globalAlpha = 1;
}

export const kPlaceRing = 7; // pixels
const kShownReach = 3; // mm from a slice within which the place that is shown has its ring
/** mm from a slice within which a missing vessel is marked in it. */
export const placeReach = (place: MissingVessel): number => Math.max(3, place.length_mm / 2);

function drawSeeds(c: Context, slice: SliceProjection, view: View): void {
  const pixel = slice.mmPerPixel;
  if (view.layers.seeds)
    for (const seed of view.state.seeds) {
      seed.points.forEach((point, i) => {
        const r = point.radius ?? 0,
          reach = reachOf(view, slice, Math.max(r, 4 * pixel, 1.5));
        if (r > 0) ring(c, slice, point.position, r / pixel, seed.tracked ? "#7dd3a8" : "#ffd166", reach);
        ring(c, slice, point.position, 3, seed.tracked ? "#7dd3a8" : "#ffd166", reach, true);
        const at = slice.toPixel(point.position);
        const isNamed = i === 0 && !seed.tracked; // a vessel has its name by "Names"
        if (isNamed && Math.abs(at.depth) < reach) label(c, seed.label, at.x + 7, at.y - 6, "#ffe6a8");
      });
    }
  if (view.layers.places)
    for (const { place } of missingPlaces(view.state)) {
      ring(c, slice, place.position, kPlaceRing, "#ff7a90", placeReach(place));
      ring(c, slice, place.position, 1.5, "#ff7a90", placeReach(place), true);
    }
  const shown = view.state.work?.items.find(item => item.id === view.place);
  if (shown !== undefined) ring(c, slice, shown.position, kPlaceRing + 4, "#ffffff", kShownReach);
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

/** Measured points and the lines between them, in a slice or a projection. */
export function drawMeasurements(
  c: Context,
  view: View,
  project: (p: Vec3) => Pixel | null,
  reach: number,
): void {
  const groups = [
    ...view.measurements.map(m => ({ points: m.points, text: m.text, kind: m.kind as string })),
    ...(view.pending.length > 0 ? [{ points: view.pending, text: "", kind: "pending" }] : []),
    ...(view.clicks.length > 0
      ? [{ points: view.clicks.map(click => click.position), text: "", kind: "pending" }]
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

function drawBrush(c: Context, slice: SliceProjection, view: View): void {
  if (view.stroke !== null && view.surface !== null)
    drawStroke(c, slice, view, outlines(slice, view.surface));
  c.strokeStyle = "#ffd166";
  c.lineWidth = 1.5;
  for (const line of view.brushLines) {
    c.beginPath();
    for (const [i, p] of line.map(q => slice.toPixel(q)).entries())
      if (i === 0) c.moveTo(p.x, p.y);
      else c.lineTo(p.x, p.y);
    c.stroke();
  }
}

function drawCrosshair(c: Context, slice: SliceProjection, view: View, width: number, height: number): void {
  const p = slice.toPixel(view.crosshair),
    gap = 9;
  const colours: Record<string, [string, string]> = {
    // of the planes that the lines stand for: [across, up]
    axial: ["#5ad1a0", "#f2c14e"],
    coronal: ["#e2605c", "#f2c14e"],
    sagittal: ["#e2605c", "#5ad1a0"],
  };
  const [h, v] = colours[slice.name];
  c.lineWidth = 1;
  c.globalAlpha = 0.75;
  c.strokeStyle = h;
  c.beginPath();
  c.moveTo(0, p.y);
  c.lineTo(p.x - gap, p.y);
  c.moveTo(p.x + gap, p.y);
  c.lineTo(width, p.y);
  c.stroke();
  c.strokeStyle = v;
  c.beginPath();
  c.moveTo(p.x, 0);
  c.lineTo(p.x, p.y - gap);
  c.moveTo(p.x, p.y + gap);
  c.lineTo(p.x, height);
  c.stroke();
  c.globalAlpha = 1;
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

function drawMarks(c: Context, slice: SliceProjection, width: number, height: number): void {
  const { right, up } = slice.frame,
    colour = "#c9d4e3";
  c.save();
  c.font = "600 12px system-ui, sans-serif";
  label(c, orientation(right), width - 8, height / 2, colour, "right");
  label(c, orientation(scale(right, -1)), 8, height / 2, colour);
  label(c, orientation(up), width / 2, 11, colour, "center");
  label(c, orientation(scale(up, -1)), width / 2, height - 11, colour, "center");
  c.restore();
}

/** The name of the slice and its coordinate along the patient axis that it crosses. */
function title(slice: SliceProjection, view: View): string {
  const name = { axial: "Axial", coronal: "Coronal", sagittal: "Sagittal" }[slice.name],
    n = slice.frame.normal;
  if (view.planes === "vessel")
    return { axial: "Cross-section", coronal: "Along vessel, A", sagittal: "Along vessel, B" }[slice.name];
  const axis = [0, 1, 2].find(a => Math.abs(n[a]) > 0.9999);
  if (axis === undefined) return `${name}, oblique`;
  const x = view.crosshair[axis];
  return `${name}  ${orientation([0, 1, 2].map(a => (a === axis ? Math.sign(x) || 1 : 0)) as Vec3)} ${Math.abs(x).toFixed(1)}`;
}

export function drawSliceOverlay(
  c: Context,
  slice: SliceProjection,
  view: View,
  width: number,
  height: number,
): void {
  const project = (p: Vec3): Pixel => slice.toPixel(p);
  drawOutlines(c, slice, view);
  drawLines(c, slice, view);
  drawSeeds(c, slice, view);
  drawMeasurements(c, view, project, Math.max(1.5, 4 * slice.mmPerPixel));
  drawBrush(c, slice, view);
  drawCrosshair(c, slice, view, width, height);
  drawMarks(c, slice, width, height);
  drawScaleBar(c, slice.mmPerPixel, width, height);
  label(c, title(slice, view), 8, 12, "#e8edf4");
}

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
