// SPDX-License-Identifier: Apache-2.0
/** The brush, which pushes or pulls the wall of a vessel in a slice. */
import { isShown, type CursorPart } from "../model/model";
import { goToNode } from "../model/selection";
import type { SliceView } from "../slices/slice_view";
import type { Vec3 } from "../base/types";
import { circle, distance, length, sub } from "../base/vec";

const kUsual = 0.8, // radii of the vessel
  kGrowth = 1.15, // factor of one turn of the wheel
  kLeast = 0.1,
  kMost = 50, // mm
  kLeastWay = 0.25; // pixels below which a stroke is a click

export class Brush {
  private held: { node: number; at: Vec3; by: Vec3; slice: SliceView } | null = null;

  constructor(private readonly app: CursorPart<"tools", "source" | "inform" | "perform">) {}

  /** The node whose wall the brush works on at a place: of the selected vessel if one is selected. */
  private nodeAt(p: Vec3): number {
    const view = this.app.store.get(),
      {
        document: { tree },
        selection: { selected },
      } = view;
    return tree === null ? -1 : tree.nearest(p, b => (selected >= 0 ? b === selected : isShown(view, b)));
  }
  /** Radius at a node, mm. */
  private radius(node: number): number {
    const {
      tools: { brush },
      document: { tree },
    } = this.app.store.get();
    return brush ?? (node < 0 ? 1 : kUsual * tree!.radius[node]);
  }

  show(p: Vec3, slice: SliceView): void {
    const { right, up } = slice.frame;
    this.app.store.set({ tools: { brushLines: [circle(p, this.radius(this.nodeAt(p)), right, up)] } });
  }
  hide(): void {
    this.app.store.set({ tools: { brushLines: [], stroke: null } });
  }
  /** Wider (1) or narrower (-1). */
  grow(p: Vec3, way: number): void {
    const wanted = this.radius(this.nodeAt(p)) * kGrowth ** way;
    this.app.store.set({
      tools: { brush: Number(Math.min(kMost, Math.max(kLeast, wanted)).toPrecision(3)) },
    });
  }

  press(p: Vec3, slice: SliceView): boolean {
    if (!this.app.source.live) return false;
    const { tree } = this.app.store.get().document,
      node = this.nodeAt(p);
    if (tree === null || node < 0) {
      this.app.inform("There is no vessel whose wall could be pushed.", "warning");
      return true;
    }
    if (
      Math.abs(distance(tree.position(node), p) - tree.radius[node]) >
      this.radius(node) + tree.radius[node]
    ) {
      this.app.inform("There is no wall near there: press at the outline of a vessel.", "warning");
      return true;
    }
    this.held = { node, at: p, by: [0, 0, 0], slice };
    return true;
  }
  drag(p: Vec3, slice: SliceView): boolean {
    const { held } = this;
    if (held === null) return false;
    const { right, up } = slice.frame,
      radius = this.radius(held.node);
    held.by = sub(p, held.at);
    this.app.store.set({
      tools: {
        brushLines: [circle(held.at, radius, right, up), [held.at, p], circle(p, radius, right, up)],
        stroke: { node: held.node, at: held.at, by: held.by, radius },
      },
    });
    return true;
  }
  release(): boolean {
    const { held } = this;
    if (held === null) return false;
    this.held = null;
    this.hide();
    const radius = this.radius(held.node);
    if (length(held.by) < kLeastWay * held.slice.mmPerPixel)
      this.app.inform("Drag the brush: the wall moves with it, in or out.");
    else void this.push(held.node, held.at, held.by, radius);
    return true;
  }
  private async push(node: number, at: Vec3, by: Vec3, radius: number): Promise<void> {
    goToNode(this.app, node);
    this.app.store.set({ slices: { crosshair: at } }); // the slice stays
    await this.app.perform({ op: "push", node, at, by, radius_mm: radius });
  }
  giveUp(): void {
    this.held = null;
    this.hide();
  }
}
