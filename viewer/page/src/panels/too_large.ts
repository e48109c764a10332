// SPDX-License-Identifier: Apache-2.0
/** A volume that is too large for the engine in a tab: the page reports it before it starts, and offers a smaller copy. */
import { cropped, halved } from "../case/smaller_volume";
import { arrayOf, readVolumeHeader, type VolumeHeader } from "../case/volume_header";
import type { Part } from "../model/model";
import { askText, choose } from "../base/ui";

const kWorking = 14; // bytes for each voxel while vessels are found, besides the voxels themselves

/** Bytes that the engine needs for a volume, its file included. */
export function neededBytes(size: readonly number[], bytesPerVoxel: number, fileSize: number): number {
  return fileSize + size.reduce((product, n) => product * n, 1) * (bytesPerVoxel + kWorking);
}

/** Whether the file can hold the voxels that its header states; if not, the engine has the sentence on it. */
export function holdsVoxels(
  header: Pick<VolumeHeader, "size" | "type" | "begin" | "packing">,
  fileSize: number,
): boolean {
  const kMostPacking = 1032, // bytes that deflate makes of one, at most
    stated =
      header.begin + header.size.reduce((product, n) => product * n, arrayOf(header.type).BYTES_PER_ELEMENT);
  return stated <= fileSize * (header.packing === "none" ? 1 : kMostPacking);
}

const gigabytes = (bytes: number): string => `${(bytes / 2 ** 30).toPrecision(2)} GiB`;

/** The slices from the words of a person, from 1 as people count; null for other words. */
export function slicesIn(words: string, count: number): { first: number; last: number } | null {
  const found = /^\s*(\d+)\s*[-–]\s*(\d+)\s*$/.exec(words);
  if (found === null) return null;
  const [first, last] = [Number(found[1]) - 1, Number(found[2]) - 1];
  return first >= 0 && first < last && last < count ? { first, last } : null;
}

async function cropAsked(file: File, header: VolumeHeader): Promise<globalThis.Blob | null> {
  const count = header.size[2],
    words = await askText("Crop the volume", `Slices to keep, of 1-${count}`, `1-${Math.ceil(count / 2)}`);
  if (words === null) return null;
  const slices = slicesIn(words, count);
  if (slices === null)
    throw new Error(
      `"${words}" are no slices; expected two numbers within 1-${count}, such as 1-${count >> 1}.`,
    );
  return cropped(file, header, slices.first, slices.last);
}

/** The file, or a smaller copy of its volume where a person wants one; null: it is not to be opened. */
export async function fitting(
  app: Part<never, "source" | "inform">,
  file: File,
): Promise<globalThis.Blob | null> {
  const { mostBytes } = app.source,
    header = mostBytes === null ? null : await readVolumeHeader(file.name, file);
  if (mostBytes === null || header === null || !holdsVoxels(header, file.size)) return file;
  const needed = neededBytes(header.size, arrayOf(header.type).BYTES_PER_ELEMENT, file.size);
  if (needed <= mostBytes) return file;
  const choice = await choose(
    "The volume is too large for this tab",
    `${file.name} has ${header.size.join(" × ")} voxels. Finding vessels needs about ${gigabytes(needed)}; a tab has ${gigabytes(mostBytes)}. ` +
      "The installed lumen has no such limit.",
    [
      { value: "anyway", label: "Open it anyway" },
      { value: "crop", label: "Crop it…" },
      { value: "halve", label: "Halve its resolution" },
    ],
  );
  if (choice === "anyway") return file;
  if (choice === "crop") return cropAsked(file, header);
  if (choice !== "halve") return null;
  app.inform(`Halving ${file.name}…`);
  return halved(file, header);
}
