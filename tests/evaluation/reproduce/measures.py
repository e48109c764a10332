#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures of phantoms with closed forms, from volumes with noise, beside their truth.

measures.py FOLDER LUMEN [SEEDS [NAME ...]]

Draws each phantom with 5 % noise and voxels of 0.2 mm SEEDS times (10), converts and measures it. Writes
FOLDER/measures.md: for each measure the truth, the median and its error, the target, and the share of 95 % intervals
that hold the truth; then changes at half and twice the step, and at 0.7 and 1.4 times the voxel. A length is compared
between the places of the true axis that are nearest to the first and the last station: that a track ends before the
vessel does is no error of the measure."""
import argparse, json, math, pathlib, statistics, subprocess

VOXEL, EXTENT = 0.2, 25.4
# Kinds of measures: (target, whether it is relative).
TARGETS = {"length": (0.005, True), "curvature": (0.03, True), "torsion": (0.08, True), "area": (0.02, True),
           "angle": (2.0, False), "volume": (0.02, True), "index": (0.03, True), "share": (0.03, False)}
CURVED = ("helix", "coil", "arc")
NAMES = ("tube", "helix", "coil", "arc", "cone", "ellipse-tube", "stenosis", "fork", "sac-sphere", "sac-ellipsoid",
         "sac-fork")
SAC = (("neck_diameter_mm", "index"), ("neck_area_mm2", "area"), ("height_mm", "index"), ("width_mm", "index"),
       ("dome_volume_mm3", "volume"), ("dome_area_mm2", "area"), ("aspect_ratio", "index"), ("size_ratio", "index"),
       ("bottleneck_factor", "index"), ("undulation_index", "share"), ("ellipticity_index", "share"),
       ("non_sphericity_index", "share"), ("inflow_angle_deg", "angle"))


def run(*command):
    subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def shown(value):
    return "-" if value is None or value != value else f"{value:.4g}"


class Case:
    """A phantom, its truth, and what `lumen measure` reports of the case that its volume gives."""

    def __init__(self, folder, lumen, name, seed, voxel=VOXEL, step=None):
        size = round(EXTENT / voxel) + 1
        stem = folder / f"{name}-{seed}-{round(1000 * voxel)}"
        case = stem.with_suffix(".lumen")
        if not case.exists():
            volume, seeds = stem.with_suffix(".nrrd"), stem.with_suffix(".json")
            run(lumen, "phantom", name, volume, "--truth", stem.with_suffix(".truth.lumen.json"), "--seeds", seeds,
                "--seed", seed, "--voxel", voxel, "--size", size, "--noise", 0.05)
            run(lumen, "convert", volume, "--seeds", seeds, case)
            volume.unlink()
        truth = json.loads(pathlib.Path(stem.with_suffix(".truth.lumen.json")).read_text())
        self.notes = {k[5:]: v for k, v in truth["metadata"]["steps"][0]["parameters"].items() if k.startswith("true.")}
        tree, first = truth["tree"], truth["tree"]["branches"][0]
        self.axis = tree["centre"][first["firstNode"]:first["firstNode"] + first["nodeCount"]]
        self.radius = tree["radius"][first["firstNode"]:first["firstNode"] + first["nodeCount"]]
        out = folder / f"{stem.name}{'' if step is None else f'-{step:g}'}-measures.json"
        run(lumen, "measure", case, "--out", out, *([] if step is None else ["--step", step]))
        self.measures = json.loads(out.read_text())["cases"][0]
        out.unlink()

    def along(self, place):
        """Arc length of the truth at the place of its first branch that is nearest, mm, with the radius there."""
        best = min(range(len(self.axis)), key=lambda i: math.dist(self.axis[i], place))
        arc = sum(math.dist(self.axis[i], self.axis[i + 1]) for i in range(best))
        # along the true direction, as nodes are half a voxel apart
        a, b = self.axis[max(0, best - 1)], self.axis[min(len(self.axis) - 1, best + 1)]
        length = math.dist(a, b)
        arc += sum((p - c) * (y - x) for p, c, x, y in zip(place, self.axis[best], a, b)) / length
        return arc, self.radius[best]

    def stations(self):
        return [s for s in self.measures["stations"] if s["vessel"] == "root"]

    def vessel(self):
        return next(v for v in self.measures["vessels"] if v["vessel"] == "root")

    def values(self, name):
        """Triples of a measure's name and kind, and its pairs of (measured value, truth)."""
        notes = {k.split(".", 1)[1]: v for k, v in self.notes.items()}
        if name.startswith("sac-"):
            sac = (self.measures["sacs"] or [None])[0]
            yield from ((m, kind, [(sac[m], notes[m])] if sac else []) for m, kind in SAC)
            return
        if name == "fork":
            fork = (self.measures["forks"] or [None])[0]
            for m, truth, kind in (("angle_deg", "fork_between_deg", "angle"),
                                   ("larger_take_off_deg", "fork_continuing_in_plane_deg", "angle"),
                                   ("smaller_take_off_deg", "fork_branching_in_plane_deg", "angle"),
                                   ("larger_in_plane_deg", "fork_continuing_in_plane_deg", "angle"),
                                   ("smaller_in_plane_deg", "fork_branching_in_plane_deg", "angle"),
                                   ("parent_out_of_plane_deg", "fork_out_of_plane_deg", "angle"),
                                   ("area_ratio", "fork_area_ratio", "area"), ("asymmetry", "fork_asymmetry", "area"),
                                   ("murray_exponent", "fork_murray_exponent", "index")):
                yield m, kind, [(fork[m], notes[truth])] if fork else []
            return
        if name == "stenosis":
            found = [n for n in self.measures["narrowings"] if n["finding"] == "narrowing"]
            for m, truth in (("nascet_percent", 100 * notes["stenosis_diameter_degree"]),
                             ("area_percent", 100 * notes["stenosis_area_degree"]),
                             ("diameter_mm", 2 * notes["stenosis_smallest_radius_mm"])):
                yield m, "index", [(found[0][m], truth)] if found else []
            return
        yield from self.tube_values(notes)

    def tube_values(self, notes):
        stations, vessel = self.stations(), self.vessel()
        # a track may run against the truth
        begin, end = sorted(self.along(stations[i]["place_mm"])[0] for i in (0, -1))
        sense = 1 if self.along(stations[0]["place_mm"])[0] == begin else -1
        length = end - begin
        yield "length_mm", "length", [(vessel["length_mm"], length)]
        if notes.get("curvature_per_mm"):
            yield "curvature_per_mm", "curvature", [(s["curvature_per_mm"], notes["curvature_per_mm"]) for s in stations]
            yield "mean_curvature_per_mm", "curvature", [(vessel["mean_curvature_per_mm"], notes["curvature_per_mm"])]
        if notes.get("torsion_per_mm"):
            yield "torsion_per_mm", "torsion", [(s["torsion_per_mm"], notes["torsion_per_mm"]) for s in stations]
        if "first_radius_mm" in notes:
            # a cone: sections follow from the balls that touch it
            total = notes["length_mm"]
            first, last = (math.sqrt(notes[k] / math.pi) for k in ("first_section_area_mm2", "last_section_area_mm2"))
            at = lambda arc: first + (last - first) * arc / total
            yield "area_mm2", "area", [(s["area_mm2"], math.pi * at(self.along(s["place_mm"])[0]) ** 2)
                                       for s in stations]
            a, b = at(begin), at(end)
            yield "volume_mm3", "volume", [(vessel["volume_mm3"], math.pi * length * (a * a + a * b + b * b) / 3)]
            slope = (a - b) / length
            yield "wall_area_mm2", "area", [(vessel["wall_area_mm2"],
                                             math.pi * (a + b) * length * math.sqrt(1 + slope * slope))]
            yield "taper_mm_per_mm", "index", [(vessel["taper_mm_per_mm"], sense * 2 * slope)]
        if "section_area_mm2" in notes:
            yield "area_mm2", "area", [(s["area_mm2"], notes["section_area_mm2"]) for s in stations]
            yield "volume_mm3", "volume", [(vessel["volume_mm3"], notes["section_area_mm2"] * length)]
            yield "wall_area_mm2", "area", [(vessel["wall_area_mm2"],
                                             notes["wall_area_mm2"] * length / notes["length_mm"])]
        if "radius_mm" in notes:
            yield "inscribed_radius_mm", "index", [(s["inscribed_radius_mm"], notes["radius_mm"]) for s in stations]
        for m, kind in (("perimeter_mm", "index"), ("smallest_diameter_mm", "index"), ("largest_diameter_mm", "index"),
                        ("circularity", "share")):
            if m in notes: yield m, kind, [(s[m], notes[m]) for s in stations]


