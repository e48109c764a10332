// SPDX-License-Identifier: Apache-2.0
/** Clicks with a tool: seeds, measurements, a node that is moved. */
import type { CursorPart, Measurement } from "../model/model";
import { isShown } from "../model/model";
import { Brush } from "./brush";
import { angle, gaps, sectionAt } from "./measure";
import { probe } from "./probe";
import { goToNode, select } from "../model/selection";
import type { SliceView } from "../slices/slice_view";
import type { Hit } from "../case/surface";
import type { MissingVessel, Seed, VesselAtClick, Vec3 } from "../base/types";
import { along, circle, distance, dot, sub } from "../base/vec";
import { askText, brief, errorText } from "../base/ui";

const kMiddle = 0.6; // radii from the axis within which a press takes the node, and beyond which its wall
const kRim = 0.75; // radii from the axis from which a click is at the rim
const kNearSeed = 8; // pixels within which a press takes hold of a seed

const sentence = (text: string): string =>
  `${text.charAt(0).toUpperCase()}${text.slice(1).replace(/\.$/, "")}.`;

/** The clicks that the check proposes, of which the first has a radius. */
function seedPoints(place: MissingVessel): Seed["points"] {
  const points = place.clicks?.points ?? [place.position],
    radius = place.clicks === undefined ? place.radius_mm : place.clicks.radius_mm;
  return points.map((position, i) => ({ position, radius_mm: i === 0 ? radius : null }));
}

const kStretch = 3; // radii over which a radius that is dragged fades, unless the user states another length

export class Hand {
  readonly brush: Brush;
  /** The next clicks make a vessel of one click, a vessel through several clicks, or an aneurysm. */
  seedKind: "vessel" | "path" | "aneurysm" = "vessel";
  parent: string | null = null;
  private held:
    | { seed: string; point: number; from: Vec3; to: Vec3 }
    | { node: number; to: Vec3 }
    | { node: number; radius: number }
    | null = null;
  private nextId = 1;
  private placing: Promise<void> = Promise.resolve(); // clicks come in their order, however long each takes

  constructor(private readonly app: CursorPart<"tools", "source" | "stage" | "inform" | "perform">) {
    this.brush = new Brush(app);
  }

  /** True: the press was used. */
  press(p: Vec3, slice: SliceView | null, hit: Hit | null = null): boolean {
    const { store } = this.app,
      { tool, pending } = store.get().tools;
    switch (tool) {
      case "seed":
        if (slice !== null && this.holdSeed(p, slice)) return true;
        store.set({ slices: { crosshair: p } });
        this.placing = this.placing.then(() => this.placeSeed(p));
        return true;
      case "distance":
      case "angle": {
        const points = [...pending, p],
          enough = tool === "distance" ? 2 : 3;
        if (points.length < enough) store.set({ tools: { pending: points } });
        else this.measured(tool, points);
        return true;
      }
      case "section":
        this.section(p, hit);
        return true;
      case "touch":
        this.touch(p, hit);
        return true;
      case "move":
        return slice !== null && this.holdNode(p);
      case "brush":
        return slice !== null && this.brush.press(p, slice);
      default:
        return false;
    }
  }
  drag(p: Vec3, slice: SliceView): boolean {
    if (this.brush.drag(p, slice)) return true;
    if (this.held === null) return false;
    if ("radius" in this.held) this.widen(this.held, p, slice);
    else {
      this.held.to = "seed" in this.held ? this.atDepthOf(this.held.from, p, slice) : p;
      this.app.store.set({ tools: { pending: [this.held.to] } });
    }
    this.app.stage.invalidate(slice);
    return true;
  }
  /** A seed that a slab shows keeps its depth. */
  private atDepthOf(from: Vec3, p: Vec3, slice: SliceView): Vec3 {
    const { normal } = slice.frame,
      isSlab = this.app.store.get().slices.slabs[slice.name].kind !== "off";
    return isSlab ? along(p, normal, dot(sub(from, p), normal)) : p;
  }
  release(): boolean {
    if (this.brush.release()) return true;
    const held = this.held,
      { tree } = this.app.store.get().document;
    if (held === null) return false;
    this.held = null;
    this.app.store.set({ tools: { pending: [] } });
    if ("radius" in held) void this.setRadius(held.node, held.radius);
    else if ("node" in held)
      void this.app.perform({
        op: "move",
        node: held.node,
        position: held.to,
        radius_mm: tree!.radius[held.node],
      });
    else void this.app.perform({ op: "seed_move", label: held.seed, point: held.point, position: held.to });
    return true;
  }

  // ---- seeds

