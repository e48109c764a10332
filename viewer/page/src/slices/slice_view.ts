// SPDX-License-Identifier: Apache-2.0
/** One of three linked slices: the plane through the crosshair, seen along an axis of the shared frame. */
import { drawingOf, showsSecond } from "../model/beside";
import { slabControl, splitLine } from "./slice_controls";
import type { WebGLRenderer } from "three";
import type { Part, View } from "../model/model";
import { drawProposalsInSlice } from "../overlay/proposal_lines";
import { frameOf, type Pixel, type SliceName, type SliceProjection } from "../model/slice_frame";
import { clearedContext } from "../overlay/over";
import { drawSliceOverlay } from "./slice_overlay";
import { drawNamesInSlice } from "../overlay/vessel_names";
import { kMostSamples, pickInSlab, samplesOf } from "../model/slab";
import { ScenePicture } from "../drawing/scene_picture";
import { LabelMaterial } from "./label_material";
import { SliceMaterial, type Plane } from "./slice_material";
import type { StageView } from "../drawing/stage";
import type { Vec3 } from "../base/types";
import { add, along, dot, scale, sub, type Frame } from "../base/vec";
import type { Volume } from "../case/volume";
import type { VolumeTexture } from "../drawing/volume_texture";

const kQuickSamples = 33,
  kRefineAfter = 150, // ms
  kMostPause = 1200; // ms between two pictures of one movement, at most
const kAcross = 7; // radii of the vessel that half a section shows

export class SliceView implements StageView, SliceProjection {
  private readonly material = new SliceMaterial();
  private readonly labelMaterial = new LabelMaterial();
  private readonly picture = new ScenePicture();
  readonly over: HTMLCanvasElement;
  /** mm that half the height shows; null: fit. */
  private halfHeight: number | null = null;
  private pan: [number, number] = [0, 0];
  private width = 1;
  private height = 1;
  texture: VolumeTexture | null = null;
  /** Of the volume beside the first. */
  second: VolumeTexture | null = null;
  /** Of the label map. */
  labels: VolumeTexture | null = null;
  /** The next picture of a slab takes all of its places; the first after a change only some. */
  private isFine = false;
  private refining = 0;
  private quickAt = -Infinity; // when the last quick picture was drawn, ms

  constructor(
    readonly name: SliceName,
    readonly element: HTMLElement,
    private readonly app: Part<keyof View, "stage">,
  ) {
    this.over = element.querySelector("canvas")!;
    element.querySelector(".viewtools")!.append(slabControl(app, name));
    element.append(splitLine(app, element));
    app.store.watch(
      [
        "slices",
        "document.tree",
        "document.second",
        "document.secondReady",
        "document.labels",
        "document.labelsReady",
        "page.layout",
      ],
      ({ slices }) => {
        this.texture?.interpolate(slices.interpolate);
        this.second?.interpolate(slices.interpolate);
        app.stage.invalidate(this);
      },
    );
    app.store.watch(
      [
        "document.state",
        "document.surface",
        "document.proposals",
        "motion.posed",
        "selection",
        "scene.layers",
        "tools",
      ],
      () => app.stage.invalidateOver(this),
    );
  }

  get frame(): Frame {
    return frameOf(this.name, this.app.store.get().slices.frame);
  }

  /** Half the height, mm. Without zoom, all of the volume or tree fits. */
  half(): number {
    if (this.halfHeight !== null) return this.halfHeight;
    const {
        document: { volume, tree },
        slices: { planes },
        selection: { node },
      } = this.app.store.get(),
      frame = this.frame;
    const box = volume === null ? (tree?.box() ?? null) : null;
    const corners =
      volume?.corners() ??
      (box === null
        ? []
        : [0, 1, 2, 3, 4, 5, 6, 7].map(
            k => [0, 1, 2].map(a => (((k >> a) & 1) === 1 ? box.high[a] : box.low[a])) as Vec3,
          ));
    if (corners.length === 0) return 50;
    const spread = (d: Vec3): number => {
      const x = corners.map(c => dot(c, d));
      return (Math.max(...x) - Math.min(...x)) / 2;
    };
    const all = Math.max(spread(frame.up), (spread(frame.right) * this.height) / Math.max(this.width, 1));
    if (planes !== "vessel" || tree === null || node < 0) return 1.04 * all;
    return Math.min(
      all,
      Math.max(kAcross * tree.branches[tree.branch[node]].mean, 10 * (tree.voxelSize || 0.1)),
    );
  }

