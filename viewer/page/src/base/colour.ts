// SPDX-License-Identifier: Apache-2.0
/** Colours of branches and of numbers. Branches: a walk in OKLCH (B. Ottosson, 2020) through five lightnesses, so that
 * neighbours in the list differ, for people with deuteranopia too (G. Machado et al., 2009): the least difference in OKLab of
 * any two within four places of the list is 0.15, and 0.08 for them; within twelve places it is 0.06. Numbers: samples of
 * viridis (S. van der Walt, N. Smith, 2015), which all kinds of colour vision read in order, and of a diverging map for
 * signed distances. */

export type Rgb = [number, number, number]; // 0 to 1, sRGB

function fromOklch(l: number, c: number, h: number): Rgb {
  const a = c * Math.cos(h),
    b = c * Math.sin(h);
  const L = (l + 0.3963377774 * a + 0.2158037573 * b) ** 3,
    M = (l - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const S = (l - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * L - 3.3077115913 * M + 0.2309699292 * S,
    -1.2684380046 * L + 2.6097574011 * M - 0.3413193965 * S,
    -0.0041960863 * L - 0.7034186147 * M + 1.707614701 * S,
  ];
  return linear.map(x => {
    const y = Math.min(1, Math.max(0, x));
    return y <= 0.0031308 ? 12.92 * y : 1.055 * y ** (1 / 2.4) - 0.055;
  }) as Rgb;
}

// by a search over angles and lightnesses; at the golden angle and two lightnesses the least is 0.007 with deuteranopia
const kAngle = 0.78,
  kFirst = 3, // radians of hue
  kLightness = [0.52, 0.7, 0.86, 0.61, 0.78],
  kChroma = 0.135;

export function branchColour(index: number): Rgb {
  return fromOklch(kLightness[index % kLightness.length], kChroma, kFirst + kAngle * index);
}

/** Systems of vessels, by their numbers in files. */
export const kSystems = ["unknown", "artery", "vein", "true-lumen", "false-lumen"];
const kSystemHues: Record<string, number> = {
  artery: 0.5,
  vein: 4.55,
  "true-lumen": 1.75,
  "false-lumen": 5.6,
};

/** The colour of a branch of a system: of one hue, in the lightnesses of branches. Null for an unknown system. */
export function systemColour(system: string | undefined, index: number): Rgb | null {
  if (system === undefined || !Object.hasOwn(kSystemHues, system)) return null;
  return fromOklch(kLightness[index % kLightness.length], kChroma, kSystemHues[system]);
}

/** "artery, ", to stand before other words; nothing for an unknown system. */
export const systemWords = (system: string | undefined): string =>
  system === undefined || system === "unknown" ? "" : `${system.replaceAll("-", " ")}, `;

export const toHex = (c: Rgb): string =>
  `#${c
    .map(x =>
      Math.round(255 * x)
        .toString(16)
        .padStart(2, "0"),
    )
    .join("")}`;
export function fromHex(text: string): Rgb {
  return [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16) / 255) as Rgb;
}
export const toCss = (c: Rgb, alpha = 1): string =>
  `rgb(${c.map(x => Math.round(255 * x)).join(" ")} / ${alpha})`;

const kViridis: Rgb[] = [
  [0.267, 0.005, 0.329],
  [0.283, 0.141, 0.458],
  [0.254, 0.265, 0.53],
  [0.207, 0.372, 0.553],
  [0.164, 0.471, 0.558],
  [0.128, 0.567, 0.551],
  [0.135, 0.659, 0.518],
  [0.267, 0.749, 0.441],
  [0.478, 0.821, 0.318],
  [0.741, 0.873, 0.15],
  [0.993, 0.906, 0.144],
];
const kDiverging: Rgb[] = [
  [0.13, 0.4, 0.67],
  [0.57, 0.77, 0.87],
  [0.97, 0.97, 0.97],
  [0.96, 0.65, 0.51],
  [0.7, 0.09, 0.17],
];

export type MapName = "sequential" | "diverging";

/** The colour at `share`, 0 to 1, of a map. */
export function mapColour(name: MapName, share: number): Rgb {
  const map = name === "sequential" ? kViridis : kDiverging;
  const x = Math.min(1, Math.max(0, share)) * (map.length - 1),
    i = Math.min(Math.floor(x), map.length - 2);
  return [0, 1, 2].map(k => map[i][k] + (x - i) * (map[i + 1][k] - map[i][k])) as Rgb;
}

/** 256 RGBA entries, for a texture. */
export function mapTable(name: MapName): Uint8Array {
  const table = new Uint8Array(1024);
  for (let i = 0; i < 256; ++i) {
    table.set(
      mapColour(name, i / 255).map(x => Math.round(255 * x)),
      4 * i,
    );
    table[4 * i + 3] = 255;
  }
  return table;
}

/** A range that shows most of the values: without a hundredth at either end; symmetric if it is to diverge. */
export function usualRange(values: ArrayLike<number>, symmetric = false): [number, number] {
  const finite = Array.from(values).filter(Number.isFinite);
  if (finite.length === 0) return [0, 1];
  const sorted = Float64Array.from(finite).sort(),
    pick = (s: number): number => sorted[Math.round(s * (sorted.length - 1))];
  let low = pick(0.01),
    high = pick(0.99);
  if (symmetric) {
    high = Math.max(Math.abs(low), Math.abs(high));
    low = -high;
  }
  return high > low ? [low, high] : [low - 0.5, low + 0.5];
}
