// SPDX-License-Identifier: Apache-2.0
/** Names of vessels in the views: the longest first, and none over another. */
import type { OrbitCamera } from "../drawing/camera";
import { isShown, shownTree, type View } from "../model/model";
import type { SliceProjection } from "../model/slice_frame";
import { label } from "./over";
import type { BranchRecord } from "../base/types";

type Context = CanvasRenderingContext2D;

const kMaxNames = 80, // names in one view
  kHeight = 14, // pixels of a line
  kAside = 6; // pixels from the vessel's axis to its name

interface Name {
  text: string;
  x: number;
  y: number;
}

/** The names whose boxes, of the given widths, meet no box before them; at most kMaxNames. */
export function namesApart(names: readonly Name[], widthOf: (text: string) => number): Name[] {
  const boxes: { left: number; right: number; y: number }[] = [],
    kept: Name[] = [];
  for (const name of names) {
    if (kept.length === kMaxNames) break;
    const left = name.x,
      right = left + widthOf(name.text);
    if (boxes.some(b => left < b.right && b.left < right && Math.abs(b.y - name.y) < kHeight)) continue;
    boxes.push({ left, right, y: name.y });
    kept.push(name);
  }
  return kept;
}

function shownBranches(
  view: Pick<View, "document" | "selection" | "scene">,
): (BranchRecord & { index: number })[] {
  if (!view.scene.layers.names || view.document.tree === null) return [];
  return [...view.document.tree.branches]
    .filter(b => isShown(view, b.index))
    .sort(
      (a, b) =>
        Number(b.index === view.selection.selected) - Number(a.index === view.selection.selected) ||
        b.length_mm - a.length_mm,
    );
}

function draw(c: Context, names: Name[]): void {
  c.font = "500 11px system-ui, sans-serif";
  for (const { text, x, y } of namesApart(names, text => c.measureText(text).width))
    label(c, text, x, y, "#f1f5fb");
}

/** In the middle of every vessel that is shown. */
export function drawNamesInScene(
  c: Context,
  camera: OrbitCamera,
  view: Pick<View, "document" | "selection" | "motion" | "scene">,
): void {
  const tree = shownTree(view);
  if (tree === null) return;
  draw(
    c,
    shownBranches(view).flatMap(b => {
      const at = camera.project(tree.position(b.first_node + (b.node_count >> 1)));
      return at === null ? [] : [{ text: b.label, x: at.x + kAside, y: at.y }];
    }),
  );
}

/** Beside every vessel that the slice meets: at its node that is nearest to the plane, within a radius. */
export function drawNamesInSlice(
  c: Context,
  slice: SliceProjection,
  view: Pick<View, "document" | "selection" | "motion" | "scene">,
): void {
  const tree = shownTree(view);
  if (tree === null) return;
  draw(
    c,
    shownBranches(view).flatMap(b => {
      let best: Name | null = null,
        least = Infinity;
      for (let node = b.first_node; node < b.first_node + b.node_count; ++node) {
        const at = slice.toPixel(tree.position(node)),
          away = Math.abs(at.depth);
        if (away >= least || away > tree.radius[node]) continue;
        least = away;
        best = { text: b.label, x: at.x + tree.radius[node] / slice.mmPerPixel + kAside, y: at.y };
      }
      return best === null ? [] : [best];
    }),
  );
}
