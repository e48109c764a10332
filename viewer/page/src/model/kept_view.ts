// SPDX-License-Identifier: Apache-2.0
/** The view of a case: it survives a reload of the page, and may be kept as a small file beside the case. */
import { isBeside, type Beside } from "./beside";
import { fromHex, toHex, type Rgb } from "../base/colour";
import { kColourTitles } from "./colouring";
import { kInitial, kLayouts, type Part, type Measurement, type View } from "./model";
import { isLabelLook, type LabelLook } from "./label_look";
import { areSlabs, type Slabs } from "./slab";
import type { Vec3 } from "../base/types";

/** The name of the format in the list of exports, and how such a file's name ends. */
export const kViewFormat = "view",
  kViewEnding = ".view.json";

const kFormat = "lumen-view",
  kVersion = 1,
  kWait = 300; // ms after a change until it is kept

/** The values that are kept as they are, by their owners; a file has all of them side by side. */
const kPlain = {
  selection: ["allOpacity"],
  slices: ["window", "crosshair", "interpolate", "axes", "slabs", "beside", "secondWindow", "labelLook"],
  scene: ["cast", "layers", "colourBy", "clip"],
  page: ["layout", "strip", "panels"],
} as const;
type Owner = keyof typeof kPlain;
type Plain = { [O in Owner]: Pick<View[O], (typeof kPlain)[O][number] & keyof View[O]> };
type Flat = Plain["selection"] & Plain["slices"] & Plain["scene"] & Plain["page"];
const kOwners = Object.keys(kPlain) as Owner[],
  kNames = kOwners.flatMap((owner): readonly (keyof Flat)[] => kPlain[owner]);

const flat = (view: View): Flat =>
  Object.fromEntries(
    kOwners.flatMap(owner => kPlain[owner].map(name => [name, view[owner][name as keyof View[Owner]]])),
  ) as unknown as Flat;
const kUsual = flat(kInitial);

/** Those that a file of before may lack. */
const kLater: readonly string[] = ["slabs", "beside", "secondWindow", "labelLook"];
/** The words that some of them may be. */
const kWords: { readonly [name in keyof Flat]?: readonly string[] } = {
  cast: ["off", "mip", "volume"],
  colourBy: Object.keys(kColourTitles),
  layout: kLayouts,
  axes: ["LPS", "RAS"],
};
interface KeptView extends Flat {
  format: typeof kFormat;
  version: typeof kVersion;
  /** Labels of vessels that are not shown. */
  hidden: string[];
  /** By the label of a vessel, as #rrggbb. */
  colours: Record<string, string>;
  opacity: Record<string, number>;
  measurements: Omit<Measurement, "id">[];
}

export function takeView(view: View): KeptView {
  return {
    format: kFormat,
    version: kVersion,
    ...flat(view),
    hidden: [...view.selection.hidden],
    colours: Object.fromEntries([...view.selection.colours].map(([label, colour]) => [label, toHex(colour)])),
    opacity: Object.fromEntries(view.selection.opacity),
    measurements: view.tools.measurements.map(({ kind, points, text, detail }) => ({
      kind,
      points,
      text,
      detail,
    })),
  };
}

const isObject = (x: unknown): x is Record<string, unknown> =>
    typeof x === "object" && x !== null && !Array.isArray(x),
  isNumber = (x: unknown): x is number => typeof x === "number" && Number.isFinite(x),
  isPoint = (x: unknown): x is Vec3 => Array.isArray(x) && x.length === 3 && x.every(isNumber),
  isMap = <T>(x: unknown, is: (value: unknown) => value is T): x is Record<string, T> =>
    isObject(x) && Object.values(x).every(is),
  isText = (x: unknown): x is string => typeof x === "string";

/** Whether a value has the shape of another: the same type, and the same members or length. */
function isLike(x: unknown, example: unknown): boolean {
  if (Array.isArray(example))
    return Array.isArray(x) && x.length === example.length && x.every((each, i) => isLike(each, example[i]));
  if (isObject(example))
    return isObject(x) && Object.entries(example).every(([name, value]) => isLike(x[name], value));
  return typeof x === typeof example && (typeof x !== "number" || Number.isFinite(x));
}

const isMeasurement = (x: unknown): x is Omit<Measurement, "id"> =>
  isObject(x) &&
  ["distance", "angle", "section", "touch", "probe"].includes(x.kind as string) &&
  Array.isArray(x.points) &&
  x.points.length > 0 &&
  x.points.every(isPoint) &&
  isText(x.text) &&
  isText(x.detail);

