// SPDX-License-Identifier: Apache-2.0
/** Ray casting: maximum-intensity projection and a shaded volume, at a resolution that the graphics can bear. Blocks
 * whose greatest value cannot show are stepped over. */
import { kWholePicture, WholeViewport } from "../drawing/scene_picture";
import {
  BackSide,
  BoxGeometry,
  GLSL3,
  LinearFilter,
  Matrix4,
  Mesh,
  NoBlending,
  RGBAFormat,
  Scene,
  ShaderMaterial,
  Vector2,
  Vector3,
  Vector4,
  WebGLRenderTarget,
  type Camera,
  type WebGLRenderer,
} from "three";
import { kBlock, type Reduced, type Volume } from "../case/volume";
import { castTextures } from "../drawing/volume_texture";

const kVertex = `
out vec3 here;
void main() { here = position; gl_Position = projectionMatrix * viewMatrix * fromTexture * vec4(position, 1.0); }`;

const kFragment = `
precision highp float;
precision highp sampler3D;
in vec3 here;                      // texture coordinates of the far side
out vec4 result;
uniform sampler3D voxels, blocks;
uniform vec3 eye;                  // in texture coordinates
uniform vec3 forward;              // of parallel rays; 0: they leave the eye
uniform vec3 size, blockCount;
uniform vec2 window;               // shares of the texture's 8 bits
uniform float shaded, step;        // step in texels
uniform vec4 clip;                 // in texture coordinates
void main() {
  vec3 d = dot(forward, forward) > 0.0 ? forward : normalize(here - eye);
  vec3 inverse = 1.0 / (abs(d) + vec3(1e-9)) * sign(d + vec3(1e-12));
  vec3 a = (vec3(0.0) - here) * inverse, b = (vec3(1.0) - here) * inverse, least = min(a, b);
  float from = max(max(least.x, least.y), least.z);
  if (dot(forward, forward) == 0.0) from = max(from, -length(here - eye));
  float to = 0.0;
  float side = dot(clip.xyz, d), at = dot(clip.xyz, here) + clip.w; // cut away where at + side t > 0
  if (dot(clip.xyz, clip.xyz) > 0.0) {
    if (abs(side) < 1e-9) { if (at > 0.0) discard; }
    else if (side > 0.0) to = min(to, -at / side);
    else from = max(from, -at / side);
  }
  float each = step / length(d * size);
  float jitter = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453);
  float t = from + each * jitter, most = 0.0, span = max(window.y - window.x, 1e-4);
  vec3 sum = vec3(0.0);
  float cover = 0.0;
  float from0 = window.x + 0.15 * span; // what is darker is noise more than vessel
  vec3 toBlock = size / ${kBlock.toFixed(1)};
  for (int i = 0; i < 1400; ++i) {
    if (t >= to) break;
    vec3 p = here + t * d, cell = floor(p * toBlock);
    float peak = texture(blocks, (cell + 0.5) / blockCount).r;
    if (peak <= (shaded > 0.5 ? from0 : max(most, window.x * 0.5))) {
      vec3 next = (cell + step3(d)) / toBlock;
      vec3 exits = (next - here) * inverse;
      t = max(min(exits.x, min(exits.y, exits.z)), t) + 0.5 * each;
      continue;
    }
    float v = texture(voxels, p).r;
    if (shaded < 0.5) { most = max(most, v); if (most >= window.y) break; }
    else if (v > from0) {
      float x = clamp((v - from0) / span, 0.0, 1.0), density = x * x * 0.5 * step;
      vec3 e = 1.0 / size;
      vec3 g = vec3(texture(voxels, p + vec3(e.x, 0, 0)).r - texture(voxels, p - vec3(e.x, 0, 0)).r,
        texture(voxels, p + vec3(0, e.y, 0)).r - texture(voxels, p - vec3(0, e.y, 0)).r,
        texture(voxels, p + vec3(0, 0, e.z)).r - texture(voxels, p - vec3(0, 0, e.z)).r);
      float facing = abs(dot(normalize(g + 1e-6), normalize(d * size)));
      vec3 tint = mix(vec3(0.62, 0.22, 0.17), vec3(1.0, 0.93, 0.84), x);
      sum += (1.0 - cover) * density * tint * (0.35 + 0.65 * facing);
      cover += (1.0 - cover) * density;
      if (cover > 0.97) break;
    }
    t += each;
  }
  if (shaded < 0.5) {
    float x = clamp((most - window.x) / span, 0.0, 1.0);
    result = vec4(vec3(x), 1.0);
  } else result = vec4(sum, cover);
}`.replace("void main", "vec3 step3(vec3 d) { return vec3(greaterThan(d, vec3(0.0))); }\nvoid main");

