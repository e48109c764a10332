// SPDX-License-Identifier: Apache-2.0
/** Proposed vessels over slices and over the 3D view: dashed lines in a colour that no vessel has. */
import type { OrbitCamera } from "../drawing/camera";
import type { View } from "../model/model";
import type { SliceProjection } from "../model/slice_frame";
import { label } from "./over";
import type { Branch, Tree } from "../case/tree";

const kColour = "#ff3dff", // of twice the chroma of branchColour()
  kChosen = "#ffffff",
  kDash = [5, 4];

/** Strokes the axis of a vessel, also through walls, in the colour and width that are set. */
export function strokeAxis(
  c: CanvasRenderingContext2D,
  camera: OrbitCamera,
  tree: Tree,
  branch: Branch,
): void {
  c.lineJoin = "round";
  c.beginPath();
  let open = false;
  for (const node of tree.nodesOf(branch)) {
    const p = camera.project(tree.position(node));
    if (p !== null && open) c.lineTo(p.x, p.y);
    else if (p !== null) c.moveTo(p.x, p.y);
    open = p !== null;
  }
  c.stroke();
}

/** Calls for each proposed vessel that is shown; the chosen one last, so that it lies on top. */
function eachShown(
  view: Pick<View, "document" | "selection" | "scene">,
  draw: (tree: Tree, branch: Branch, isChosen: boolean) => void,
): void {
  const { proposals: tree } = view.document;
  if (tree === null || !view.scene.layers.proposals) return;
  const rank = (b: Branch): number => (b.label === view.selection.proposal ? 1 : 0);
  for (const branch of [...tree.branches].sort((a, b) => rank(a) - rank(b)))
    draw(tree, branch, rank(branch) === 1);
}

/** In a slice: a dashed line where the vessel runs near it, and a dashed ring where its axis crosses it. */
export function drawProposalsInSlice(
  c: CanvasRenderingContext2D,
  slice: SliceProjection,
  view: Pick<View, "document" | "selection" | "scene">,
): void {
  c.setLineDash(kDash);
  eachShown(view, (tree, branch, isChosen) => {
    c.strokeStyle = isChosen ? kChosen : kColour;
    c.lineWidth = isChosen ? 2.5 : 1.5;
    c.beginPath();
    const nodes = tree.nodesOf(branch),
      at = nodes.map(node => slice.toPixel(tree.position(node)));
    for (let i = 1; i < nodes.length; ++i) {
      const [a, b] = [at[i - 1], at[i]],
        r = tree.radius[nodes[i]];
      if (Math.min(Math.abs(a.depth), Math.abs(b.depth)) < r) {
        c.moveTo(a.x, a.y);
        c.lineTo(b.x, b.y);
      }
      if (a.depth < 0 !== b.depth < 0) {
        const t = a.depth / (a.depth - b.depth),
          x = a.x + t * (b.x - a.x),
          y = a.y + t * (b.y - a.y),
          pixels = r / slice.mmPerPixel;
        c.moveTo(x + pixels, y);
        c.arc(x, y, pixels, 0, 2 * Math.PI);
      }
    }
    c.stroke();
  });
  c.setLineDash([]);
}

/** In 3D, also through walls: they are no part of the surface yet. */
export function drawProposalsInScene(
  c: CanvasRenderingContext2D,
  camera: OrbitCamera,
  view: Pick<View, "document" | "selection" | "scene">,
): void {
  eachShown(view, (tree, branch, isChosen) => {
    c.setLineDash(kDash);
    c.strokeStyle = isChosen ? kChosen : kColour;
    c.lineWidth = isChosen ? 3 : 1.75;
    strokeAxis(c, camera, tree, branch);
    c.setLineDash([]);
    const middle = camera.project(tree.position(branch.first_node + (branch.node_count >> 1)));
    if (isChosen && middle !== null) label(c, branch.label, middle.x + 9, middle.y - 9, kColour);
  });
}
