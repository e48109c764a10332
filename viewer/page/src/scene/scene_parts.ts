// SPDX-License-Identifier: Apache-2.0
/** Parts of the 3D view besides the surface: centerlines, wall points, balls. */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  GLSL3,
  LineSegments,
  Mesh,
  Points,
  ShaderMaterial,
  SphereGeometry,
} from "three";
import { colourOf, isShown, shownTree, type View } from "../model/model";
import { kNoClip, PartMaterial } from "./part_material";
import type { Vec3 } from "../base/types";

/** The centerlines of branches that are shown, each in its colour. */
export function centerlines(view: Pick<View, "document" | "selection" | "motion" | "scene">): LineSegments {
  const tree = shownTree(view)!,
    position: number[] = [],
    colour: number[] = [],
    one = new Color(),
    inside = view.scene.layers.surface || view.scene.layers.nodes;
  for (const branch of tree.branches) {
    if (!isShown(view, branch.index)) continue;
    const nodes = tree.nodesOf(branch);
    one
      .setRGB(...colourOf(view, branch.index))
      .lerp(new Color(1, 1, 1), 0.25)
      .convertLinearToSRGB();
    for (let i = 1; i < nodes.length; ++i) {
      position.push(...tree.position(nodes[i - 1]), ...tree.position(nodes[i]));
      colour.push(one.r, one.g, one.b, one.r, one.g, one.b);
    }
  }
  for (let k = 0; k + 1 < tree.links.length; k += 2) {
    position.push(...tree.position(tree.links[k]), ...tree.position(tree.links[k + 1]));
    colour.push(1, 1, 1, 1, 1, 1);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(position), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colour), 3));
  const lines = new LineSegments(geometry, lineMaterial(inside));
  lines.renderOrder = 10;
  lines.frustumCulled = false;
  return lines;
}

/** Wall points, drawn as squares of a few pixels. */
export function wallPoints(view: Pick<View, "document" | "selection" | "motion">): Points | null {
  const tree = shownTree(view)!;
  if (tree.point === null || tree.pointOffset === null) return null;
  const colour = new Uint8Array(tree.point.length),
    kept: number[] = [];
  for (let i = 0; i < tree.count; ++i) {
    const branch = tree.branch[i],
      rgb = colourOf(view, branch).map(x => Math.round(255 * x));
    const shown = isShown(view, branch);
    for (let k = tree.pointOffset[i]; k < tree.pointOffset[i + 1]; ++k) {
      colour.set(rgb, 3 * k);
      if (shown) kept.push(k);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(tree.point, 3));
  geometry.setAttribute("color", new BufferAttribute(colour, 3, true));
  geometry.setIndex(new BufferAttribute(new Uint32Array(kept), 1));
  const points = new Points(geometry, pointMaterial());
  points.frustumCulled = false;
  return points;
}

function pointMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    uniforms: { clip: { value: kNoClip.clone() } },
    vertexColors: true,
    vertexShader:
      "out vec3 tint; out vec3 here; void main() { tint = color; here = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); gl_PointSize = 1.6; }",
    fragmentShader:
      "precision highp float; in vec3 tint; in vec3 here; out vec4 result; uniform vec4 clip; void main() { if (dot(clip.xyz, here) + clip.w > 0.0) discard; result = vec4(tint, 1.0); }",
  });
}

/** The same colours on the screen and in a picture that is drawn beside it. */
function lineMaterial(depthTest: boolean): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexColors: true,
    transparent: true,
    depthTest,
    vertexShader:
      "out vec3 tint; void main() { tint = color; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
    fragmentShader:
      "precision highp float; in vec3 tint; out vec4 result; void main() { result = vec4(tint, 0.95); }",
  });
}

export function ball(p: Vec3, radius: number, colour: [number, number, number], alpha = 1): Mesh {
  const material = new PartMaterial(false),
    mesh = new Mesh(new SphereGeometry(radius, 18, 12), material);
  material.look({ own: colour, alpha });
  mesh.position.set(...p);
  mesh.renderOrder = 5;
  return mesh;
}
