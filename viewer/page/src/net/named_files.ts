// SPDX-License-Identifier: Apache-2.0
/** Files that an address names, in the order and the parts in which `lumen view` opens those of its command line. */
import { isVolume } from "./dropped_files";
import type { OpenAs } from "./source";

/** The last part of an address, as people read it. */
export function nameOf(address: string): string {
  const last = new URL(address, location.href).pathname.split("/").pop() ?? "";
  try {
    return decodeURIComponent(last);
  } catch {
    return last;
  }
}

const isCase = (name: string): boolean => /\.lumen(\.json)?$/i.test(name),
  isSeeds = (name: string): boolean => /\.(json|fcsv)$/i.test(name) && !isCase(name),
  kKinds = [isVolume, isCase, (name: string): boolean => !isSeeds(name), isSeeds];

/** Volumes first, which seeds in voxels need, then cases. A second case is the truth, a second volume is seen beside the first. */
export function inOrder<T extends { name: string }>(files: T[]): (T & { as: OpenAs })[] {
  const rank = (name: string): number => kKinds.findIndex(is => is(name)),
    sorted = [...files].sort((a, b) => rank(a.name) - rank(b.name)),
    isFurther = (i: number): boolean => i > 0 && rank(sorted[i].name) === rank(sorted[i - 1].name);
  return sorted.map((file, i) => ({
    ...file,
    as: !isFurther(i) ? "auto" : isVolume(file.name) ? "second" : isCase(file.name) ? "truth" : "auto",
  }));
}
