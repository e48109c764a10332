// SPDX-License-Identifier: Apache-2.0
/** Places where a vessel is narrower or wider than a reference that tapers as the vessel does. */

export interface Place {
  kind: "stenosis" | "dilation";
  from: number;
  to: number;
  at: number;
  share: number;
}

const kStenosis = 0.3; // of the diameter missing: below that nobody calls it one
const kDilation = 0.5; // of the diameter more: the usual bound between ectasia and aneurysm
const kLeastMarginRadii = 1.5; // reference radii that a vessel must go on for on either side
const kReferenceRadii = 8; // reference radii on either side from which the reference is made

/** The reference at each sample: the median of the radii within kReferenceRadii times the vessel's own median radius. */
export function reference(s: ArrayLike<number>, r: ArrayLike<number>): Float64Array {
  const n = s.length,
    out = new Float64Array(n),
    all = Float64Array.from(r).sort(),
    reach = kReferenceRadii * (all[n >> 1] ?? 0);
  for (let i = 0, low = 0, high = 0; i < n; ++i) {
    while (s[low] < s[i] - reach) ++low;
    while (high < n && s[high] <= s[i] + reach) ++high;
    const window = Array.from({ length: high - low }, (_, k) => r[low + k]).sort((a, b) => a - b);
    out[i] = window[window.length >> 1];
  }
  return out;
}

/** Runs of samples beyond the bounds; `share` is the part of the diameter that is missing or too much. Diameters that
 * differ by less than `voxel` mm are not told apart by the volume, and make no place. */
export function findPlaces(s: ArrayLike<number>, r: ArrayLike<number>, voxel = 0): Place[] {
  const n = s.length,
    places: Place[] = [];
  if (n < 5) return places;
  const ref = reference(s, r),
    deviation = Float64Array.from({ length: n }, (_, i) => r[i] / ref[i] - 1);
  for (let i = 0; i < n; ++i) {
    const kind = deviation[i] < -kStenosis ? "stenosis" : deviation[i] > kDilation ? "dilation" : null;
    if (kind === null) continue;
    let end = i,
      at = i;
    while (
      end + 1 < n &&
      (kind === "stenosis" ? deviation[end + 1] < -kStenosis : deviation[end + 1] > kDilation)
    ) {
      ++end;
      if (Math.abs(deviation[end]) > Math.abs(deviation[at])) at = end;
    }
    // an end that peters out is no stenosis: the vessel must go on beyond it
    const margin = kLeastMarginRadii * ref[at];
    const isSeen = 2 * Math.abs(r[at] - ref[at]) >= voxel;
    if (isSeen && s[i] - s[0] > margin && s[n - 1] - s[end] > margin)
      places.push({ kind, from: i, to: end, at, share: Math.abs(deviation[at]) });
    i = end;
  }
  return places;
}
