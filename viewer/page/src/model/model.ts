// SPDX-License-Identifier: Apache-2.0
/** The page's model: values of a few owners, which panels and views watch. */
import type { Model } from "../../../../libblob/wasm/blob.mjs";
import { branchColour, systemColour, type Rgb } from "../base/colour";
import type { Deviation } from "../case/deviation";
import { kNoBeside, type Beside } from "./beside";
import { kUsualLabels, type LabelLook } from "./label_look";
import { kNoSlabs, type Slabs } from "./slab";
import type { OpenAs, Source } from "../net/source";
import type { Stage } from "../drawing/stage";
import { Store } from "../base/store";
import type { Stroke } from "./stroke";
import type { Surface } from "../case/surface";
import type { Tree } from "../case/tree";
import { kEmptyState, type Operation, type Seed, type State, type Vec3 } from "../base/types";
import type { Frame } from "../base/vec";
import type { Volume } from "../case/volume";

export type Tool =
  | "navigate"
  | "seed"
  | "probe"
  | "distance"
  | "angle"
  | "section"
  | "touch"
  | "move"
  | "brush";
export type ColourBy = "branch" | "radius" | "confidence" | "error" | "root" | "compare";
export type Cast = "off" | "mip" | "volume";
/** In the order of their keys, from 1. */
export const kLayouts = ["four", "rows", "scene", "axial", "coronal", "sagittal"] as const;
export type Layout = (typeof kLayouts)[number];
/** Axes in which coordinates are shown: x to the patient's left and y to the back, or both the other way. */
export type Axes = "LPS" | "RAS";
export type Planes = "patient" | "vessel" | "free";

export interface Layers {
  surface: boolean;
  lines: boolean;
  nodes: boolean;
  points: boolean;
  local: boolean;
  contours: boolean;
  seeds: boolean;
  slices: boolean;
  places: boolean;
  proposals: boolean;
  names: boolean;
}

export interface Measurement {
  id: number;
  kind: "distance" | "angle" | "section" | "touch" | "probe";
  points: Vec3[];
  text: string;
  detail: string;
}

/** The document, as far as it has come from the server. */
interface DocumentView {
  state: State;
  tree: Tree | null;
  /** Revision of the document that the tree is of; the state's may be newer while the tree is on its way. */
  treeRevision: number;
  /** Vessels that wait to be accepted. */
  proposals: Tree | null;
  surface: Surface | null;
  volume: Volume | null;
  /** Slices of the volume that can be shown. */
  volumeReady: number;
  /** A volume to look at beside the first, at its own places; nothing is tracked in it. */
  second: Volume | null;
  secondReady: number;
  /** The places of labels in the state's list, counted from 1. */
  labels: Volume | null;
  labelsReady: number;
  blob: Model | null;
  distance: Float32Array | null;
  figures: Record<string, unknown> | null;
  /** By the number of a mesh: those that are coloured by their distance from the wall. */
  deviations: ReadonlyMap<string, Deviation>;
  job: { job: number; name: string; stage: string; done: number; total: number } | null;
}

/** The selected vessel, the cursor on it, and how each vessel looks. */
interface SelectionView {
  selected: number;
  /** Labels of vessels that are chosen together; fewer than two are no set. */
  chosen: ReadonlySet<string>;
  /** Node of the selected vessel that the cursor is at, or -1. */
  node: number;
  hidden: ReadonlySet<string>;
  solo: string | null;
  opacity: ReadonlyMap<string, number>;
  allOpacity: number;
  /** Chosen by the user. */
  colours: ReadonlyMap<string, Rgb>;
  /** Index of each name in the list of colours: a vessel keeps its colour when the list of vessels changes. */
  colourNumbers: ReadonlyMap<string, number>;
  /** Label of the proposal that was shown last. */
  proposal: string | null;
  /** Id of the place of the check that was shown last. */
  place: number | null;
}

interface MotionView {
  /** Time of the case's motion that is shown, s; null: the case at rest. */
  time: number | null;
  /** The time goes on. */
  playing: boolean;
  /** The tree at that time; null at rest. */
  posed: Tree | null;
}

/** The place that the three slices share, and how they show volumes. */
interface SlicesView {
  crosshair: Vec3;
  axes: Axes;
  planes: Planes;
  frame: Frame;
  window: [number, number];
  secondWindow: [number, number];
  /** How the second volume is seen. */
  beside: Beside;
  labelLook: LabelLook;
  /** Values of labels that are not shown. */
  hiddenLabels: ReadonlySet<number>;
  /** RGBA of each place in the list of labels, counted from 1; without opacity where it is not shown. */
  labelPalette: Uint8Array;
  slabs: Slabs;
  interpolate: boolean;
}

/** What is drawn in 3D; layers count in slices, too. */
interface SceneLook {
  cast: Cast;
  layers: Layers;
  colourBy: ColourBy;
  clip: { on: boolean; flip: boolean };
}

/** The tool of the pointer, and what it has made or is making. */
interface ToolsView {
  tool: Tool;
  measurements: Measurement[];
  /** Points of the measurement that is being made, or of what is dragged. */
  pending: Vec3[];
  /** The brush at the pointer, and the way that it pushes the wall. */
  brushLines: Vec3[][];
  /** The stroke that is being drawn. */
  stroke: Stroke | null;
  /** Radius of the brush, mm; null: that of the vessel. */
  brush: number | null;
  /** mm along a vessel over which a radius that is dragged fades; null: as the vessel is wide, 0: one node. */
  stretch: number | null;
  /** Clicks of the seed that is being made; they stay while other tools are used to look for the next one. */
  clicks: Seed["points"];
  /** The part that a series of the files that were dropped last becomes; null: to be asked. */
  seriesAs: OpenAs | null;
}

