// SPDX-License-Identifier: Apache-2.0
/** Lines of the 3D view that are drawn over the scene. */
import type { OrbitCamera } from "./camera";
import type { Branch, Tree } from "./tree";

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
