// SPDX-License-Identifier: Apache-2.0
/** One plane through the volume, drawn on the whole viewport. */
import {
  GLSL3,
  Matrix4,
  Mesh,
  OrthographicCamera,
  PlaneGeometry,
  Scene,
  ShaderMaterial,
  Vector2,
  Vector3,
  type WebGLRenderer,
} from "three";
import type { Vec3 } from "./types";
import type { Frame } from "./vec";
import type { Volume } from "./volume";
import type { VolumeTexture } from "./volume_texture";

const kVertex = `
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
void main() {
  vec3 p = (toTexture * vec4(centre + at.x * right + at.y * up, 1.0)).xyz;
  if (any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)))) { colour = vec4(0.027, 0.035, 0.047, 1.0); return; }
  if (p.z > ready) { colour = vec4(0.05, 0.06, 0.08, 1.0); return; }
  float stored = dot(texture(voxels, p).rg, channels);
  float shade = clamp((stored - window.x) / max(window.y - window.x, 1e-6), 0.0, 1.0);
  colour = vec4(vec3(shade), 1.0);
}`;

export class SliceMaterial {
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private readonly material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kVertex,
    fragmentShader: kFragment,
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
    },
  });

  constructor() {
    const quad = new Mesh(new PlaneGeometry(2, 2), this.material);
    quad.frustumCulled = false;
    this.scene.add(quad);
  }

  /** `halfWidth` and `halfHeight` in mm. */
  draw(
    renderer: WebGLRenderer,
    texture: VolumeTexture,
    plane: { centre: Vec3; frame: Frame; halfWidth: number; halfHeight: number },
    window: [number, number],
    ready: number,
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
    renderer.render(this.scene, this.camera);
  }
}
