// SPDX-License-Identifier: Apache-2.0
/** What an older page as one file embeds: the same values as one of today, by other names. */
import { headerEnd } from "../case/pack";
import { fromBase64, inflated, type Embedded } from "./source_embedded";

/** Names that had no unit; others differ by their spelling alone. */
const kUnits: Readonly<Record<string, string>> = {
  ...Object.fromEntries(
    (
      "beyond depth distance error greatest height length median percentile90 radius reached root_distance spacing total " +
      "voxel_size"
    )
      .split(" ")
      .map(name => [name, `${name}_mm`]),
  ),
  period: "period_s",
  time: "time_s",
  times: "times_s",
};

function nameToday(name: string): string {
  const spelt = name.replace(/[A-Z]/g, letter => `_${letter.toLowerCase()}`);
  return Object.hasOwn(kUnits, spelt) ? kUnits[spelt] : spelt;
}

/** The same value with the names of today; the content of `kept` members has its own names. */
function withNamesOfToday(value: unknown, kept: readonly string[]): unknown {
  if (Array.isArray(value)) return value.map(each => withNamesOfToday(each, kept));
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(
    Object.entries(value).map(([name, member]) =>
      kept.includes(name) ? [name, member] : [nameToday(name), withNamesOfToday(member, kept)],
    ),
  );
}

/** A pack with the names of today. Throws where its header is none. */
export function packOfToday(bytes: Uint8Array): Uint8Array {
  const end = headerEnd(bytes),
    header: unknown = JSON.parse(new TextDecoder().decode(bytes.subarray(4, end))),
    text = new TextEncoder().encode(JSON.stringify(withNamesOfToday(header, ["steps"]))),
    begin = Math.ceil((4 + text.length) / 8) * 8,
    out = new Uint8Array(begin + bytes.length - end).fill(32, 4, begin);
  new DataView(out.buffer).setUint32(0, begin - 4, true);
  out.set(text, 4);
  out.set(bytes.subarray(end), begin);
  return out;
}

/** Whether a page has the names of before. */
const isOld = ({ state }: Embedded): boolean => "hasCase" in state;

/** What a page embeds, with the names of today. */
export function embeddedToday(embedded: Embedded): Embedded {
  if (!isOld(embedded)) return embedded;
  const parts = Object.entries(embedded.parts).map(([name, part]): [string, Embedded["parts"][string]] => [
    name,
    typeof part !== "string" || name === "case.lumen" || name === "blob.wasm"
      ? part
      : async () => packOfToday(await inflated(fromBase64(part))),
  ]);
  return {
    state: withNamesOfToday(embedded.state, ["check", "figures", "revisions"]) as Embedded["state"],
    parts: Object.fromEntries(parts),
  };
}