interface PageView {
  layout: Layout;
  theme: "dark" | "light";
  strip: boolean;
  /** Panels that are open; the others are folded. */
  panels: { left: boolean; right: boolean };
}

/** What is shown, by its owners. A function takes those that it reads: `Pick<View, "document" | "motion">`. */
export interface View {
  document: DocumentView;
  selection: SelectionView;
  motion: MotionView;
  slices: SlicesView;
  scene: SceneLook;
  tools: ToolsView;
  page: PageView;
}

/** Axial as it is read: from the feet, the patient's left on the right. */
export const kPatientFrame: Frame = { right: [1, 0, 0], up: [0, -1, 0], normal: [0, 0, -1] };

export const kInitial: View = {
  document: {
    state: kEmptyState,
    tree: null,
    treeRevision: 0,
    proposals: null,
    surface: null,
    volume: null,
    volumeReady: 0,
    second: null,
    secondReady: 0,
    labels: null,
    labelsReady: 0,
    blob: null,
    distance: null,
    figures: null,
    deviations: new Map(),
    job: null,
  },
  selection: {
    selected: -1,
    chosen: new Set(),
    node: -1,
    hidden: new Set(),
    solo: null,
    opacity: new Map(),
    allOpacity: 1,
    colours: new Map(),
    colourNumbers: new Map(),
    proposal: null,
    place: null,
  },
  motion: {
    time: null,
    playing: false,
    posed: null,
  },
  slices: {
    crosshair: [0, 0, 0],
    axes: "LPS",
    planes: "patient",
    frame: kPatientFrame,
    window: [0, 1],
    secondWindow: [0, 1],
    beside: kNoBeside,
    labelLook: kUsualLabels,
    hiddenLabels: new Set(),
    labelPalette: new Uint8Array(4),
    slabs: kNoSlabs,
    interpolate: true,
  },
  scene: {
    cast: "off",
    clip: { on: false, flip: false },
    layers: {
      surface: true,
      lines: true,
      nodes: false,
      points: false,
      local: false,
      contours: true,
      seeds: true,
      slices: false,
      places: true,
      proposals: true,
      names: false,
    },
    colourBy: "branch",
  },
  tools: {
    tool: "navigate",
    measurements: [],
    pending: [],
    brushLines: [],
    stroke: null,
    brush: null,
    stretch: null,
    clicks: [],
    seriesAs: null,
  },
  page: {
    layout: "four",
    theme: "dark",
    strip: true,
    panels: { left: true, right: true },
  },
};

/** The values that belong to a volume: two of the document, the window of the slices, and the texture of a slice. */
export const kFirst = {
    volume: "volume",
    ready: "volumeReady",
    window: "window",
    texture: "texture",
  } as const,
  kSecond = {
    volume: "second",
    ready: "secondReady",
    window: "secondWindow",
    texture: "second",
  } as const,
  kLabels = { volume: "labels", ready: "labelsReady", window: null, texture: "labels" } as const;
export type VolumeKeys = typeof kFirst | typeof kSecond;

interface Services {
  source: Source;
  stage: Stage;
  /** Shows the user a line that goes away, and to assistive technology. */
  inform: (text: string, severity?: "note" | "warning" | "error") => void;
  /** Changes the document and reports a refusal. True if it was done. */
  perform: (operation: Operation) => Promise<boolean>;
}
/** What a part of the page gets: the values of some owners, which it watches and sets, and services. */
export type Part<O extends keyof View, S extends keyof Services = never> = Pick<Services, S> & {
  store: Store<Pick<View, O>>;
};
/** A part that moves the cursor along vessels, which every view shows. */
export type CursorPart<O extends keyof View = never, S extends keyof Services = never> = Part<
  "document" | "selection" | "motion" | "slices" | O,
  S
>;
/** All of it, which the page puts together for its parts. */
export type App = Part<keyof View, keyof Services>;

/** The tree where the views show it: at the time of its motion, or at rest. */
export const shownTree = ({
  document: { tree },
  motion: { posed },
}: Pick<View, "document" | "motion">): Tree | null => posed ?? tree;

/** The colour of a branch: chosen, of its system, or of the number that its name has. */
export function colourOf(view: Pick<View, "document" | "selection">, branch: number): Rgb {
  const record = view.document.tree?.branches[branch],
    label = record?.label ?? "",
    number = view.selection.colourNumbers.get(label) ?? branch;
  return view.selection.colours.get(label) ?? systemColour(record?.system, number) ?? branchColour(number);
}

export function isShown(view: Pick<View, "document" | "selection">, branch: number): boolean {
  const label = view.document.tree?.branches[branch]?.label;
  if (label === undefined) return true;
  return view.selection.solo !== null ? view.selection.solo === label : !view.selection.hidden.has(label);
}

export function opacityOf(view: Pick<View, "document" | "selection">, branch: number): number {
  return (
    (view.selection.opacity.get(view.document.tree?.branches[branch]?.label ?? "") ?? 1) *
    view.selection.allOpacity
  );
}

export const newStore = (): Store<View> => new Store<View>(kInitial);
