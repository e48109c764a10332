// SPDX-License-Identifier: Apache-2.0
/** One plane through the volume, drawn on the whole viewport. */
import { WholeViewport } from "../drawing/scene_picture";
import {
  GLSL3,
  Matrix4,
  NoBlending,
  NormalBlending,
  ShaderMaterial,
  Vector2,
  Vector3,
  type WebGLRenderer,
} from "three";
import { kMostSamples, throughOf, type Slab } from "../model/slab";
import type { Vec3 } from "../base/types";
import type { Frame } from "../base/vec";
import type { Volume } from "../case/volume";
import type { VolumeTexture } from "../drawing/volume_texture";

/** Draws on the whole viewport; `at` is the place in it, in [-1, 1]. */
export const kVertex = `
out vec2 at;
void main() { at = position.xy; gl_Position = vec4(position.xy, 0.0, 1.0); }`;

const kFragment = `
precision highp float;
precision highp sampler3D;
in vec2 at;
out vec4 colour;
uniform sampler3D voxels;
uniform mat4 toTexture;
uniform vec3 centre, right, up;   // mm; right and up reach to the edge of the viewport
uniform vec2 window;              // stored numbers
uniform vec2 channels;            // 255 and 65280: stored = dot(channels, texel.rg)
uniform float ready;              // share of the slices that have arrived
uniform vec3 through;             // mm: half a slab, 0 for a plane
uniform int samples, kind;        // of a slab: places through it; 1 greatest, 2 least, 3 mean
uniform float alpha, from;        // opacity; nothing is drawn left of this place, in [-1, 1]
uniform bool warm, over;          // warm colours; over another volume, which shows where this one has no voxel
bool isOutside(vec3 p) { return any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0))); }
float storedAt(vec3 p) { return dot(texture(voxels, p).rg, channels); }
vec3 tint(float x) { return warm ? clamp(vec3(2.2 * x, 2.2 * x - 0.65, 3.2 * x - 2.2), 0.0, 1.0) : vec3(x); }
void drawNothing(vec3 ground) {
  if (over) discard;
  colour = vec4(ground, 1.0);
}
void main() {
  if (at.x < from) discard;
  vec3 p = (toTexture * vec4(centre + at.x * right + at.y * up, 1.0)).xyz;
  float stored = 0.0, count = 0.0;
  if (samples > 1) {
    vec3 most = mat3(toTexture) * through;
    for (int i = 0; i < SAMPLES; ++i) {
      if (i >= samples) break;
      vec3 q = p + (2.0 * float(i) / float(samples - 1) - 1.0) * most;
      if (isOutside(q) || q.z > ready) continue;
      float value = storedAt(q);
      stored = count == 0.0 ? value : kind == 1 ? max(stored, value) : kind == 2 ? min(stored, value) : stored + value;
      count += 1.0;
    }
    if (kind == 3) stored /= max(count, 1.0);
    if (count == 0.0) { drawNothing(vec3(0.027, 0.035, 0.047)); return; }
  } else {
    if (isOutside(p)) { drawNothing(vec3(0.027, 0.035, 0.047)); return; }
    if (p.z > ready) { drawNothing(vec3(0.05, 0.06, 0.08)); return; }
    stored = storedAt(p);
  }
  float shade = clamp((stored - window.x) / max(window.y - window.x, 1e-6), 0.0, 1.0);
  colour = vec4(tint(shade), alpha);
}`;

/** What a view shows: its middle, its axes, and half its width and height in mm. */
export interface Plane {
  centre: Vec3;
  frame: Frame;
  halfWidth: number;
  halfHeight: number;
}

/** Look of a volume that is drawn over another. */
interface Over {
  /** Opacity. */
  alpha: number;
  /** Nothing is drawn left of it; in [-1, 1] across the view. */
  from: number;
  /** Warm colours instead of grey. */
  warm: boolean;
  /** The other volume shows where this one has no voxel. */
  isSeenThrough: boolean;
}
const kAlone: Over = { alpha: 1, from: -1, warm: false, isSeenThrough: false };

export class SliceMaterial {
  private readonly material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kVertex,
    fragmentShader: kFragment,
    defines: { SAMPLES: kMostSamples },
    depthTest: false,
    depthWrite: false,
    uniforms: {
      voxels: { value: null },
      toTexture: { value: new Matrix4() },
      centre: { value: new Vector3() },
      right: { value: new Vector3() },
      up: { value: new Vector3() },
      window: { value: new Vector2() },
      channels: { value: new Vector2(255, 0) },
      ready: { value: 0 },
      through: { value: new Vector3() },
      samples: { value: 1 },
      kind: { value: 0 },
      alpha: { value: 1 },
      from: { value: -1 },
      warm: { value: false },
      over: { value: false },
    },
  });

  private readonly whole = new WholeViewport(this.material);

  /** With `over` on what the viewport has. */
  draw(
    renderer: WebGLRenderer,
    texture: VolumeTexture,
    plane: Plane,
    window: [number, number],
    ready: number,
    slab: Slab,
    samples: number,
    over: Over = kAlone,
  ): void {
    const u = this.material.uniforms,
      volume: Volume = texture.volume;
    u.voxels.value = texture.texture;
    (u.toTexture.value as Matrix4).fromArray(volume.toTexture());
    (u.centre.value as Vector3).set(...plane.centre);
    (u.right.value as Vector3).set(...plane.frame.right).multiplyScalar(plane.halfWidth);
    (u.up.value as Vector3).set(...plane.frame.up).multiplyScalar(plane.halfHeight);
    (u.window.value as Vector2).set(volume.stored(window[0]), volume.stored(window[1]));
    (u.channels.value as Vector2).set(255, volume.bytesPerVoxel === 1 ? 0 : 65280);
    u.ready.value = ready;
    (u.through.value as Vector3).set(...throughOf(slab, plane.frame));
    u.samples.value = samples;
    u.kind.value = ["off", "max", "min", "mean"].indexOf(slab.kind);
    u.alpha.value = over.alpha;
    u.from.value = over.from;
    u.warm.value = over.warm;
    u.over.value = over.isSeenThrough;
    this.material.blending = over.alpha < 1 ? NormalBlending : NoBlending;
    this.material.transparent = over.alpha < 1;
    this.whole.draw(renderer);
  }
}