const kCopy = `
precision highp float;
in vec2 at;
out vec4 result;
uniform sampler2D picture;
void main() { result = vec4(texture(picture, at).rgb + vec3(0.027, 0.035, 0.047) * (1.0 - texture(picture, at).a), 1.0); }`;

export class Caster {
  private readonly target = new WebGLRenderTarget(1, 1, {
    format: RGBAFormat,
    minFilter: LinearFilter,
    magFilter: LinearFilter,
    depthBuffer: false,
  });
  private readonly scene = new Scene();
  private readonly copy = new WholeViewport(
    new ShaderMaterial({
      glslVersion: GLSL3,
      depthTest: false,
      depthWrite: false,
      vertexShader: kWholePicture,
      fragmentShader: kCopy,
      uniforms: { picture: { value: this.target.texture } },
    }),
  );
  private readonly material: ShaderMaterial;
  private readonly textures: ReturnType<typeof castTextures>;
  private readonly fromTexture: Matrix4;
  private readonly toTexture: Matrix4;

  constructor(
    volume: Volume,
    private readonly reduced: Reduced,
  ) {
    this.textures = castTextures(reduced);
    this.toTexture = new Matrix4().fromArray(volume.toTexture());
    this.fromTexture = this.toTexture.clone().invert();
    this.material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: `uniform mat4 fromTexture;${kVertex}`,
      fragmentShader: kFragment,
      side: BackSide,
      depthTest: false,
      depthWrite: false,
      blending: NoBlending,
      uniforms: {
        voxels: { value: this.textures.voxels },
        blocks: { value: this.textures.blocks },
        eye: { value: new Vector3() },
        forward: { value: new Vector3() },
        size: { value: new Vector3(...reduced.size) },
        blockCount: { value: new Vector3(...reduced.blocks.size) },
        window: { value: new Vector2() },
        shaded: { value: 0 },
        step: { value: 1 },
        clip: { value: new Vector4() },
        fromTexture: { value: this.fromTexture },
      },
    });
    const box = new Mesh(new BoxGeometry(1, 1, 1).translate(0.5, 0.5, 0.5), this.material);
    box.frustumCulled = false;
    // a left-handed frame would show the near sides instead
    if (this.fromTexture.determinant() < 0) this.material.side = 0;
    this.scene.add(box);
  }

  /** Draws over the whole of the renderer's target, as the ground for what follows. `share`: of the resolution. */
  draw(
    renderer: WebGLRenderer,
    camera: Camera,
    parallel: boolean,
    size: [number, number],
    share: number,
    window: [number, number],
    shaded: boolean,
    clip: Vector4,
    step: number,
  ): void {
    const u = this.material.uniforms,
      { low, high } = this.reduced,
      f = 1 / Math.max(high - low, 1e-9);
    this.target.setSize(Math.max(1, Math.round(size[0] * share)), Math.max(1, Math.round(size[1] * share)));
    (u.window.value as Vector2).set((window[0] - low) * f, (window[1] - low) * f);
    u.shaded.value = shaded ? 1 : 0;
    u.step.value = step;
    (u.eye.value as Vector3).copy(camera.position).applyMatrix4(this.toTexture);
    const forward = camera.getWorldDirection(new Vector3());
    if (parallel) (u.forward.value as Vector3).copy(forward).transformDirection(this.toTexture);
    else (u.forward.value as Vector3).set(0, 0, 0);
    // a plane transforms with the inverse transposed, which for a row of four is the product with the way back
    (u.clip.value as Vector4).copy(clip).applyMatrix4(this.fromTexture.clone().transpose());
    const ground = renderer.getRenderTarget();
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0x000000, 0);
    renderer.clear();
    renderer.render(this.scene, camera);
    renderer.setRenderTarget(ground);
    this.copy.draw(renderer);
  }

  dispose(): void {
    this.target.dispose();
    this.textures.voxels.dispose();
    this.textures.blocks.dispose();
    this.material.dispose();
  }
}
