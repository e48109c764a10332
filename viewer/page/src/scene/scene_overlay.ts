// SPDX-License-Identifier: Apache-2.0
/** Letters and lines over the 3D view: orientation, scale, measurements, seeds, the place of the crosshair. */
import type { OrbitCamera } from "../drawing/camera";
import { toCss } from "../base/colour";
import { colourOf, isShown, shownTree, type View } from "../model/model";
import { drawProposalsInScene, strokeAxis } from "../overlay/proposal_lines";
import { drawMeasurements, drawScaleBar, label } from "../overlay/over";
import type { Vec3 } from "../base/types";
import { dot } from "../base/vec";
import { drawNamesInScene } from "../overlay/vessel_names";

const kAxes: [Vec3, string, string][] = [
  [[1, 0, 0], "L", "#e2605c"],
  [[-1, 0, 0], "R", "#e2605c"],
  [[0, 1, 0], "P", "#5ad1a0"],
  [[0, -1, 0], "A", "#5ad1a0"],
  [[0, 0, 1], "S", "#6aa5ff"],
  [[0, 0, -1], "I", "#6aa5ff"],
];

/** Six letters around a point: those that face the viewer are brighter. */
function drawCompass(c: CanvasRenderingContext2D, camera: OrbitCamera, height: number): void {
  const x = 40,
    y = height - 40,
    size = 24;
  const arms = kAxes.map(([d, letter, colour]) => ({
    letter,
    colour,
    x: dot(d, camera.right),
    y: -dot(d, camera.up),
    near: dot(d, camera.back),
  }));
  for (const arm of arms.sort((a, b) => a.near - b.near)) {
    c.globalAlpha = 0.35 + (0.65 * (arm.near + 1)) / 2;
    c.strokeStyle = arm.colour;
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(x, y);
    c.lineTo(x + size * arm.x, y + size * arm.y);
    c.stroke();
    label(c, arm.letter, x + (size + 7) * arm.x, y + (size + 7) * arm.y, "#f1f5fb", "center");
  }
  c.globalAlpha = 1;
}

function drawPoints(
  c: CanvasRenderingContext2D,
  camera: OrbitCamera,
  view: Pick<View, "document" | "slices" | "scene">,
): void {
  if (view.scene.layers.seeds)
    for (const seed of view.document.state.seeds) {
      const p = seed.tracked ? null : camera.project(seed.points[0].position);
      if (p !== null) label(c, seed.label, p.x + 8, p.y - 8, "#ffe6a8");
    }
  const cross = camera.project(view.slices.crosshair);
  if (cross === null || (view.document.volume === null && view.document.tree === null)) return;
  c.strokeStyle = "rgb(255 255 255 / 0.7)";
  c.lineWidth = 1;
  c.beginPath();
  for (const [dx, dy] of [
    [1, 0],
    [-1, 0],
    [0, 1],
    [0, -1],
  ]) {
    c.moveTo(cross.x + 4 * dx, cross.y + 4 * dy);
    c.lineTo(cross.x + 10 * dx, cross.y + 10 * dy);
  }
  c.stroke();
}

/** The centerline of the selected vessel, also through walls. Here, because a line costs nothing where the scene does. */
function drawSelected(
  c: CanvasRenderingContext2D,
  camera: OrbitCamera,
  view: Pick<View, "document" | "selection" | "motion">,
): void {
  const { selected } = view.selection,
    tree = shownTree(view),
    branch = tree?.branches[selected];
  if (tree === null || branch === undefined || !isShown(view, selected)) return;
  c.strokeStyle = toCss(colourOf(view, selected).map(x => 0.3 * x + 0.7) as [number, number, number], 0.95);
  c.lineWidth = 1.5;
  strokeAxis(c, camera, tree, branch);
}

export function drawSceneOverlay(
  c: CanvasRenderingContext2D,
  camera: OrbitCamera,
  view: Omit<View, "page">,
  width: number,
  height: number,
): void {
  const project = (p: Vec3): { x: number; y: number; depth: number } | null => camera.project(p);
  if (camera.flight !== null) {
    label(c, "Flight", 8, 12, "#e8edf4");
    return;
  }
  drawSelected(c, camera, view);
  drawProposalsInScene(c, camera, view);
  drawNamesInScene(c, camera, view);
  drawPoints(c, camera, view);
  if (view.motion.time === null) drawMeasurements(c, view, project, Infinity); // of the case at rest
  drawCompass(c, camera, height);
  drawScaleBar(c, camera.mmPerPixel, width, height);
  const branch =
    view.selection.selected >= 0 ? view.document.tree?.branches[view.selection.selected] : undefined;
  label(
    c,
    `3D${view.scene.cast === "mip" ? "  projection" : view.scene.cast === "volume" ? "  volume" : ""}${branch === undefined ? "" : `  ${branch.label}`}`,
    8,
    12,
    "#e8edf4",
  );
}
