// SPDX-License-Identifier: Apache-2.0
/** Messages between server and page (viewer/README.md), as far as the page reads them. Lengths in mm, positions in LPS. */

export type Vec3 = [number, number, number];

export interface Seed {
  label: string;
  kind: string;
  parent: string | null;
  points: { position: Vec3; radius_mm: number | null }[];
  tracked: boolean;
}

/** A vessel that was found and waits to be accepted. */
export interface Proposal {
  label: string;
  kind: string;
  /** mm */
  length_mm: number;
  /** Median, mm. */
  radius_mm: number;
  /** Mean inlier rate of its nodes, in [0, 1]. */
  confidence: number | null;
  /** One of `kSystems`. */
  system?: string;
  /** Vessel of the case, or proposal, that it leaves. */
  parent: string | null;
  /** Its parent is a proposal. */
  parent_waits: boolean;
  /** In its middle. */
  position: Vec3;
}

export interface MissingVessel {
  position: Vec3;
  length_mm: number;
  radius_mm: number;
  /** Clicks that track it. */
  clicks?: { points: Vec3[]; radius_mm: number | null };
}

export type WorkKind =
  | "blocked"
  | "loose"
  | "doubled"
  | "missing"
  | "early-end"
  | "dark"
  | "wall-off"
  | "thin";

/** A place that the check leaves to be decided. */
export interface WorkItem {
  id: number;
  kind: WorkKind;
  position: Vec3;
  /** The nearest of the case, and its branch. */
  node: number;
  branch: number;
  /** A clause for people. */
  about: string;
  /** Number of the missing vessel that may be tracked from there. */
  missing: number | null;
}

export interface IgnoredPlace {
  kind: WorkKind;
  position: Vec3;
  reason: string;
}

interface Work {
  items: WorkItem[];
  /** Their number when the check ended. */
  found: number;
  ignored: IgnoredPlace[];
}

interface CheckAnswer {
  missing_vessels?: MissingVessel[];
  wall?: { offset_mm?: { median?: number; p90_absolute?: number } };
}

export interface UnsavedFile {
  name: string;
  /** When it was written, ms since 1970. */
  written_ms: number;
  /** Whether that was after the file that `save` writes. */
  newer: boolean;
}

/** A series of a folder of DICOM. */
export interface DicomSeries {
  description: string;
  modality: string;
  files: number;
  /** Columns, rows, slices. */
  size: Vec3;
  /** mm; null where `fault` says why it cannot be opened. */
  spacing_mm: Vec3 | null;
  fault: string | null;
}

export interface SeriesList {
  folder: string;
  list: DicomSeries[];
  /** Why files cannot be read, the first ones; `faulty` counts all. */
  faults: string[];
  faulty: number;
  /** Files that are no images. */
  others: number;
}

/** A label of the map beside the volume. */
export interface Label {
  value: number;
  name: string | null;
  role: string;
  /** Where name and role come from. */
  from: string | null;
  voxels: number;
}

export interface FileEntry {
  id: number | string;
  kind: string;
  name: string;
  changed: boolean;
  /** Not dropped: it can be read again. */ named: boolean;
}

/** Revisions of the parts of the document; those of packs are their ETags. */
interface Revisions {
  case: number;
  surface: number;
  volume: number;
  seeds: number;
  proposals?: number;
  second?: number;
  labels?: number;
  meshes?: number;
  truth?: number;
  distance?: number;
  library?: number;
  measures?: number;
  series?: number;
}

export interface State {
  revision: number;
  revisions: Revisions;
  title: string;
  files: FileEntry[];
  has_volume: boolean;
  has_case: boolean;
  has_truth: boolean;
  /** What the reader of the volume took for granted, such as where left and right are. */
  assumptions: string[];
  /** A sentence on the volume from which the case was not made, until it is accepted. */
  other_source: string | null;
  /** The volume that is seen beside the first, and a sentence on what speaks against that. */
  second: { name: string; doubt: string | null } | null;
  /** The label map of the volume, and the words of all roles; its voxels have places in the list, counted from 1. */
  labels: { name: string; roles: string[]; list: Label[] } | null;
  meshes: { id: number | string; name: string }[];
  seeds: Seed[];
  proposals: Proposal[];
  undo: string | null;
  redo: string | null;
  unsaved: boolean;
  save_as: string | null;
  /** Files that hold what an earlier program did not save. */
  unsaved_before: UnsavedFile[];
  /** Series that can be opened; null: no folder of DICOM was named or dropped. */
  series: SeriesList | null;
  /** Index in the library. */
  open_case: number | null;
  job: { job: number; name: string } | null;
  check: CheckAnswer | null;
  /** Places that the check leaves to a person; null before a check. */
  work: Work | null;
  /** The case has changed since it was checked. */
  check_is_old: boolean;
  /** The case has changed since it was measured. */
  measures_are_old: boolean;
  /** As `lumen compare` answers, or null. */
  figures: Record<string, unknown> | null;
  formats: string[];
  /** Where the page looks first; null: at the widest vessel. */
  look: Vec3 | null;
  /** Time of the case's motion that the page shows first, s; null: the case at rest. */
  time_s: number | null;
}

export const kEmptyState: State = {
  revision: 0,
  revisions: { case: 0, surface: 0, volume: 0, seeds: 0 },
  title: "",
  files: [],
  has_volume: false,
  has_case: false,
  has_truth: false,
  assumptions: [],
  other_source: null,
  second: null,
  labels: null,
  meshes: [],
  seeds: [],
  proposals: [],
  undo: null,
  redo: null,
  unsaved: false,
  save_as: null,
  unsaved_before: [],
  series: null,
  open_case: null,
  job: null,
  check: null,
  work: null,
  check_is_old: false,
  look: null,
  time_s: null,
  measures_are_old: false,
  figures: null,
  formats: [],
};

export interface LibraryCase {
  name: string;
  branches: number | null;
  length_mm: number | null;
  error: string | null;
}
export interface Library {
  name: string;
  cases: LibraryCase[];
}

export interface BranchRecord {
  label: string;
  kind: string;
  parent_node: number;
  first_node: number;
  node_count: number;
  stop_reason: string;
  /** Sentence on the last node. */
  end?: string;
  confidence: number | null;
  /** mm, as `lumen info` reports it: with the edge to its parent. */
  length_mm: number;
  /** The system of vessels, one of `kSystems`; older pages have none. */
  system?: string;
}

export type Event =
  | { type: "state"; state: State }
  | { type: "progress"; job: number; stage: string; done: number; total: number }
  | { type: "message"; severity: "note" | "warning" | "error"; text: string }
  | { type: "done"; job: number; ok: boolean; text: string }
  | { type: "lost" }
  | { type: "back" };

export type Operation = { op: string; [key: string]: unknown };

export interface VesselAtClick {
  found: boolean;
  position: Vec3;
  radius_mm: number;
  reason?: string;
}
