// SPDX-License-Identifier: Apache-2.0
/** The picture of a view, made beside the canvas: smooth edges where it rests, and fewer pixels while it moves on a
 * machine without a graphics processor. The 3D view alone pays for smooth edges, not the whole canvas. */
import {
  GLSL3,
  LinearFilter,
  Mesh,
  NoBlending,
  OrthographicCamera,
  PlaneGeometry,
  RGBAFormat,
  Scene,
  ShaderMaterial,
  WebGLRenderTarget,
  type Texture,
  type WebGLRenderer,
} from "three";

const kCoarse = 0.5, // share of the pixels along an edge, while the scene moves
  kSamples = 4; // of a pixel, where it rests

function makeTarget(samples: number): WebGLRenderTarget {
  return new WebGLRenderTarget(1, 1, {
    format: RGBAFormat,
    minFilter: LinearFilter,
    magFilter: LinearFilter,
    samples,
  });
}

/** The vertex shader of a picture over the whole viewport; `at`, in [0, 1], is where its texture is read. */
export const kWholePicture =
  "out vec2 at; void main() { at = 0.5 + 0.5 * position.xy; gl_Position = vec4(position.xy, 0.0, 1.0); }";

/** Draws one material over the whole viewport. */
export class WholeViewport {
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);

  constructor(material: ShaderMaterial) {
    const quad = new Mesh(new PlaneGeometry(2, 2), material);
    quad.frustumCulled = false;
    this.scene.add(quad);
  }

  draw(renderer: WebGLRenderer): void {
    renderer.render(this.scene, this.camera);
  }
}

export class ScenePicture {
  private readonly fine = makeTarget(kSamples);
  private readonly coarse = makeTarget(0);
  private readonly shown: { value: Texture | null } = { value: null };
  private readonly copy = new WholeViewport(
    new ShaderMaterial({
      glslVersion: GLSL3,
      depthTest: false,
      depthWrite: false,
      blending: NoBlending,
      vertexShader: kWholePicture,
      fragmentShader:
        "precision highp float; in vec2 at; out vec4 result; uniform sampler2D picture; void main() { result = vec4(texture(picture, at).rgb, 1.0); }",
      uniforms: { picture: this.shown },
    }),
  );

  /** Makes a picture of that size in CSS pixels, on the ground that the renderer clears with, and copies it onto the
   * viewport of the canvas. */
  draw(renderer: WebGLRenderer, size: [number, number], coarse: boolean, draw: () => void): void {
    const target = coarse ? this.coarse : this.fine,
      [width, height] = size.map(n =>
        Math.max(1, Math.round(n * renderer.getPixelRatio() * (coarse ? kCoarse : 1))),
      );
    target.setSize(width, height);
    renderer.setRenderTarget(target);
    renderer.clear();
    draw();
    renderer.setRenderTarget(null);
    this.shown.value = target.texture;
    this.copy.draw(renderer);
  }
}
