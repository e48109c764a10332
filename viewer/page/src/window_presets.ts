// SPDX-License-Identifier: Apache-2.0
/** Windows by which CT is usually read, in Hounsfield units: the usual centre and width. */

export const kPresets: readonly { name: string; title: string; centre: number; width: number }[] = [
  { name: "bone", title: "CT bone", centre: 400, width: 1800 },
  { name: "lung", title: "CT lung", centre: -600, width: 1500 },
  { name: "vessel", title: "CT vessel", centre: 300, width: 600 },
  { name: "brain", title: "CT brain", centre: 40, width: 80 },
  { name: "abdomen", title: "CT abdomen", centre: 40, width: 400 },
];

export function windowOf(name: string): [number, number] | null {
  const preset = kPresets.find(each => each.name === name);
  return preset === undefined ? null : [preset.centre - preset.width / 2, preset.centre + preset.width / 2];
}

/** The name of the preset that has this window; empty: none. */
export function presetOf(window: readonly [number, number]): string {
  return kPresets.find(({ name }) => windowOf(name)!.every((x, i) => x === window[i]))?.name ?? "";
}