  get mmPerPixel(): number {
    return (2 * this.half()) / Math.max(this.height, 1);
  }

  /** The point in the middle of the view: the middle of the volume where all of it is shown, else the crosshair; panned. */
  centre(): Vec3 {
    const {
        slices: { crosshair, planes },
        document: { volume, tree },
      } = this.app.store.get(),
      f = this.frame;
    const box = tree?.box() ?? null;
    const middle = volume?.centre() ?? (box === null ? crosshair : scale(add(box.low, box.high), 0.5));
    const base =
      planes === "vessel" ? crosshair : along(middle, f.normal, dot(sub(crosshair, middle), f.normal));
    return along(along(base, f.right, this.pan[0]), f.up, this.pan[1]);
  }

  /** Position in the plane of a pixel. */
  toPosition(x: number, y: number): Vec3 {
    const f = this.frame,
      s = this.mmPerPixel;
    return along(along(this.centre(), f.right, (x - this.width / 2) * s), f.up, (this.height / 2 - y) * s);
  }
  /** What is drawn at a place of the plane: the brightest or darkest through a slab, otherwise the place itself. */
  picked(p: Vec3): Vec3 {
    const {
      document: { volume },
      slices: { slabs },
    } = this.app.store.get();
    return pickInSlab(volume, slabs[this.name], p, this.frame.normal);
  }
  toPixel(p: Vec3): Pixel {
    const { x, y, depth } = this.toPixels();
    return { x: dot(p, x.by) + x.offset, y: dot(p, y.by) + y.offset, depth: dot(p, depth.by) + depth.offset };
  }
  toPixels(): ReturnType<SliceProjection["toPixels"]> {
    const f = this.frame,
      s = 1 / this.mmPerPixel,
      centre = this.centre();
    const row = (d: Vec3, origin: number): { by: Vec3; offset: number } => ({
      by: d,
      offset: origin - dot(centre, d),
    });
    return {
      x: row(scale(f.right, s), this.width / 2),
      y: row(scale(f.up, -s), this.height / 2),
      depth: row(f.normal, 0),
    };
  }

  draw(renderer: WebGLRenderer, width: number, height: number): void {
    this.width = width;
    this.height = height;
    const view = this.app.store.get();
    if (this.texture === null || view.document.volume === null) return;
    const halfHeight = this.half(),
      plane = {
        centre: this.centre(),
        frame: this.frame,
        halfWidth: (halfHeight * width) / height,
        halfHeight,
      },
      isQuick = this.isQuick(view),
      draw = (): void => this.drawVolumes(renderer, view, plane, isQuick ? kQuickSamples : kMostSamples);
    // without a graphics processor a thick slab costs what its pixels cost
    if (isQuick && this.app.stage.software) this.picture.draw(renderer, [width, height], true, { all: draw });
    else draw();
    this.drawLabels(renderer, view, plane);
  }

  private drawLabels(
    renderer: WebGLRenderer,
    { document: { labels, labelsReady }, slices }: Pick<View, "document" | "slices">,
    plane: Plane,
  ): void {
    if (this.labels === null || labels === null || slices.labelLook.mode === "off") return;
    this.labelMaterial.draw(
      renderer,
      this.labels,
      plane,
      [this.width, this.height],
      labelsReady / labels.size[2],
      slices.labelLook,
      slices.labelPalette,
    );
  }

