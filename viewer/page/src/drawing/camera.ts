// SPDX-License-Identifier: Apache-2.0
/** The camera of the 3D view: turns about a point with the head upwards, moves and comes nearer. */
import { OrthographicCamera, PerspectiveCamera, Raycaster, Vector2, Vector3, type Ray } from "three";
import type { Vec3 } from "../base/types";
import { add, along, cross, dot, scale, sub } from "../base/vec";

const kAngle = 30; // degrees of the vertical field of view: little perspective, so sizes can be compared
const kMargin = 1.08; // of what is shown as a whole

export class OrbitCamera {
  private readonly perspective = new PerspectiveCamera(kAngle, 1, 0.1, 5000);
  private readonly parallel = new OrthographicCamera(-1, 1, 1, -1, 0.1, 5000);
  target: Vec3 = [0, 0, 0];
  distance = 300;
  /** Radians: about the head's axis, 0 looks from the front; and upwards. */
  azimuth = 0;
  elevation = 0;
  isParallel = false;
  /** While set, the view is that of a flight: eye, where to, up, and how the light fades, 1/mm. */
  flight: { eye: Vec3; ahead: Vec3; up: Vec3; fade: number } | null = null;
  width = 1;
  height = 1;
  private reach = 500;

  get camera(): PerspectiveCamera | OrthographicCamera {
    return this.isParallel && this.flight === null ? this.parallel : this.perspective;
  }
  /** From the target to the eye. */
  get back(): Vec3 {
    const c = Math.cos(this.elevation);
    return [c * Math.sin(this.azimuth), -c * Math.cos(this.azimuth), Math.sin(this.elevation)];
  }
  get right(): Vec3 {
    return [Math.cos(this.azimuth), Math.sin(this.azimuth), 0];
  }
  get up(): Vec3 {
    return cross(this.back, this.right);
  }
  get eye(): Vec3 {
    return this.flight?.eye ?? along(this.target, this.back, this.distance);
  }
  get mmPerPixel(): number {
    return (2 * this.distance * Math.tan((kAngle * Math.PI) / 360)) / Math.max(this.height, 1);
  }

  /** Shows a box as a whole, as it is seen from here. */
  fit(low: Vec3, high: Vec3): void {
    this.target = scale(add(low, high), 0.5);
    const radius = Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2 || 1;
    const slope = Math.tan((kAngle * Math.PI) / 360),
      aspect = this.width / Math.max(this.height, 1);
    this.reach = 2 * radius;
    this.distance = 0;
    for (let k = 0; k < 8; ++k) {
      const corner = sub([0, 1, 2].map(a => (((k >> a) & 1) === 1 ? high[a] : low[a])) as Vec3, this.target);
      const across = Math.max(Math.abs(dot(corner, this.up)), Math.abs(dot(corner, this.right)) / aspect);
      this.distance = Math.max(this.distance, (kMargin * across) / slope + dot(corner, this.back));
    }
  }

  update(width: number, height: number): PerspectiveCamera | OrthographicCamera {
    this.width = width;
    this.height = height;
    const camera = this.camera,
      eye = new Vector3(...this.eye);
    if (camera instanceof PerspectiveCamera) {
      camera.fov = this.flight === null ? kAngle : 80;
      camera.aspect = width / height;
      camera.near =
        this.flight === null ? Math.max(this.distance - this.reach, this.distance / 200, 0.02) : 0.02;
    } else {
      const h = (this.mmPerPixel * height) / 2;
      camera.top = h;
      camera.bottom = -h;
      camera.right = (h * width) / height;
      camera.left = -camera.right;
      camera.near = this.distance - this.reach;
    }
    camera.far = this.distance + this.reach;
    camera.position.copy(eye);
    camera.up.set(...(this.flight?.up ?? this.up));
    camera.lookAt(new Vector3(...(this.flight?.ahead ?? this.target)));
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return camera;
  }

  turn(dx: number, dy: number): void {
    this.azimuth -= dx;
    this.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.elevation + dy));
  }
  pan(dx: number, dy: number): void {
    const s = this.mmPerPixel;
    this.target = along(along(this.target, this.right, -dx * s), this.up, dy * s);
  }
  /** Nearer (below 1) or farther; keeps the point under the pointer in place. */
  zoom(factor: number, x = this.width / 2, y = this.height / 2): void {
    const s = this.mmPerPixel * (1 - factor),
      dx = x - this.width / 2,
      dy = this.height / 2 - y;
    this.target = along(along(this.target, this.right, dx * s), this.up, dy * s);
    this.distance = Math.min(20 * this.reach, Math.max(0.5, this.distance * factor));
  }
  /** Looks from a side of the patient. */
  lookFrom(side: "A" | "P" | "L" | "R" | "S" | "I"): void {
    const quarter = Math.PI / 2;
    this.azimuth = { A: 0, L: quarter, P: 2 * quarter, R: -quarter, S: 0, I: 0 }[side];
    this.elevation = { A: 0, L: 0, P: 0, R: 0, S: quarter, I: -quarter }[side];
  }

  ray(x: number, y: number): Ray {
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2((2 * x) / this.width - 1, 1 - (2 * y) / this.height), this.camera);
    return caster.ray;
  }
  /** Pixel of a position, and how far in front of the target's plane it is; null behind the eye. */
  project(p: Vec3): { x: number; y: number; depth: number } | null {
    const v = new Vector3(...p).project(this.camera);
    if (v.z > 1 || v.z < -1) return null;
    return { x: ((v.x + 1) * this.width) / 2, y: ((1 - v.y) * this.height) / 2, depth: 0 };
  }
}
