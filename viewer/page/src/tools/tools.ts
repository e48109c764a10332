// SPDX-License-Identifier: Apache-2.0
/** Actions of the pointer with the chosen tool. */
import type { Flight } from "../scene/flight";
import type { Hand } from "./hand";
import { isShown, opacityOf, shownTree, type CursorPart, type Tool, type View } from "../model/model";
import { playOrPause } from "../model/posing";
import { probe, type Answer } from "./probe";
import type { SceneView } from "../scene/scene_view";
import { goTo, goToNode, select } from "../model/selection";
import type { SliceView } from "../slices/slice_view";
import type { Hit } from "../case/surface";
import type { Vec3 } from "../base/types";
import { kPlaceRing, placeReach } from "../slices/slice_overlay";
import { along, dot, length, sub, cross } from "../base/vec";
import { missingPlaces } from "../case/work_items";

const kVisible = 0.04; // of the window: a grey that the eye tells from black

/** Whether the clip plane cuts a place away. */
function isCutAway(
  { scene: { clip }, slices: { frame, crosshair } }: Pick<View, "slices" | "scene">,
  p: Vec3,
): boolean {
  return clip.on && (clip.flip ? -1 : 1) * dot(frame.normal, sub(p, crosshair)) > 0;
}

interface Picked extends Hit {
  seed: string | null;
  place: number;
}

export class Tools {
  private readonly listeners: ((answer: Answer | null) => void)[] = [];
  private pending: (() => void) | null = null;

  constructor(
    private readonly app: CursorPart<"scene" | "tools", "stage" | "inform">,
    private readonly hand: Hand,
    private readonly flight: Flight,
  ) {}

  /** Whether clicks of a vessel wait for its end. */
  areClicksWaiting(): boolean {
    return this.app.store.get().tools.clicks.length > 0;
  }
  get tool(): Tool {
    return this.app.store.get().tools.tool;
  }
  onProbe(call: (answer: Answer | null) => void): void {
    this.listeners.push(call);
  }

  // ---- slices

  pressInSlice(slice: SliceView, plane: Vec3): void {
    const { store } = this.app,
      p = this.tool === "move" || this.tool === "brush" ? plane : slice.picked(plane),
      place = this.tool === "navigate" || this.tool === "seed" ? this.placeAt(slice, p) : -1;
    if (place >= 0) {
      this.hand.takePlace(place);
      return;
    }
    if (this.tool === "navigate" || this.tool === "probe") {
      goTo(this.app, p);
      return;
    }
    if (!this.hand.press(p, slice)) store.set({ slices: { crosshair: p } });
  }
  /** The place that the check names whose ring is there, or -1. */
  private placeAt(slice: SliceView, p: Vec3): number {
    const {
        document: { state },
        scene: { layers },
      } = this.app.store.get(),
      at = slice.toPixel(p);
    if (!layers.places) return -1;
    const there = missingPlaces(state).find(({ place }) => {
      const ring = slice.toPixel(place.position);
      return (
        Math.abs(ring.depth) < placeReach(place) && Math.hypot(ring.x - at.x, ring.y - at.y) <= kPlaceRing
      );
    });
    return there?.index ?? -1;
  }
  dragInSlice(slice: SliceView, p: Vec3): void {
    if (this.hand.drag(p, slice)) return;
    if (this.tool === "navigate" || this.tool === "probe") goTo(this.app, p);
  }
  /** The pointer moves without a button. */
  hoverInSlice(slice: SliceView, p: Vec3): void {
    if (this.tool === "brush") this.hand.brush.show(p, slice);
  }
  leaveSlice(): void {
    if (this.tool === "brush") this.hand.brush.hide();
  }
  /** True: the turn was used. */
  wheelInSlice(slice: SliceView, p: Vec3, way: number): boolean {
    if (this.tool !== "brush" || way === 0) return false;
    this.hand.brush.grow(p, way);
    this.hand.brush.show(p, slice);
    return true;
  }
  releaseInSlice(slice: SliceView): void {
    if (this.hand.release() || this.tool !== "navigate") return;
    const view = this.app.store.get(); // a click on a vessel selects it
    const tree = shownTree(view);
    if (tree === null) return;
    const node = tree.nearest(view.slices.crosshair, b => isShown(view, b));
    if (node < 0) return;
    const away = length(sub(tree.position(node), view.slices.crosshair));
    if (away <= 1.15 * tree.radius[node]) {
      select(this.app, tree.branch[node]);
      if (view.slices.planes !== "vessel") this.app.store.set({ selection: { node } });
    }
    this.app.stage.invalidate(slice);
  }

  // ---- pointer without a button: the probe

  hover(p: Vec3): void {
    this.schedule(() => {
      const answer = probe(this.app.store.get(), p);
      for (const listener of this.listeners) listener(answer);
    });
  }
  leave(): void {
    this.schedule(() => {
      for (const listener of this.listeners) listener(null);
    });
  }
  private schedule(call: () => void): void {
    // once a frame
    const scheduled = this.pending !== null;
    this.pending = call;
    if (!scheduled)
      requestAnimationFrame(() => {
        const last = this.pending;
        this.pending = null;
        last?.();
      });
  }

  // ---- 3D

  /** The first thing on the ray through a pixel: a seed, a place that the check names, or a wall. */
  pick(scene: SceneView, x: number, y: number): Picked | null {
    const view = this.app.store.get(),
      { camera } = scene,
      marks = this.pickMark(scene, x, y);
    const beyond = (p: Vec3): boolean => !isCutAway(view, p);
    const shown = (b: number): boolean => b < 0 || (isShown(view, b) && opacityOf(view, b) > 0.05);
    const hit =
      view.document.surface !== null && view.scene.layers.surface && !view.scene.layers.nodes
        ? view.document.surface.pick(camera.ray(x, y), shown, beyond)
        : this.pickTube(scene, x, y);
    if (marks !== null && (hit === null || marks.distance < hit.distance + 3)) return marks;
    return hit === null ? null : { ...hit, seed: null, place: -1 };
  }

