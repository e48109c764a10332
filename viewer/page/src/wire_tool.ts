// SPDX-License-Identifier: Apache-2.0
/** The guidewire in hand: pushed and turned by the pointer or keys, at sixty steps a second. */
import type { App } from "./model";
import type { SceneView } from "./scene_view";
import { wirePoints } from "./slice_overlay";
import { kWire, Wire } from "./wire";
import type { Vec3 } from "./types";
import { scale, unit } from "./vec";

const kSettle = 45; // steps after the last push
const kPush = 0.25; // mm for a pixel; per step no more than half a spacing
const kMostPush = 0.3; // spacings in a step
const kMostAhead = 4; // spacings that keys may ask for ahead of it
const kStep = 1000 / 60; // ms of a step
const kMostSteps = 4; // that a late frame makes up for
const kTurn = 0.02; // radians for a pixel

export class WireTool {
  private wire: Wire | null = null;
  private wanted = 0;
  private turn = 0;
  private rest = 0;
  private last: { x: number; y: number } | null = null;
  private running = false;
  private before = 0; // time of the last frame
  onChange: (() => void) | null = null;
  /** Milliseconds that the last step took. */
  cost = 0;
  options = { ...kWire };

  constructor(private readonly app: App) {
    app.store.watch(["blob"], () => this.remove());
  }

  get active(): boolean {
    return this.wire !== null;
  }
  get now(): Wire | null {
    return this.wire;
  }

  /** Places the wire at the root of the selected vessel's tree, or of the first one. */
  place(): void {
    const { tree, blob, selected } = this.app.store.get();
    if (tree === null || blob === null) {
      this.app.inform("The wire needs a case with models: fit it first.", "warning");
      return;
    }
    this.remove();
    const path = tree.pathTo(Math.max(0, selected)),
      root = path[0],
      next = path[Math.min(3, path.length - 1)];
    const from = tree.position(root),
      to = tree.position(next);
    const d: Vec3 =
      next === root ? tree.axis(root) : unit([to[0] - from[0], to[1] - from[1], to[2] - from[2]]);
    const all = path.length > 1 ? tree.rootDistance[path.at(-1)!] : 50;
    const spacing = Math.max(0.5, Math.min(4, (1.15 * all) / kWire.count), 0.25 * tree.radius[root]);
    const thin = Math.min(...path.map(n => tree.radius[n]));
    this.options = { ...this.options, spacing, radius: Math.min(0.35 * Math.max(thin, 0.1), 0.5) };
    this.wire = new Wire(blob, [from[0], from[1], from[2]], scale(d, 1), root, this.options);
    this.rest = kSettle;
    this.run();
  }
  remove(): void {
    if (this.wire !== null && this.app.store.get().blob !== null) this.wire.close();
    this.wire = null;
    wirePoints.points = null;
    this.app.stage.invalidateOver();
    this.onChange?.();
  }

  /** By keys and wheel. A key that is held down asks for more than the wire can do: it stops soon after the key does, and turns back at once. */
  push(steps: number): void {
    const asked = steps * this.options.spacing * 2,
      most = kMostAhead * this.options.spacing;
    if (asked * this.wanted < 0) this.wanted = 0;
    this.wanted = Math.min(most, Math.max(-most, this.wanted + asked));
    this.wake();
  }
  twist(radians: number): void {
    this.turn += radians;
    this.wake();
  }
  key(key: string): boolean {
    if (key === "Enter" && this.wire === null) {
      this.place();
      return true;
    }
    if (this.wire === null) return false;
    switch (key) {
      case "ArrowUp":
        this.push(1);
        return true;
      case "ArrowDown":
        this.push(-1);
        return true;
      case "ArrowLeft":
        this.twist(-0.2);
        return true;
      case "ArrowRight":
        this.twist(0.2);
        return true;
      case "Delete":
      case "Escape":
        this.remove();
        return true;
      default:
        return false;
    }
  }

  /** Whether a pointer that is pressed there takes hold of the wire. */
  isNear(scene: SceneView, x: number, y: number): boolean {
    const kReachPixels = 24; // pixels
    return this.wire !== null && this.nearest(this.wire, scene, x, y).away < kReachPixels;
  }
  grab(scene: SceneView, x: number, y: number): boolean {
    this.last = this.isNear(scene, x, y) ? { x, y } : null;
    if (this.last !== null) this.wanted = this.turn = 0; // a hand that holds it stops it
    return this.last !== null;
  }
  /** The point of the wire that a pixel is nearest to, and how far that is. */
  private nearest(wire: Wire, scene: SceneView, x: number, y: number): { point: number; away: number } {
    let best = { point: 0, away: Infinity };
    for (let i = 0; i < wire.free; ++i) {
      const p = scene.camera.project(wire.at(i)),
        away = p === null ? Infinity : Math.hypot(p.x - x, p.y - y);
      if (away < best.away) best = { point: i, away };
    }
    return best;
  }
  /** Along the wire where it is held: pushes; across: turns. */
  dragTo(scene: SceneView, x: number, y: number): void {
    const { wire } = this;
    if (this.last === null || wire === null) return;
    const kAround = 4,
      { point } = this.nearest(wire, scene, this.last.x, this.last.y),
      dx = x - this.last.x,
      dy = y - this.last.y;
    const ahead = scene.camera.project(wire.at(Math.max(0, point - kAround))),
      behind = scene.camera.project(wire.at(Math.min(wire.options.count - 1, point + kAround)));
    let ux = 0,
      uy = -1;
    if (ahead !== null && behind !== null && Math.hypot(ahead.x - behind.x, ahead.y - behind.y) > 2) {
      const n = Math.hypot(ahead.x - behind.x, ahead.y - behind.y);
      ux = (ahead.x - behind.x) / n;
      uy = (ahead.y - behind.y) / n;
    }
    this.wanted += (dx * ux + dy * uy) * Math.max(kPush, scene.camera.mmPerPixel);
    this.turn += (dx * -uy + dy * ux) * kTurn;
    this.last = { x, y };
    this.wake();
  }
  letGo(): void {
    this.last = null;
  }

  private wake(): void {
    this.rest = kSettle;
    this.run();
  }
  private run(): void {
    if (this.running || this.wire === null) return;
    this.running = true;
    requestAnimationFrame(() => {
      this.running = false;
      if (this.wire === null) return;
      const begin = performance.now(),
        due = Math.round((begin - this.before) / kStep),
        steps = this.before === 0 ? 1 : Math.min(kMostSteps, Math.max(1, due));
      this.before = begin;
      let moved = false;
      for (let k = 0; k < steps; ++k) moved = this.advance(this.wire) || moved;
      this.cost = (performance.now() - begin) / steps;
      wirePoints.points = this.wire.x;
      wirePoints.radius = this.options.radius;
      this.app.stage.invalidateOver();
      this.onChange?.();
      if (moved) this.rest = kSettle;
      if (--this.rest > 0) this.run();
      else this.before = 0;
    });
  }

  /** One step with a part of what is wanted; false: nothing is. */
  private advance(wire: Wire): boolean {
    const most = kMostPush * this.options.spacing,
      push = Math.min(most, Math.max(-most, this.wanted)),
      turn = Math.min(0.1, Math.max(-0.1, this.turn));
    this.wanted -= push;
    this.turn -= turn;
    wire.step(push, turn);
    return push !== 0 || turn !== 0;
  }
}