  /** The volume, and the one beside it; with no more places through a slab than `most`. */
  private drawVolumes(
    renderer: WebGLRenderer,
    view: Pick<View, "document" | "slices">,
    plane: Plane,
    most: number,
  ): void {
    const slab = view.slices.slabs[this.name],
      samples = (volume: Volume): number => Math.min(most, samplesOf(slab, volume.spacing)),
      {
        document: { volume, second },
        slices: { beside },
      } = view;
    if (this.texture === null || volume === null) return;
    this.material.draw(
      renderer,
      this.texture,
      plane,
      view.slices.window,
      view.document.volumeReady / volume.size[2],
      slab,
      samples(volume),
    );
    if (this.second === null || second === null || !showsSecond(view)) return;
    this.material.draw(
      renderer,
      this.second,
      plane,
      view.slices.secondWindow,
      view.document.secondReady / second.size[2],
      slab,
      samples(second),
      { ...drawingOf(beside), isSeenThrough: beside.mode === "blend" },
    );
  }

  /** Whether the next picture is a quick one: a thick slab while something moves. A moment later it is drawn in full. */
  private isQuick(view: Pick<View, "document" | "slices">): boolean {
    window.clearTimeout(this.refining);
    const shown = [view.document.volume!, ...(showsSecond(view) ? [view.document.second!] : [])],
      wanted = shown.map(({ spacing }) => samplesOf(view.slices.slabs[this.name], spacing));
    if (Math.max(...wanted) <= kQuickSamples || this.isFine) {
      this.isFine = false;
      return false;
    }
    // where pictures are slow, the next of a movement comes later
    const now = performance.now(),
      pause = now - this.quickAt;
    this.quickAt = now;
    this.refining = window.setTimeout(
      () => {
        this.isFine = true;
        this.app.stage.invalidate(this);
      },
      pause < kMostPause ? Math.max(kRefineAfter, 2 * pause) : kRefineAfter,
    );
    return true;
  }

  drawOver(width: number, height: number): void {
    const c = clearedContext(this.over, width, height);
    drawProposalsInSlice(c, this, this.app.store.get());
    drawSliceOverlay(c, this, this.app.store.get(), width, height);
    drawNamesInSlice(c, this, this.app.store.get());
  }

  zoomBy(factor: number, x = this.width / 2, y = this.height / 2): void {
    const before = this.toPosition(x, y);
    this.halfHeight = Math.min(2000, Math.max(0.2, this.half() * factor));
    const after = this.toPosition(x, y),
      f = this.frame,
      d = sub(before, after);
    this.pan = [this.pan[0] + dot(d, f.right), this.pan[1] + dot(d, f.up)];
    this.app.stage.invalidate(this);
  }
  panBy(dx: number, dy: number): void {
    const s = this.mmPerPixel;
    this.pan = [this.pan[0] - dx * s, this.pan[1] + dy * s];
    this.app.stage.invalidate(this);
  }
  fit(): void {
    this.halfHeight = null;
    this.pan = [0, 0];
    this.app.stage.invalidate(this);
  }
  /** Steps through the volume by a number of voxels: to the head, to the front, to the left. */
  step(count: number): void {
    const { volume, tree } = this.app.store.get().document,
      f = this.frame,
      upwards = this.name === "axial" ? -1 : 1; // the view is from the feet
    const each = volume === null ? Math.max(tree?.voxelSize ?? 0, 0.1) : Math.min(...volume.spacing);
    this.moveCrosshair(f.normal, upwards * count * each);
  }
  /** Moves the crosshair along a direction, but not out of the volume. */
  moveCrosshair(direction: Vec3, mm: number): void {
    const {
        document: { volume },
        slices: { crosshair },
      } = this.app.store.get(),
      to = along(crosshair, direction, mm);
    if (volume !== null && volume.holds(crosshair) && !volume.holds(to)) return;
    this.app.store.set({ slices: { crosshair: to } });
    this.reveal(to);
  }
  /** Brings a point into the middle where it would be out of sight. */
  reveal(p: Vec3): void {
    const { x, y } = this.toPixel(p),
      margin = 12;
    if (x > margin && y > margin && x < this.width - margin && y < this.height - margin) return;
    this.panBy(this.width / 2 - x, this.height / 2 - y);
  }
}