  private pickMark(scene: SceneView, x: number, y: number): Picked | null {
    const view = this.app.store.get(),
      kReachPixels = 10; // pixels
    let best: Picked | null = null,
      least = kReachPixels;
    const consider = (p: Vec3, seed: string | null, place: number): void => {
      const at = scene.camera.project(p),
        away = at === null ? Infinity : Math.hypot(at.x - x, at.y - y);
      if (away >= least) return;
      least = away;
      best = {
        part: -1,
        branch: -1,
        point: p,
        distance: length(sub(p, scene.camera.eye)),
        vertex: -1,
        node: -1,
        seed,
        place,
      };
    };
    if (view.scene.layers.seeds)
      for (const seed of view.document.state.seeds)
        if (!seed.tracked) for (const point of seed.points) consider(point.position, seed.label, -1);
    if (view.scene.layers.places)
      for (const { place, index, item } of missingPlaces(view.document.state))
        if (item === view.selection.place) consider(place.position, null, index); // it alone has a ball
    return best;
  }

  /** The node whose ball a ray passes nearest the eye: where there is no surface. */
  private pickTube(scene: SceneView, x: number, y: number): Hit | null {
    const view = this.app.store.get(),
      tree = shownTree(view);
    if (tree === null || scene.camera.flight !== null) return null;
    const ray = scene.camera.ray(x, y),
      o = ray.origin.toArray() as Vec3,
      d = ray.direction.toArray() as Vec3,
      loose = 3 * scene.camera.mmPerPixel;
    let best: Hit | null = null;
    for (let i = 0; i < tree.count; ++i) {
      if (!isShown(view, tree.branch[i])) continue;
      const c = sub(tree.position(i), o),
        t = dot(c, d);
      if (
        t > 0 &&
        length(cross(c, d)) < Math.max(tree.radius[i], loose) &&
        (best === null || t < best.distance)
      )
        best = {
          part: -1,
          branch: tree.branch[i],
          point: along(o, d, t - tree.radius[i]),
          distance: t,
          vertex: -1,
          node: i,
        };
    }
    return best;
  }

  clickInScene(scene: SceneView, x: number, y: number, clicks: number): void {
    const hit = this.pick(scene, x, y);
    if (hit !== null && hit.place >= 0) {
      this.hand.takePlace(hit.place);
      return;
    }
    if (this.tool !== "navigate" && this.tool !== "probe") {
      const p = hit?.point ?? this.brightest(scene, x, y);
      if (p !== null && this.hand.press(p, null, hit)) {
        this.hand.release();
        return;
      }
      if (p === null) {
        this.app.inform(
          "Nothing is drawn there: click on a vessel, or on something bright of the projection.",
          "warning",
        );
        return;
      }
    }
    if (hit === null) {
      const p = this.app.store.get().scene.cast === "off" ? null : this.brightest(scene, x, y);
      if (p !== null) goTo(this.app, p);
      else if (clicks === 1) select(this.app, -1);
      return;
    }
    if (hit.branch >= 0) {
      select(this.app, hit.branch);
      const tree = shownTree(this.app.store.get());
      if (tree !== null && hit.node < tree.count && hit.node >= 0 && tree.branch[hit.node] === hit.branch)
        goToNode(this.app, hit.node);
      else if (tree !== null)
        goToNode(
          this.app,
          tree.nearest(hit.point, b => b === hit.branch),
        );
    } else goTo(this.app, hit.point);
  }

  /** The brightest place along the ray through a pixel, where a projection has its light from; null if the window shows
   * it black. What the clip plane cuts away does not count. */
  brightest(scene: SceneView, x: number, y: number): Vec3 | null {
    const view = this.app.store.get(),
      {
        document: { volume },
        slices: { window },
      } = view;
    if (volume === null) return null;
    const ray = scene.camera.ray(x, y),
      o = ray.origin.toArray() as Vec3,
      d = ray.direction.toArray() as Vec3,
      step = Math.min(...volume.spacing) / 2;
    const corners = volume.corners().map(c => dot(sub(c, o), d)),
      from = Math.max(0, Math.min(...corners)),
      to = Math.max(...corners);
    let most = window[0] + kVisible * (window[1] - window[0]),
      best: Vec3 | null = null;
    for (let t = from; t < to; t += step) {
      const p = along(o, d, t),
        v = volume.sample(p);
      if (v > most && !isCutAway(view, p)) {
        most = v;
        best = p;
      }
    }
    return best;
  }

  hoverScene(scene: SceneView, x: number, y: number): void {
    this.schedule(() => {
      const hit = this.pick(scene, x, y);
      const answer =
        hit === null || hit.branch < -1
          ? null
          : probe(this.app.store.get(), hit.point, hit.node >= 0 ? hit.node : undefined);
      for (const listener of this.listeners) listener(answer);
      scene.element.classList.toggle("over-vessel", hit !== null);
    });
  }

  centreInScene(scene: SceneView, x: number, y: number): void {
    const hit = this.pick(scene, x, y);
    if (hit === null) {
      scene.fit();
      return;
    }
    scene.camera.target = hit.point;
    scene.moved();
  }

  wheelInScene(direction: number): boolean {
    if (!this.flight.running) return false;
    this.flight.step(-direction);
    return true;
  }
  keyInScene(key: string): boolean {
    return this.flight.key(key) || (key === " " && playOrPause(this.app));
  }
}
