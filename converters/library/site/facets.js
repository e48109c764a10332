// SPDX-License-Identifier: Apache-2.0
// The search among a library's cases: the cases, their facets, and the state of the search, which also stands
// behind the "#" of the address. It touches no element; gallery.js shows it.
"use strict";
globalThis.lumenFacets = (() => {
  const kSides = { unknown: "not stated" };
  const kModalities = { XA: "X-ray angiography", US: "ultrasound" };

  /** Text as it is searched: without accents, in small letters. */
  const folded = text => text.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase();

  /** The rows of cases.js, in its order (gallery_page.cpp, searchRow). */
  const cases = (globalThis.lumenCases ?? []).map((row, place) => {
    const [id, title, anatomy, side, modality, synthetic, licence, vessels, aneurysms, length, narrowest, widest, picture, words, tortuosity, turning, takeOff, stenosis, reach, neck] = row;
    return {
      place, id, title, anatomy, side: kSides[side] ?? side, modality: kModalities[modality] ?? modality, synthetic: synthetic === 1, licence, vessels, aneurysms,
      length, narrowest, widest, tortuosity, turning, takeOff, stenosis, reach, neck, picture, text: folded([title, anatomy, id, words].join("\n")),
    };
  });

  /** Facets of cases. A case matches several values of one facet if it has any, and several facets if it matches all. */
  const kFacets = [
    { key: "anatomy", title: "Anatomy", of: c => c.anatomy || "not stated" },
    { key: "side", title: "Side", of: c => c.side },
    { key: "modality", title: "Source", of: c => c.modality },
    { key: "patient", title: "Patient or synthetic", of: c => (c.synthetic ? "synthetic" : "patient") },
    { key: "aneurysm", title: "Aneurysm", of: c => (c.aneurysms > 0 ? "with" : "without") },
    { key: "licence", title: "Licence", of: c => c.licence },
  ];
  /** Ranges, ends included, with their units. A case without the measure (null) is in no range of it. */
  const kRanges = [
    { key: "length", title: "Length of all vessels", unit: "mm", of: c => c.length },
    { key: "narrowest", title: "Smallest radius", unit: "mm", of: c => c.narrowest },
    { key: "widest", title: "Greatest radius", unit: "mm", of: c => c.widest },
    { key: "tortuosity", title: "Greatest tortuosity of a path", unit: "", of: c => c.tortuosity },
    { key: "turning", title: "Greatest turning of a path", unit: "°/cm", of: c => c.turning },
    { key: "take-off", title: "Greatest take-off angle", unit: "°", of: c => c.takeOff },
    { key: "stenosis", title: "Greatest stenosis (NASCET)", unit: "%", of: c => c.stenosis },
    { key: "aneurysm-reach", title: "Aneurysm, from neck to tip", unit: "mm", of: c => c.reach },
    { key: "aneurysm-neck", title: "Aneurysm, neck", unit: "mm", of: c => c.neck },
  ];
  const byNumber = of => (a, b) => (of(b) ?? -Infinity) - (of(a) ?? -Infinity) || a.place - b.place;
  const kOrders = [
    { key: "title", title: "Title", compare: (a, b) => a.place - b.place },
    { key: "longest", title: "Longest first", compare: byNumber(c => c.length) },
    { key: "shortest", title: "Shortest first", compare: byNumber(c => -c.length) },
    { key: "vessels", title: "Most vessels first", compare: byNumber(c => c.vessels) },
    { key: "widest", title: "Widest first", compare: byNumber(c => c.widest) },
    { key: "narrowest", title: "Narrowest first", compare: byNumber(c => -c.narrowest) },
    { key: "tortuous", title: "Most tortuous first", compare: byNumber(c => c.tortuosity) },
    { key: "stenosed", title: "Greatest stenosis first", compare: byNumber(c => c.stenosis) },
    { key: "aneurysm", title: "Largest aneurysm first", compare: byNumber(c => c.reach) },
  ];

  const emptyState = page => ({
    words: "", chosen: new Map(kFacets.map(f => [f.key, new Set()])), ranges: new Map(kRanges.map(r => [r.key, [null, null]])), order: "title", page,
  });
  const numberOr = text => (text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : null);

  /** The word of a range in addresses. */
  const wordOf = key => (key === "widest" || key === "narrowest" ? `${key}-radius` : key);

  /** The state that an address means; what it does not know of, it leaves out. */
  function parse(fragment, firstPage) {
    const state = emptyState(firstPage), given = new URLSearchParams(fragment.replace(/^#/, ""));
    state.words = given.get("q") ?? "";
    for (const { key } of kFacets) for (const value of given.getAll(key)) state.chosen.get(key).add(value);
    for (const { key } of kRanges) {
      const [low, high] = (given.get(wordOf(key)) ?? "").split("..");
      state.ranges.set(key, [numberOr(low ?? ""), numberOr(high ?? "")]);
    }
    if (kOrders.some(o => o.key === given.get("sort"))) state.order = given.get("sort");
    const page = Number(given.get("page"));
    if (Number.isInteger(page) && page > 0) state.page = page;
    else if (given.size > 0) state.page = 1;
    return state;
  }

  /** The address of a state; empty for all cases in order, on the page that was opened. */
  function format(state, firstPage) {
    const words = new URLSearchParams();
    if (state.words.trim() !== "") words.set("q", state.words);
    for (const { key } of kFacets) for (const value of state.chosen.get(key)) words.append(key, value);
    for (const { key } of kRanges) {
      const [low, high] = state.ranges.get(key);
      if (low !== null || high !== null) words.set(wordOf(key), `${low ?? ""}..${high ?? ""}`);
    }
    if (state.order !== "title") words.set("sort", state.order);
    if (state.page !== (words.size > 0 ? 1 : firstPage)) words.set("page", String(state.page));
    return words.toString();
  }

  /** Result of the search: the cases in order, and for each facet how many cases each value would give, the others being as they are. */
  function find(state) {
    const words = folded(state.words).split(/\s+/).filter(word => word !== "");
    const ranges = kRanges.map(({ key, of }) => ({ of, ends: state.ranges.get(key) })).filter(({ ends }) => ends[0] !== null || ends[1] !== null);
    const chosen = kFacets.map(({ key, of }) => ({ of, values: state.chosen.get(key) }));
    const counts = new Map(kFacets.map(f => [f.key, new Map()])), found = [];
    for (const c of cases) {
      if (!words.every(word => c.text.includes(word))) continue;
      if (!ranges.every(({ of, ends: [low, high] }) => of(c) !== null && (low === null || of(c) >= low) && (high === null || of(c) <= high))) continue;
      const missed = chosen.filter(({ of, values }) => values.size > 0 && !values.has(of(c)));
      if (missed.length === 0) found.push(c);
      for (const [i, { key, of }] of kFacets.entries())
        if (missed.length === 0 || (missed.length === 1 && missed[0] === chosen[i])) {
          const count = counts.get(key);
          count.set(of(c), (count.get(of(c)) ?? 0) + 1);
        }
    }
    found.sort(kOrders.find(o => o.key === state.order).compare);
    return { found, counts };
  }

  /** All values of a facet, the commonest first. */
  function valuesOf(facet) {
    const counts = new Map();
    for (const c of cases) counts.set(facet.of(c), (counts.get(facet.of(c)) ?? 0) + 1);
    return [...counts].sort(([a, n], [b, m]) => m - n || (a < b ? -1 : 1)).map(([value]) => value);
  }

  return { cases, facets: kFacets, ranges: kRanges, orders: kOrders, emptyState, parse, format, find, valuesOf, numberOr };
})();