  private holdSeed(p: Vec3, slice: SliceView): boolean {
    for (const seed of this.app.store.get().document.state.seeds)
      for (const [i, point] of seed.points.entries())
        if (
          !seed.tracked &&
          distance(point.position, p) < Math.max(kNearSeed * slice.mmPerPixel, 0.5 * (point.radius_mm ?? 0))
        ) {
          this.held = { seed: seed.label, point: i, from: point.position, to: point.position };
          return true;
        }
    return false;
  }

  private async placeSeed(p: Vec3): Promise<void> {
    const { app } = this,
      { store, source } = app;
    if (!source.live) {
      app.inform("This page is one file: seeds are placed in lumen view.", "warning");
      return;
    }
    const { volume, state } = store.get().document;
    if (volume !== null && !volume.holds(p)) {
      app.inform("This place is outside of the volume.", "warning");
      return;
    }
    if (!state.has_volume) {
      app.inform("Seeds are placed in a volume: open one first.", "warning");
      return;
    }
    let atClick: VesselAtClick | null = null;
    try {
      atClick = await source.vesselAtClick(p);
    } catch (error) {
      app.inform(errorText(error), "error");
      return;
    }
    const point = atClick.found ? atClick.position : p;
    if (store.get().slices.crosshair === p) store.set({ slices: { crosshair: point } }); // unless the user has gone elsewhere meanwhile
    if (!atClick.found)
      app.inform(
        `${sentence(atClick.reason ?? "no vessel was found near there")} The seed stays where you clicked.`,
        "warning",
      );
    else if (distance(p, point) > kRim * atClick.radius_mm)
      app.inform(
        `The click was at the rim of a vessel of radius ${brief(atClick.radius_mm)} mm, or beside it: the seed was moved ${brief(distance(p, point))} mm onto its axis.`,
        "warning",
      );
    else app.inform(`On the axis of a vessel, radius ${brief(atClick.radius_mm)} mm.`);
    const made = { position: point, radius_mm: atClick.found ? atClick.radius_mm : null };
    if (this.seedKind === "vessel") await this.addSeed([made], "vessel");
    else store.set({ tools: { clicks: [...store.get().tools.clicks, made] } });
  }

  /** Ends a vessel through several clicks, or an aneurysm. */
  async finish(): Promise<void> {
    await this.placing;
    const points = this.app.store.get().tools.clicks;
    this.app.store.set({ tools: { clicks: [] } });
    if (points.length > 0) await this.addSeed(points, this.seedKind === "aneurysm" ? "aneurysm" : "vessel");
  }
  giveUp(): void {
    this.held = null;
    this.brush.giveUp();
    this.app.store.set({ tools: { pending: [], clicks: [] } });
  }
  private async addSeed(points: Seed["points"], kind: string): Promise<void> {
    await this.app.perform({
      op: "seed_add",
      kind,
      points,
      ...(this.parent === null ? {} : { parent: this.parent }),
    });
  }

  /** A place that the check reports: its seed, with the vessel that it leaves. */
  takePlace(index: number): void {
    const { state } = this.app.store.get().document,
      place = state.check?.missing_vessels?.[index];
    if (place === undefined) return;
    const points = seedPoints(place),
      same = (p: Vec3): boolean => distance(p, points[0].position) < 1e-6;
    this.app.store.set({ slices: { crosshair: place.position } });
    if (this.app.source.live && !state.seeds.some(seed => same(seed.points[0].position)))
      void this.app.perform({ op: "seed_add", kind: "vessel", points }).then(done => {
        if (done) this.app.inform("A seed was placed there. Track it with “Track all”, key T.");
      });
  }

  // ---- measurements

  private add(kind: Measurement["kind"], points: Vec3[], text: string, detail: string): void {
    const { store } = this.app;
    store.set({
      tools: {
        pending: [],
        measurements: [...store.get().tools.measurements, { id: this.nextId++, kind, points, text, detail }],
      },
    });
  }
  private measured(kind: "distance" | "angle", points: Vec3[]): void {
    if (kind === "distance")
      this.add(kind, points, `${brief(distance(points[0], points[1]))} mm`, "distance");
    else this.add(kind, points, `${angle(points[0], points[1], points[2]).toFixed(1)}°`, "angle");
  }
  /** Keeps what the probe shows. */
  keepProbe(p: Vec3): void {
    const view = this.app.store.get(),
      a = probe(view, p),
      branch =
        a.wall === null || view.document.tree === null
          ? ""
          : (view.document.tree.branches[view.document.tree.branch[a.wall.node]]?.label ?? "");
    const texts = [
      Number.isFinite(a.value) ? `value ${brief(a.value)}` : "",
      a.wall === null ? "" : `wall ${a.wall.distance.toFixed(3)} mm`,
      branch,
    ].filter(x => x !== "");
    this.add("probe", [p], texts[0] ?? "", texts.join(", "));
  }

