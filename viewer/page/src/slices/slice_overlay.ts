// SPDX-License-Identifier: Apache-2.0
/** Lines and letters over a slice. */
import { toCss } from "../base/colour";
import { drawMeasurements, drawScaleBar, label } from "../overlay/over";
import { colourOf, isShown, shownTree, type View } from "../model/model";
import type { Pixel, SliceProjection } from "../model/slice_frame";
import { reachOf } from "../model/slab";
import { branchesAt, pushed } from "../model/stroke";
import type { Surface } from "../case/surface";
import type { MissingVessel, Vec3 } from "../base/types";
import { dot, length, orientation, scale, sub, unit } from "../base/vec";
import { missingPlaces } from "../case/work_items";

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

function drawOutlines(
  c: Context,
  slice: SliceProjection,
  view: Pick<View, "document" | "selection" | "scene">,
): void {
  const { surface } = view.document;
  if (surface === null || !view.scene.layers.contours) return;
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
    c.strokeStyle = toCss(colourOf(view, part.branch), part.branch === view.selection.selected ? 1 : 0.8);
    c.lineWidth = part.branch === view.selection.selected ? 2 : 1.2;
    c.stroke();
  });
}

function drawLines(c: Context, slice: SliceProjection, view: Omit<View, "page">): void {
  const tree = shownTree(view);
  if (tree === null || !view.scene.layers.lines) return;
  const near = reachOf(view, slice, 2 * slice.mmPerPixel + (tree.voxelSize || 0.5)),
    { x, y, depth } = slice.toPixels(),
    p = tree.centre;
  const on = (row: { by: Vec3; offset: number }, k: number): number =>
    p[k] * row.by[0] + p[k + 1] * row.by[1] + p[k + 2] * row.by[2] + row.offset;
  for (const branch of tree.branches) {
    if (!isShown(view, branch.index)) continue;
    c.fillStyle = toCss(colourOf(view, branch.index), 0.9);
    for (let k = 3 * branch.first_node; k < 3 * (branch.first_node + branch.node_count); k += 3)
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

function drawSeeds(
  c: Context,
  slice: SliceProjection,
  view: Pick<View, "document" | "selection" | "slices" | "scene">,
): void {
  const pixel = slice.mmPerPixel;
  if (view.scene.layers.seeds)
    for (const seed of view.document.state.seeds) {
      seed.points.forEach((point, i) => {
        const r = point.radius_mm ?? 0,
          reach = reachOf(view, slice, Math.max(r, 4 * pixel, 1.5));
        if (r > 0) ring(c, slice, point.position, r / pixel, seed.tracked ? "#7dd3a8" : "#ffd166", reach);
        ring(c, slice, point.position, 3, seed.tracked ? "#7dd3a8" : "#ffd166", reach, true);
        const at = slice.toPixel(point.position);
        const isNamed = i === 0 && !seed.tracked; // a vessel has its name by "Names"
        if (isNamed && Math.abs(at.depth) < reach) label(c, seed.label, at.x + 7, at.y - 6, "#ffe6a8");
      });
    }
  if (view.scene.layers.places)
    for (const { place } of missingPlaces(view.document.state)) {
      ring(c, slice, place.position, kPlaceRing, "#ff7a90", placeReach(place));
      ring(c, slice, place.position, 1.5, "#ff7a90", placeReach(place), true);
    }
  const shown = view.document.state.work?.items.find(item => item.id === view.selection.place);
  if (shown !== undefined) ring(c, slice, shown.position, kPlaceRing + 4, "#ffffff", kShownReach);
}

/** Draws the outlines near the brush where the stroke takes them. `outlines`: segments of each part of the surface, as
 * x y z of both ends. */
function drawStroke(
  c: Context,
  slice: SliceProjection,
  view: Pick<View, "document" | "selection" | "tools">,
  outlines: (number[] | null)[],
): void {
  const {
    tools: { stroke },
    document: { tree, surface },
  } = view;
  if (stroke === null || tree === null || surface === null) return;
  const branches = branchesAt(tree, stroke.node),
    moved = (p: Vec3): Vec3 | null => {
      if (length(sub(p, stroke.at)) >= stroke.radius) return null;
      const node = tree.nearest(p, b => branches.has(b));
      return pushed(p, tree.position(node), unit(tree.axis(node)), stroke);
    };
  c.beginPath();
  surface.parts.forEach((part, i) => {
    const ends = outlines[i];
    if (ends === null || !branches.has(part.branch) || !isShown(view, part.branch)) return;
    for (let k = 0; k < ends.length; k += 6) {
      const a: Vec3 = [ends[k], ends[k + 1], ends[k + 2]],
        b: Vec3 = [ends[k + 3], ends[k + 4], ends[k + 5]],
        from = moved(a),
        to = moved(b);
      if (from === null && to === null) continue;
      const p = slice.toPixel(from ?? a),
        q = slice.toPixel(to ?? b);
      c.moveTo(p.x, p.y);
      c.lineTo(q.x, q.y);
    }
  });
  c.strokeStyle = "#ffffff";
  c.lineWidth = 2;
  c.stroke();
}

function drawBrush(
  c: Context,
  slice: SliceProjection,
  view: Pick<View, "document" | "selection" | "tools">,
): void {
  if (view.tools.stroke !== null && view.document.surface !== null)
    drawStroke(c, slice, view, outlines(slice, view.document.surface));
  c.strokeStyle = "#ffd166";
  c.lineWidth = 1.5;
  for (const line of view.tools.brushLines) {
    c.beginPath();
    for (const [i, p] of line.map(q => slice.toPixel(q)).entries())
      if (i === 0) c.moveTo(p.x, p.y);
      else c.lineTo(p.x, p.y);
    c.stroke();
  }
}

function drawCrosshair(
  c: Context,
  slice: SliceProjection,
  view: Pick<View, "slices">,
  width: number,
  height: number,
): void {
  const p = slice.toPixel(view.slices.crosshair),
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
function title(slice: SliceProjection, view: Pick<View, "slices">): string {
  const name = { axial: "Axial", coronal: "Coronal", sagittal: "Sagittal" }[slice.name],
    n = slice.frame.normal;
  if (view.slices.planes === "vessel")
    return { axial: "Cross-section", coronal: "Along vessel, A", sagittal: "Along vessel, B" }[slice.name];
  const axis = [0, 1, 2].find(a => Math.abs(n[a]) > 0.9999);
  if (axis === undefined) return `${name}, oblique`;
  const x = view.slices.crosshair[axis];
  return `${name}  ${orientation([0, 1, 2].map(a => (a === axis ? Math.sign(x) || 1 : 0)) as Vec3)} ${Math.abs(x).toFixed(1)}`;
}

export function drawSliceOverlay(
  c: Context,
  slice: SliceProjection,
  view: Omit<View, "page">,
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
