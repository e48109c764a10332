// SPDX-License-Identifier: Apache-2.0
/** A flight along the centerline inside of the lumen, from the root to the end of the selected vessel. */
import type { CursorPart } from "../model/model";
import { goToRest } from "../model/posing";
import type { SceneView } from "./scene_view";
import type { Vec3 } from "../base/types";
import { across, cross, distance, dot, mix, scale, sub, unit } from "../base/vec";

/** Points of a way, smoothed a little, with their distance from its begin. */
interface FlightPath {
  points: Vec3[];
  nodes: number[];
  at: number[];
}

export function makeFlightPath(points: Vec3[], nodes: number[]): FlightPath {
  const smooth = points.map((p, i): Vec3 => {
    if (i === 0 || i === points.length - 1) return p;
    return mix(p, mix(points[i - 1], points[i + 1], 0.5), 0.5);
  });
  const at = [0];
  for (let i = 1; i < smooth.length; ++i) at.push(at[i - 1] + distance(smooth[i - 1], smooth[i]));
  return { points: smooth, nodes, at };
}

/** Index of the last point that lies before `s` mm, and the share of the way to the next. */
export function locate(path: FlightPath, s: number): { i: number; share: number } {
  let low = 0,
    high = path.at.length - 1;
  while (high - low > 1) {
    const half = (low + high) >> 1;
    if (path.at[half] <= s) low = half;
    else high = half;
  }
  const span = path.at[high] - path.at[low];
  return { i: low, share: span > 0 ? Math.min(1, Math.max(0, (s - path.at[low]) / span)) : 0 };
}
export function pointAt(path: FlightPath, s: number): Vec3 {
  const { i, share } = locate(path, s);
  return mix(path.points[i], path.points[Math.min(i + 1, path.points.length - 1)], share);
}

const kSpeed = 6; // local radii a second to begin with
const kFadePerRadius = 0.07; // of the light, for a local radius of distance
const kAhead = 2.5; // of the local radius: where the eye looks
const kMostStep = 0.1; // s; a page that was asleep does not leap

export class Flight {
  private path: FlightPath | null = null;
  private s = 0;
  private speed = kSpeed;
  private playing = false;
  private last = 0;
  private up: Vec3 = [0, 0, 1];
  onChange: (() => void) | null = null;

  constructor(
    private readonly app: CursorPart<never, "stage" | "inform">,
    private readonly scene: SceneView,
  ) {
    app.store.watch(["document.tree"], () => {
      if (this.running) this.stop();
    });
    app.store.watch(["motion.time"], ({ motion: { time } }) => {
      if (time !== null && this.running) this.stop(); // its way is that of the vessel at rest
    });
  }

  get running(): boolean {
    return this.path !== null;
  }
  get share(): number {
    return this.path === null ? 0 : this.s / (this.path.at.at(-1)! || 1);
  }

  start(): void {
    const {
      document: { tree },
      selection: { selected, node },
    } = this.app.store.get();
    if (tree === null || selected < 0) {
      this.app.inform("Select the vessel to fly into first.", "warning");
      return;
    }
    goToRest(this.app);
    const nodes = tree.pathTo(selected);
    if (nodes.length < 3) {
      this.app.inform("This vessel is too short for a flight.", "warning");
      return;
    }
    this.path = makeFlightPath(
      nodes.map(n => tree.position(n)),
      nodes,
    );
    const begin = nodes.indexOf(node);
    this.s = begin > 0 && begin < nodes.length - 3 ? this.path.at[begin] : 0;
    this.up = across(unit(sub(this.path.points[1], this.path.points[0])));
    this.playing = true;
    this.last = 0;
    this.show();
    this.run();
  }
  stop(): void {
    this.path = null;
    this.playing = false;
    this.scene.camera.flight = null;
    this.app.stage.invalidate(this.scene);
    this.onChange?.();
  }
  pause(): void {
    this.playing = !this.playing;
    this.last = 0;
    if (this.playing) this.run();
    this.onChange?.();
  }
  /** To a share of the way, or by millimetres. */
  seek(share: number): void {
    if (this.path !== null) {
      this.s = share * this.path.at.at(-1)!;
      this.show();
    }
  }
  step(count: number): void {
    if (this.path === null) return;
    this.s = Math.min(this.path.at.at(-1)!, Math.max(0, this.s + count));
    this.show();
  }
  key(key: string): boolean {
    if (!this.running) return false;
    switch (key) {
      case "ArrowUp":
        this.step(1);
        return true;
      case "ArrowDown":
        this.step(-1);
        return true;
      case " ":
        this.pause();
        return true;
      case "+":
        this.speed *= 1.4;
        return true;
      case "-":
        this.speed /= 1.4;
        return true;
      case "Escape":
        this.stop();
        return true;
      default:
        return false;
    }
  }

  private run(): void {
    if (!this.playing || this.path === null) return;
    requestAnimationFrame(now => {
      if (!this.playing || this.path === null) return;
      const dt = this.last === 0 ? 0 : Math.min(kMostStep, (now - this.last) / 1000);
      this.last = now;
      this.s += this.speed * dt * this.radiusHere();
      const end = this.path.at.at(-1)!;
      if (this.s >= end) {
        this.s = end;
        this.playing = false;
      }
      this.show();
      this.run();
    });
  }

  private radiusHere(): number {
    const { tree } = this.app.store.get().document;
    return this.path === null || tree === null
      ? 1
      : tree.radius[this.path.nodes[locate(this.path, this.s).i]];
  }

  private show(): void {
    const { tree } = this.app.store.get().document;
    if (this.path === null || tree === null) return;
    const { i } = locate(this.path, this.s),
      node = this.path.nodes[i],
      r = tree.radius[node],
      end = this.path.at.at(-1)!;
    const eye = pointAt(this.path, this.s),
      ahead = pointAt(this.path, Math.min(end, this.s + kAhead * r));
    let d = sub(ahead, eye);
    if (dot(d, d) < 1e-8) d = sub(eye, pointAt(this.path, Math.max(0, this.s - r)));
    d = unit(d);
    // the up vector is carried along without turning about the way
    this.up = unit(sub(this.up, scale(d, dot(this.up, d))));
    if (!Number.isFinite(this.up[0])) this.up = unit(cross(d, across(d)));
    this.scene.camera.flight = {
      eye,
      ahead: [eye[0] + d[0], eye[1] + d[1], eye[2] + d[2]],
      up: this.up,
      fade: kFadePerRadius / r,
    };
    this.app.store.set({ slices: { crosshair: eye }, selection: { node } });
    this.app.stage.invalidate(this.scene);
    this.onChange?.();
  }
}
