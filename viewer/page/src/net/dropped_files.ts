// SPDX-License-Identifier: Apache-2.0
/** Files and folders that are dropped or chosen: which of them are images of DICOM, which go to the server together, which hold a
 * volume or seeds. */

const kMark = "DICM",
  kMarkAt = 128, // bytes before the mark
  kEndings = /\.(dcm|dicom|ima)$/i,
  kMostEntries = 20_000; // files of a folder, as the server takes them

/** Whether a file is DICOM, by its name or its mark. */
export async function isDicom(file: File): Promise<boolean> {
  if (kEndings.test(file.name)) return true;
  if (file.size < kMarkAt + kMark.length) return false;
  return (await file.slice(kMarkAt, kMarkAt + kMark.length).text()) === kMark;
}

/** Whether a file is a volume by its name. */
export const isVolume = (name: string): boolean => /\.(nrrd|nhdr|nii|nii\.gz|hdr|mha|mhd)$/i.test(name);

/** Whether the name of a volume is that of a label map, which is opened behind the volume that it is of. */
export const isLabelMap = (name: string): boolean =>
  isVolume(name) && /label|seg(?![a-z])|segment|mask|annot|aparc/i.test(name);

export interface Dropped {
  /** Files that were dropped by themselves. */
  files: File[];
  /** Files of the folders that were dropped, and of the folders in them. */
  inFolders: File[];
}

/** The files that belong to series of DICOM, and the others. All files of a folder that holds DICOM belong to it, so
 * that those that cannot be read are reported. */
export async function divide({ files, inFolders }: Dropped): Promise<{ dicom: File[]; others: File[] }> {
  const dicom: File[] = [],
    others: File[] = [];
  for (const file of files) ((await isDicom(file)) ? dicom : others).push(file);
  let hasDicom = false;
  for (const file of inFolders) if ((hasDicom ||= await isDicom(file))) break;
  (hasDicom ? dicom : others).push(...inFolders);
  return { dicom, others };
}

function fileOf(entry: FileSystemFileEntry): Promise<File> {
  return new Promise((resolve, reject) => entry.file(resolve, reject));
}
/** A folder hands out its entries in portions; the last is empty. */
function portion(reader: FileSystemDirectoryReader): Promise<FileSystemEntry[]> {
  return new Promise((resolve, reject) => reader.readEntries(resolve, reject));
}

async function filesBelow(folder: FileSystemDirectoryEntry): Promise<File[]> {
  const found: File[] = [],
    folders = [folder];
  for (let at = 0; at < folders.length; ++at) {
    const reader = folders[at].createReader();
    for (let entries = await portion(reader); entries.length > 0; entries = await portion(reader))
      for (const entry of entries) {
        if (entry.isDirectory) folders.push(entry as FileSystemDirectoryEntry);
        else found.push(await fileOf(entry as FileSystemFileEntry));
        if (found.length > kMostEntries || folders.length > kMostEntries)
          throw new Error(`The folder ${folder.name} holds more than ${kMostEntries} files.`);
      }
  }
  return found.sort((a, b) => (a.name < b.name ? -1 : a.name > b.name ? 1 : 0));
}

/** What was dropped. To be called before the event ends: the list is empty afterwards. */
export async function droppedFiles(data: DataTransfer): Promise<Dropped> {
  const files: File[] = [],
    folders: FileSystemDirectoryEntry[] = [];
  for (const item of data.items) {
    const entry = item.webkitGetAsEntry();
    if (entry?.isDirectory === true) folders.push(entry as FileSystemDirectoryEntry);
    else {
      const file = item.getAsFile();
      if (file !== null) files.push(file);
    }
  }
  const inFolders: File[] = [];
  for (const folder of folders) inFolders.push(...(await filesBelow(folder)));
  return { files, inFolders };
}

/** Whether a file holds seeds, by its name and its first text: markups, a table of fiducials, or lumen's own. */
export function holdsSeeds(name: string, head: string): boolean {
  if (/\.(mrk\.json|fcsv)$/i.test(name)) return true;
  return /\.json$/i.test(name) && /"(markups|branches)"\s*:/.test(head) && !/"(tree|centre)"\s*:/.test(head);
}
