// SPDX-License-Identifier: Apache-2.0
/** The three slices as planes in the 3D view. */
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  GLSL3,
  Group,
  Matrix4,
  Mesh,
  ShaderMaterial,
  Vector2,
} from "three";
import type { View } from "../model/model";
import { frameOf, kSliceNames } from "../model/slice_frame";
import type { Vec3 } from "../base/types";
import { add, along, dot, scale, sub } from "../base/vec";
import type { VolumeTexture } from "../drawing/volume_texture";

export class SlicePlanes {
  readonly group = new Group();
  private readonly material = new ShaderMaterial({
    glslVersion: GLSL3,
    side: DoubleSide,
    vertexShader:
      "uniform mat4 toTexture; out vec3 at; void main() { at = (toTexture * vec4(position, 1.0)).xyz; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
    fragmentShader: `precision highp float; precision highp sampler3D; in vec3 at; out vec4 result; uniform sampler3D voxels; uniform vec2 window, channels;
      void main() { if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) discard;
        float x = clamp((dot(texture(voxels, at).rg, channels) - window.x) / max(window.y - window.x, 1e-6), 0.0, 1.0);
        result = vec4(vec3(x), 1.0); }`,
    uniforms: {
      toTexture: { value: new Matrix4() },
      voxels: { value: null },
      window: { value: new Vector2() },
      channels: { value: new Vector2() },
    },
  });

  update(view: Pick<View, "document" | "slices" | "scene">, texture: VolumeTexture | null): void {
    for (const child of this.group.children as Mesh[]) child.geometry.dispose();
    this.group.clear();
    const { volume } = view.document;
    if (!view.scene.layers.slices || texture === null || volume === null) return;
    const u = this.material.uniforms;
    (u.toTexture.value as Matrix4).fromArray(volume.toTexture());
    u.voxels.value = texture.texture;
    (u.window.value as Vector2).set(
      volume.stored(view.slices.window[0]),
      volume.stored(view.slices.window[1]),
    );
    (u.channels.value as Vector2).set(255, volume.bytesPerVoxel === 1 ? 0 : 65280);
    const corners = volume.corners(),
      middle = volume.centre(),
      half = Math.max(...corners.map(c => Math.hypot(...sub(c, middle))));
    for (const name of kSliceNames) {
      const f = frameOf(name, view.slices.frame),
        centre = along(middle, f.normal, dot(sub(view.slices.crosshair, middle), f.normal));
      const corner = (x: number, y: number): Vec3 =>
        add(centre, add(scale(f.right, x * half), scale(f.up, y * half)));
      const geometry = new BufferGeometry();
      geometry.setAttribute(
        "position",
        new BufferAttribute(
          new Float32Array([corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)].flat()),
          3,
        ),
      );
      geometry.setIndex([0, 1, 2, 0, 2, 3]);
      const mesh = new Mesh(geometry, this.material);
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }
}