def defined(pairs):
    return [(v["value"], v["plus_minus"], t) for v, t in pairs if v["value"] is not None]


def gather(cases, name):
    """By measure: kind, medians over the places of each case, truths, and (held, counted) intervals."""
    rows = {}
    for case in cases:
        for measure, kind, pairs in case.values(name):
            row = rows.setdefault(measure, {"kind": kind, "values": [], "truth": [], "pm": [], "held": 0, "counted": 0})
            places = defined(pairs)
            if not places: continue
            row["values"].append(statistics.median(v for v, _, _ in places))
            row["truth"].append(statistics.median(t for _, _, t in places))
            known = [(v, pm, t) for v, pm, t in places if pm is not None]
            if known: row["pm"].append(statistics.median(pm for _, pm, _ in known))
            row["held"] += sum(abs(v - t) <= pm for v, pm, t in known)
            row["counted"] += len(known)
    return rows


def error(row):
    """The median error over all cases, as the target counts it."""
    _, relative = TARGETS[row["kind"]]
    return statistics.median((v - t) / t if relative else v - t for v, t in zip(row["values"], row["truth"]))


def percent(value, kind):
    return f"{100 * value:+.2f} %" if TARGETS[kind][1] else f"{value:+.3g}"


def accuracy_table(name, rows, cases, lines):
    for measure, row in rows.items():
        target, relative = TARGETS[row["kind"]]
        wanted = f"{100 * target:g} %" if relative else f"{target:g}"
        if not row["values"]:
            lines.append(f"| {name} | {measure} | - | - | - | {wanted} | - | - | missed: 0 of {len(cases)} |")
            continue
        off = error(row)
        held = f"{100 * row['held'] / row['counted']:.0f} % of {row['counted']}" if row["counted"] else "-"
        verdict = "met" if abs(off) <= target else "missed"
        if len(row["values"]) < len(cases): verdict += f", {len(row['values'])} of {len(cases)}"
        lines.append(f"| {name} | {measure} | {shown(statistics.median(row['truth']))} "
                     f"| {shown(statistics.median(row['values']))} | {percent(off, row['kind'])} | {wanted} "
                     f"| {shown(statistics.median(row['pm'])) if row['pm'] else '-'} | {held} | {verdict} |")