  private nodeAt(p: Vec3, hit: Hit | null): number {
    const view = this.app.store.get(),
      { tree } = view.document;
    if (tree === null) return -1;
    if (hit !== null && hit.node >= 0 && hit.node < tree.count) return hit.node;
    return tree.nearest(p, b => isShown(view, b));
  }
  section(p: Vec3, hit: Hit | null = null): void {
    const { blob, tree } = this.app.store.get().document,
      node = this.nodeAt(p, hit);
    if (tree === null || blob === null || node < 0) {
      this.app.inform("A section needs a case with models: fit it first.", "warning");
      return;
    }
    goToNode(this.app, node);
    const s = sectionAt(blob, tree, node);
    this.add(
      "section",
      s.outline,
      `⌀ ${brief(s.diameter)} mm, ${brief(s.area)} mm²`,
      `${tree.branches[tree.branch[node]].label}: widths ${brief(s.least)} to ${brief(s.greatest)} mm, circumference ${brief(s.perimeter)} mm`,
    );
  }
  private touch(p: Vec3, hit: Hit | null): void {
    const { tree, blob } = this.app.store.get().document,
      node = this.nodeAt(p, hit);
    if (tree === null || node < 0) return;
    const branch = tree.branch[node],
      [gap] = gaps(tree, blob, 1, branch);
    select(this.app, branch);
    if (gap === undefined) this.app.inform(`No other vessel comes near ${tree.branches[branch].label}.`);
    else this.showGap(gap.from, gap.to, gap.gap, tree.branches[gap.a].label, tree.branches[gap.b].label);
  }
  showGap(from: Vec3, to: Vec3, gap: number, a: string, b: string): void {
    this.app.store.set({ slices: { crosshair: from } });
    this.add(
      "touch",
      [from, to],
      gap > 0 ? `gap ${brief(gap)} mm` : `overlap ${brief(-gap)} mm`,
      `${a} and ${b}`,
    );
  }

  // ---- nodes

  private holdNode(p: Vec3): boolean {
    const view = this.app.store.get(),
      {
        document: { tree },
        selection: { selected },
      } = view;
    if (tree === null || !this.app.source.live) return false;
    const node = tree.nearest(p, b => (selected >= 0 ? b === selected : isShown(view, b)));
    if (node < 0 || distance(tree.position(node), p) > 2 * tree.radius[node]) {
      this.app.inform("There is no node near there; select its vessel first.", "warning");
      return true;
    }
    goToNode(this.app, node);
    this.held =
      distance(tree.position(node), p) > kMiddle * tree.radius[node]
        ? { node, radius: tree.radius[node] }
        : { node, to: tree.position(node) };
    return true;
  }
  /** Draws the circle that the wall becomes, in the plane of the slice. */
  private widen(held: { node: number; radius: number }, p: Vec3, slice: SliceView): void {
    const centre = this.app.store.get().document.tree!.position(held.node),
      { right, up } = slice.frame;
    held.radius = Math.max(distance(centre, p), slice.mmPerPixel);
    this.app.store.set({ tools: { pending: circle(centre, held.radius, right, up) } });
  }
  /** Gives the vessel another radius at a node, which fades along it; with no stretch, that node alone becomes a circle. */
  private async setRadius(node: number, radius: number): Promise<void> {
    const {
        document: { tree },
        tools: { stretch },
      } = this.app.store.get(),
      reach = stretch ?? kStretch * tree!.radius[node];
    await this.app.perform(
      reach > 0
        ? { op: "widen", node, radius_mm: radius, reach_mm: reach }
        : { op: "move", node, position: tree!.position(node), radius_mm: radius },
    );
  }
  /** Asks for the radius of the vessel at the cursor's node. */
  async askRadius(): Promise<void> {
    const {
      document: { tree },
      selection: { node },
    } = this.app.store.get();
    if (tree === null || node < 0 || !this.app.source.live) return;
    const label = tree.branches[tree.branch[node]].label,
      now = tree.radius[node].toFixed(2),
      text = await askText(`Radius of ${label} at the cursor`, "Radius, mm", now),
      radius = Number(text);
    if (text === null || text.trim() === now) return;
    if (radius > 0) await this.setRadius(node, radius);
    else this.app.inform(`“${text}” is no radius: expected is a number above 0.`, "warning");
  }
}
