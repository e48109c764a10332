// SPDX-License-Identifier: Apache-2.0
/** The tables of `lumen measure`, as people read them. docs/measures.md defines each number. */
import type { Vec3 } from "../base/types";

/** A number with half of its 95 % interval, or the reason why there is none. */
interface Measured {
  value: number | null;
  plus_minus: number | null;
  absent: string | null;
  /** A bound, where the volume does not show a value as small. */
  at_most?: number | null;
}

/** A row of a table: texts, places whose names end with `_place_mm` (null: it has none), vectors, and measures with their units. */
export type MeasureRow = Record<string, string | number[] | Measured | null>;

/** Rows by kind. */
export type MeasureTables = Record<string, MeasureRow[]>;

/** One measure of a row. */
export interface Figure {
  /** As the table has it. */
  column: string;
  /** Without its unit, for people. */
  name: string;
  text: string;
  /** Where it was measured. */
  place: Vec3 | null;
}

/** Kinds whose rows are few enough to be read one by one, with the measures that a list of them shows. */
export const kKinds: [kind: string, title: string, shown: string[]][] = [
  ["vessels", "Vessels", ["length_mm", "smallest_radius_mm"]],
  ["paths", "Paths from an inlet", ["length_mm", "largest_catheter_fr"]],
  ["forks", "Forks", ["angle_deg", "area_ratio"]],
  ["narrowings", "Narrowings and dilations", ["diameter_mm", "nascet_percent"]],
  ["sacs", "Aneurysms", ["height_mm", "aspect_ratio"]],
];

const kUnits: [ending: string, unit: string][] = [
  ["_rad_per_cm", "rad/cm"],
  ["_deg_per_cm", "°/cm"],
  ["_mm_per_mm", "mm/mm"],
  ["_per_mm", "/mm"],
  ["_percent", "%"],
  ["_mm3", "mm³"],
  ["_mm2", "mm²"],
  ["_mm", "mm"],
  ["_deg", "°"],
  ["_fr", "Fr"],
];

/** The name of a column for people, and its unit. */
export function splitColumn(column: string): { name: string; unit: string } {
  if (column === "turns_over_90_deg") return { name: "turns over 90°", unit: "" }; // a count
  const found = kUnits.find(([ending]) => column.endsWith(ending)),
    bare = found === undefined ? column : column.slice(0, -found[0].length);
  return { name: bare.replaceAll("_", " "), unit: found === undefined ? "" : found[1] };
}

const isMeasured = (value: MeasureRow[string]): value is Measured =>
  typeof value === "object" && value !== null && !Array.isArray(value);

/** Digits after the point that the interval leaves a meaning, at most four. */
function digitsOf(value: number, half: number | null): number {
  const last = half !== null && half > 0 ? half : Math.abs(value) / 1000;
  return last > 0 ? Math.min(4, Math.max(0, 1 - Math.floor(Math.log10(last)))) : 0;
}

/** A measure with its interval and unit, or its reason. */
export function figureText(measured: Measured, unit: string): string {
  const { value, plus_minus: half, absent } = measured;
  if (value === null) return absent ?? "–";
  if (typeof measured.at_most === "number") return `≤ ${measured.at_most.toFixed(2)} ${unit}`.trim();
  const digits = digitsOf(value, half),
    number =
      half === null
        ? value.toFixed(Number.isInteger(value) ? 0 : digits)
        : `${value.toFixed(digits)} ± ${half.toFixed(digits)}`;
  return unit === "" ? number : `${number}${unit === "°" || unit === "%" ? "" : " "}${unit}`;
}

const asPlace = (value: MeasureRow[string] | undefined): Vec3 | null =>
  Array.isArray(value) && value.length === 3 ? (value as Vec3) : null;

export const placeOf = (row: MeasureRow): Vec3 | null => asPlace(row.place_mm);

/** All measures of a row, each with its own place or that of the row. */
export function figuresOf(row: MeasureRow): Figure[] {
  return Object.entries(row).flatMap(([column, value]) => {
    if (!isMeasured(value)) return [];
    const { name, unit } = splitColumn(column),
      own = asPlace(row[`${name.replaceAll(" ", "_")}_place_mm`]);
    return [{ column, name, text: figureText(value, unit), place: own ?? placeOf(row) }];
  });
}

/** The texts of a row, which name it: a vessel, or the three of a fork. */
export function titleOf(row: MeasureRow): string {
  const texts = Object.entries(row).flatMap(([column, value]) =>
    typeof value === "string" && column !== "vessels" ? [value] : [],
  );
  return [...new Set(texts)].join(", ");
}