/** The content of a view file. Throws Error with what was found and what was expected. */
export function readView(text: string): KeptView {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    throw new Error("it is no JSON");
  }
  if (!isObject(value) || value.format !== kFormat) throw new Error(`its "format" is not "${kFormat}"`);
  if (value.version !== kVersion)
    throw new Error(`its version is ${String(value.version)}, this page reads ${kVersion}`);
  for (const name of kNames)
    if (kLater.includes(name) && value[name] === undefined) value[name] = kUsual[name];
  const wrong = kNames.find(
    name =>
      !isLike(value[name], kUsual[name]) ||
      kWords[name]?.includes(value[name] as string) === false ||
      (name === "slabs" && !areSlabs(value.slabs as Slabs)) ||
      (name === "beside" && !isBeside(value.beside as Beside)) ||
      (name === "labelLook" && !isLabelLook(value.labelLook as LabelLook)),
  );
  if (wrong !== undefined) throw new Error(`its "${wrong}" is no value that a view has`);
  const colours = value.colours;
  if (!isMap(colours, isText) || !Object.values(colours).every(c => /^#[0-9a-f]{6}$/i.test(c)))
    throw new Error('its "colours" are not colours such as "#e69f00"');
  if (!isMap(value.opacity, isNumber)) throw new Error('its "opacity" has other values than numbers');
  if (!Array.isArray(value.hidden) || !value.hidden.every(isText))
    throw new Error('its "hidden" is no list of labels');
  if (!Array.isArray(value.measurements) || !value.measurements.every(isMeasurement))
    throw new Error('its "measurements" are not those of a page');
  return value as unknown as KeptView;
}

export function applyView(
  app: Part<"selection" | "slices" | "scene" | "tools" | "page">,
  kept: KeptView,
): void {
  const of = <O extends Owner>(owner: O): Plain[O] =>
    Object.fromEntries(kPlain[owner].map(name => [name, kept[name]])) as unknown as Plain[O];
  const now = app.store.get().tools.measurements,
    first = Math.max(0, ...now.map(m => m.id)) + 1;
  app.store.set({
    selection: {
      ...of("selection"),
      hidden: new Set(kept.hidden),
      colours: new Map<string, Rgb>(
        Object.entries(kept.colours).map(([label, hex]) => [label, fromHex(hex)]),
      ),
      opacity: new Map(Object.entries(kept.opacity)),
    },
    slices: of("slices"),
    scene: of("scene"),
    page: of("page"),
    tools: { measurements: kept.measurements.map((m, i) => ({ ...m, id: first + i })) },
  });
}

/** One row for each measurement; positions in mm, LPS. */
export function measurementsCsv(measurements: readonly Measurement[]): string {
  const cell = (text: string): string => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  return [
    "number,kind,result,about,x_mm_lps,y_mm_lps,z_mm_lps",
    ...measurements.map((m, i) =>
      [String(i + 1), m.kind, m.text, m.detail, ...m.points[0].map(x => x.toFixed(3))].map(cell).join(","),
    ),
    "",
  ].join("\n");
}

/** Brings back the view that the page had before it was loaded again, once all is there, and keeps it from then on. */
export function keepView(app: Part<keyof View>): void {
  const place = `lumen-view:${location.pathname}`;
  let isBack = false,
    timer = 0;
  const read = (): KeptView | null => {
    try {
      const text = sessionStorage.getItem(place);
      return text === null ? null : readView(text);
    } catch {
      return null; // of another version, or a page that may keep nothing
    }
  };
  const bringBack = ({ document: { state, tree, volume, second } }: Pick<View, "document">): void => {
    const isThere =
      (state.has_volume || state.has_case) &&
      (!state.has_volume || volume !== null) &&
      (state.second === null || second !== null);
    if (isBack || !isThere || (state.has_case && tree === null)) return;
    isBack = true;
    const kept = read();
    if (kept !== null) queueMicrotask(() => applyView(app, kept)); // after what the volume brings along
  };
  app.store.watch(["document.state", "document.tree", "document.volume", "document.second"], bringBack);
  app.store.watch(["selection", "slices", "scene", "page", "tools.measurements"], () => {
    if (!isBack) return;
    window.clearTimeout(timer);
    timer = window.setTimeout(() => {
      try {
        sessionStorage.setItem(place, JSON.stringify(takeView(app.store.get())));
      } catch {
        /* a page from disk may keep nothing */
      }
    }, kWait);
  });
}
