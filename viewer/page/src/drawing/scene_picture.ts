// SPDX-License-Identifier: Apache-2.0
/** The picture of a view, made beside the canvas: smooth edges where it rests, and fewer pixels while it moves on a
 * machine without a graphics processor. The 3D view alone pays for smooth edges, not the whole canvas. What is chosen has a
 * picture of its own, which is laid over that of all with an outline, also where others hide it. */
import {
  DepthTexture,
  GLSL3,
  LinearFilter,
  Mesh,
  NoBlending,
  OrthographicCamera,
  PlaneGeometry,
  RGBAFormat,
  Scene,
  ShaderMaterial,
  Vector2,
  WebGLRenderTarget,
  type WebGLRenderer,
} from "three";

const kCoarse = 0.5, // share of the pixels along an edge, while the scene moves
  kSamples = 4; // of a pixel, where it rests

/** Pictures of all and of what is chosen, each with its depths. */
interface Targets {
  all: WebGLRenderTarget;
  chosen: WebGLRenderTarget;
}

function makeTargets(samples: number): Targets {
  const make = (): WebGLRenderTarget =>
    new WebGLRenderTarget(1, 1, {
      format: RGBAFormat,
      minFilter: LinearFilter,
      magFilter: LinearFilter,
      depthTexture: new DepthTexture(1, 1),
      samples,
    });
  return { all: make(), chosen: make() };
}

// how a choice stands out: shares of its own colour where others hide it, and of that of the others
const kThrough = 0.55,
  kFaint = 0.5,
  kRim = 1.5, // CSS pixels of the outline
  kGlow = 5; // CSS pixels of the glow around it

/** Copies the picture of all; where something is chosen, that over it, which is stored premultiplied. */
const kCopy = `
precision highp float;
in vec2 at;
out vec4 result;
uniform sampler2D picture, chosen, depth, chosenDepth;
uniform float isChosen, rest;
uniform vec2 pixel;   // of CSS, in [0, 1]
float around(float r) {
  float most = 0.0;
  for (int k = 0; k < 8; ++k) {
    float angle = 0.7853982 * float(k);
    most = max(most, texture(chosen, at + r * pixel * vec2(cos(angle), sin(angle))).a);
  }
  return most;
}
void main() {
  vec3 colour = texture(picture, at).rgb;
  if (isChosen > 0.5) {
    vec4 own = texture(chosen, at);
    float hidden = step(texture(depth, at).r + 1e-4, texture(chosenDepth, at).r);
    float share = mix(1.0, ${kThrough}, hidden);
    colour = colour * rest * (1.0 - own.a * share) + own.rgb * share;
    float outside = 1.0 - own.a;
    colour = mix(colour, vec3(1.0), outside * (0.2 * around(${kGlow.toFixed(1)}) + 0.6 * around(${kRim.toFixed(1)})));
  }
  result = vec4(colour, 1.0);
}`;

/** What a picture shows. */
export interface Drawn {
  /** Draws all; null: the picture before is kept. */
  all: (() => void) | null;
  /** Draws what is chosen alone, on a ground without colour; null: nothing is. */
  chosen?: (() => void) | null;
  /** Whether all else is faint beside it. */
  isRestFaint?: boolean;
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
  private readonly fine = makeTargets(kSamples);
  private readonly coarse = makeTargets(0);
  private shown: Targets | null = null;
  private readonly uniforms = {
    picture: { value: this.fine.all.texture },
    chosen: { value: this.fine.chosen.texture },
    depth: { value: this.fine.all.depthTexture },
    chosenDepth: { value: this.fine.chosen.depthTexture },
    isChosen: { value: 0 },
    rest: { value: 1 },
    pixel: { value: new Vector2() },
  };
  private readonly copy = new WholeViewport(
    new ShaderMaterial({
      glslVersion: GLSL3,
      depthTest: false,
      depthWrite: false,
      blending: NoBlending,
      vertexShader: kWholePicture,
      fragmentShader: kCopy,
      uniforms: this.uniforms,
    }),
  );

  /** Whether a picture of all is there to be kept. */
  get isKept(): boolean {
    return this.shown !== null;
  }

  /** Makes a picture of that size in CSS pixels, on the ground that the renderer clears with, and copies it onto the
   * viewport of the canvas. `coarse` counts where all is drawn. */
  draw(renderer: WebGLRenderer, size: [number, number], coarse: boolean, drawn: Drawn): void {
    if (drawn.all !== null) {
      this.shown = coarse ? this.coarse : this.fine;
      const [width, height] = size.map(n =>
        Math.max(1, Math.round(n * renderer.getPixelRatio() * (coarse ? kCoarse : 1))),
      );
      this.shown.all.setSize(width, height);
      renderer.setRenderTarget(this.shown.all);
      renderer.clear();
      drawn.all();
    }
    const { all, chosen } = this.shown!,
      isChosen = drawn.chosen !== null && drawn.chosen !== undefined;
    if (isChosen) {
      chosen.setSize(all.width, all.height);
      renderer.setRenderTarget(chosen);
      renderer.setClearColor(0, 0);
      renderer.clear();
      drawn.chosen!();
    }
    renderer.setRenderTarget(null);
    this.uniforms.picture.value = all.texture;
    this.uniforms.chosen.value = chosen.texture;
    this.uniforms.depth.value = all.depthTexture;
    this.uniforms.chosenDepth.value = chosen.depthTexture;
    this.uniforms.isChosen.value = isChosen ? 1 : 0;
    this.uniforms.rest.value = drawn.isRestFaint === true ? kFaint : 1;
    this.uniforms.pixel.value.set(1 / size[0], 1 / size[1]);
    this.copy.draw(renderer);
  }
}
