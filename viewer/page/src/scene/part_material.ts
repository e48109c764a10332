// SPDX-License-Identifier: Apache-2.0
/** The look of walls and tubes: light from the eye, a darker rim, a colour of their own or of a map, one clip plane. */
import {
  DataTexture,
  DoubleSide,
  FrontSide,
  GLSL3,
  LinearFilter,
  RGBAFormat,
  ShaderMaterial,
  Vector2,
  Vector3,
  Vector4,
} from "three";
import { mapTable, type MapName } from "../base/colour";

const kVertex = `
out vec3 normalHere;
out vec3 here;
out vec3 inView;
out float shown;
#ifdef HAS_VALUE
in float value;
#endif
void main() {
  vec4 p = vec4(position, 1.0);
  vec3 n = normal.xyz;
  here = p.xyz;
  #ifdef HAS_VALUE
  shown = value;
  #else
  shown = 0.0;
  #endif
  normalHere = normalMatrix * n;
  vec4 v = modelViewMatrix * p;
  inView = v.xyz;
  gl_Position = projectionMatrix * v;
}`;

const kFragment = `
precision highp float;
in vec3 normalHere;
in vec3 here;
in vec3 inView;
in float shown;
out vec4 result;
uniform vec3 own;
uniform float alpha;
uniform float mapped;      // 1: colour of the value
uniform vec2 range;
uniform sampler2D map;
uniform float lit;         // 1: selected
uniform float fade;        // 1/mm: darker with the distance, where the eye is inside
uniform vec4 clip;         // n and d: what has n x + d > 0 is cut away; n = 0: nothing
void main() {
  if (dot(clip.xyz, here) + clip.w > 0.0) discard;
  vec3 n = normalize(normalHere);
  float facing = dot(n, normalize(-inView));
  bool inner = facing < 0.0;
  facing = abs(facing);
  vec3 base = own;
  if (mapped > 0.5) base = shown == shown ? texture(map, vec2((shown - range.x) / max(range.y - range.x, 1e-9), 0.5)).rgb : vec3(0.45);
  float shade = 0.34 + 0.66 * facing;
  vec3 colour = base * shade + vec3(0.16) * pow(facing, 24.0);
  if (inner) colour = fade > 0.0 ? base * (0.25 + 0.75 * facing) : base * 0.42 * (0.6 + 0.4 * facing);
  colour += lit * (vec3(0.10) + vec3(0.25) * pow(1.0 - facing, 2.5));
  colour *= exp(-fade * length(inView));
  float a = alpha < 1.0 ? alpha + (1.0 - alpha) * alpha * pow(1.0 - facing, 2.0) : 1.0;
  result = vec4(colour, a);
}`;

const tables = new Map<MapName, DataTexture>();
function table(name: MapName): DataTexture {
  let texture = tables.get(name);
  if (texture === undefined) {
    texture = new DataTexture(mapTable(name) as Uint8Array<ArrayBuffer>, 256, 1, RGBAFormat);
    texture.minFilter = texture.magFilter = LinearFilter;
    texture.needsUpdate = true;
    tables.set(name, texture);
  }
  return texture;
}

interface Look {
  own: [number, number, number];
  alpha: number;
  /** Whether colours are those of numbers, of which `range` is spread over `map`. */
  mapped?: boolean;
  range?: [number, number];
  map?: MapName;
  clip?: Vector4;
}

/** Cuts nothing away; a plane of three.js that nobody set would be (0, 0, 0, 1), and cut everything. */
export const kNoClip = new Vector4(0, 0, 0, 0);

/** One for all: set to look along a vessel from inside. */
export const kFade = { value: 0 };

export class PartMaterial extends ShaderMaterial {
  constructor(hasValue: boolean) {
    super({
      glslVersion: GLSL3,
      vertexShader: kVertex,
      fragmentShader: kFragment,
      defines: hasValue ? { HAS_VALUE: "" } : {},
      uniforms: {
        own: { value: new Vector3(1, 1, 1) },
        alpha: { value: 1 },
        mapped: { value: 0 },
        range: { value: new Vector2(0, 1) },
        map: { value: table("sequential") },
        lit: { value: 0 },
        fade: kFade,
        clip: { value: new Vector4(0, 0, 0, 0) },
      },
    });
    this.side = DoubleSide;
  }

  /** Selected, or no longer. */
  set lit(on: boolean) {
    this.uniforms.lit.value = on ? 1 : 0;
  }

  look({ own, alpha, mapped = false, range = [0, 1], map = "sequential", clip = kNoClip }: Look): void {
    const u = this.uniforms,
      clear = alpha < 1;
    (u.own.value as Vector3).set(...own);
    u.alpha.value = alpha;
    u.mapped.value = mapped ? 1 : 0;
    (u.range.value as Vector2).set(...range);
    u.map.value = table(map);
    (u.clip.value as Vector4).copy(clip);
    if (this.transparent !== clear) {
      this.transparent = clear;
      this.needsUpdate = true;
    }
    this.depthWrite = !clear;
    this.side = clear ? FrontSide : DoubleSide;
  }
}