def changes(before, after):
    """Shares of the 95 % intervals by which measures change, relative to their truths."""
    for measure, row in before.items():
        other = after.get(measure)
        if not other or not row["values"] or not other["values"] or not row["pm"]: continue
        a, b = (statistics.median(v - t for v, t in zip(r["values"], r["truth"])) for r in (row, other))
        interval = statistics.median(row["pm"])
        if interval > 0: yield measure, abs(a - b) / interval


def change_table(title, found, lines):
    over = [(name, m, c) for name, m, c in found if c > 1]
    lines += ["", f"## {title}", "",
              f"{len(found) - len(over)} of {len(found)} measures change by less than their interval"
              + (":" if over else "."), ""]
    if over: lines += ["| phantom | measure | change / interval |", "|---|---|--:|"]
    lines += [f"| {name} | {m} | {c:.2f} |" for name, m, c in sorted(over, key=lambda x: -x[2])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("lumen")
    parser.add_argument("seeds", type=int, nargs="?", default=10)
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    lines = ["# Measures beside closed forms", "",
             f"`measures.py`, {options.seeds} noise seeds; median over places, then over seeds.", "",
             "| phantom | measure | truth | median | error | target | ± | intervals that hold the truth | target |",
             "|---|---|--:|--:|--:|--:|--:|--:|---|"]
    steps, voxels = {0.5: [], 2.0: []}, {0.7: [], 1.4: []}
    held = counted = 0
    for name in options.names or NAMES:
        make = lambda seed, **more: Case(options.folder, options.lumen, name, seed, **more)
        cases = [make(seed) for seed in range(1, options.seeds + 1)]
        rows = gather(cases, name)
        accuracy_table(name, rows, cases, lines)
        held += sum(r["held"] for r in rows.values())
        counted += sum(r["counted"] for r in rows.values())
        places = [s["along_mm"]["value"] for s in cases[0].measures["stations"][:2]]
        step = places[1] - places[0]
        few = range(1, min(2, options.seeds) + 1)
        base = gather(cases[:len(few)], name)
        for factor, found in steps.items():
            other = gather([make(seed, step=factor * step) for seed in few], name)
            found += [(name, m, c) for m, c in changes(base, other)]
        for factor, found in voxels.items():
            other = gather([make(seed, voxel=round(factor * VOXEL, 4)) for seed in few], name)
            found += [(name, m, c) for m, c in changes(base, other)]
        print(name, flush=True)
    lines += ["", f"{100 * held / max(counted, 1):.1f} % of {counted} intervals hold the truth."]
    for factor, found in steps.items(): change_table(f"{factor:g} times the step", found, lines)
    for factor, found in voxels.items(): change_table(f"{factor:g} times the voxel", found, lines)
    (options.folder / "measures.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
