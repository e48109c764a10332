// SPDX-License-Identifier: Apache-2.0
/** The labels in one plane of the volume, over what the viewport has: each voxel as it is, filled or as outlines. */
import {
  DataTexture,
  GLSL3,
  Matrix4,
  NormalBlending,
  ShaderMaterial,
  Vector2,
  Vector3,
  type WebGLRenderer,
} from "three";
import { WholeViewport } from "../drawing/scene_picture";
import type { VolumeTexture } from "../drawing/volume_texture";
import type { LabelLook } from "../model/label_look";
import { kVertex, type Plane } from "./slice_material";

const kMostPlaces = 256,
  kRim = 1.5; // pixels, width of an outline within its label

const kFragment = `
precision highp float;
precision highp sampler3D;
in vec2 at;
out vec4 colour;
uniform sampler3D voxels;         // place of the label / 255
uniform sampler2D palette;        // colours of places
uniform mat4 toTexture;
uniform vec3 centre, right, up;   // mm; right and up reach to the edge of the viewport
uniform vec2 rim;                 // width of an outline, of half the viewport
uniform float ready, alpha;       // share of the slices that have arrived; opacity
uniform bool outline;
int placeAt(vec2 q) {
  vec3 p = (toTexture * vec4(centre + q.x * right + q.y * up, 1.0)).xyz;
  if (any(lessThan(p, vec3(0.0))) || any(greaterThanEqual(p, vec3(1.0))) || p.z > ready) return 0;
  return int(255.0 * texelFetch(voxels, ivec3(p * vec3(textureSize(voxels, 0))), 0).r + 0.5);
}
void main() {
  int place = placeAt(at);
  vec4 own = texelFetch(palette, ivec2(place, 0), 0);
  if (own.a == 0.0) discard;
  if (outline && placeAt(at + vec2(rim.x, 0.0)) == place && placeAt(at - vec2(rim.x, 0.0)) == place &&
      placeAt(at + vec2(0.0, rim.y)) == place && placeAt(at - vec2(0.0, rim.y)) == place)
    discard;
  colour = vec4(own.rgb, alpha);
}`;

export class LabelMaterial {
  private readonly palette = new DataTexture(new Uint8Array(4 * kMostPlaces), kMostPlaces, 1);
  private colours: Uint8Array | null = null;
  private readonly material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kVertex,
    fragmentShader: kFragment,
    depthTest: false,
    depthWrite: false,
    transparent: true,
    blending: NormalBlending,
    uniforms: {
      voxels: { value: null },
      palette: { value: this.palette },
      toTexture: { value: new Matrix4() },
      centre: { value: new Vector3() },
      right: { value: new Vector3() },
      up: { value: new Vector3() },
      rim: { value: new Vector2() },
      ready: { value: 0 },
      alpha: { value: 1 },
      outline: { value: false },
    },
  });
  private readonly whole = new WholeViewport(this.material);

  /** `size`: of the viewport, pixels; `colours`: RGBA of places. */
  draw(
    renderer: WebGLRenderer,
    texture: VolumeTexture,
    plane: Plane,
    size: [number, number],
    ready: number,
    { mode, opacity }: LabelLook,
    colours: Uint8Array,
  ): void {
    if (this.colours !== colours) {
      this.colours = colours;
      const all = this.palette.image.data as Uint8Array;
      all.fill(0);
      all.set(colours.subarray(0, all.length));
      this.palette.needsUpdate = true;
    }
    const u = this.material.uniforms;
    u.voxels.value = texture.texture;
    (u.toTexture.value as Matrix4).fromArray(texture.volume.toTexture());
    (u.centre.value as Vector3).set(...plane.centre);
    (u.right.value as Vector3).set(...plane.frame.right).multiplyScalar(plane.halfWidth);
    (u.up.value as Vector3).set(...plane.frame.up).multiplyScalar(plane.halfHeight);
    (u.rim.value as Vector2).set((2 * kRim) / size[0], (2 * kRim) / size[1]);
    u.ready.value = ready;
    u.alpha.value = mode === "outline" ? Math.sqrt(opacity) : opacity; // lines are fainter than areas
    u.outline.value = mode === "outline";
    this.whole.draw(renderer);
  }
}
