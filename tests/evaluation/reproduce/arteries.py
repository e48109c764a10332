#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How much of real arterial trees and of synthetic patients is found, by one click to a vessel.

  arteries.py VESSELS DATA FOLDER LUMEN [BEFORE]

VESSELS is the program lumen_vessels. Runs it with LUMEN on the trees DATA/arteries/*.swc (0.3 mm, 6 % of noise) and ten
patients, parents named; on the trees again without parents, and with clicks within the parent's lumen; and the same with
an older program, BEFORE, unless FOLDER has its figures (before*.json) from an earlier run. Volumes, cases and reports stay
in FOLDER, 2 GB of them; so does arteries.md, which is printed too.
"""
import json
import subprocess
import sys
from pathlib import Path

PATIENTS = [f"patient-{seed}" for seed in range(1, 11)]
RUNS = [("", "", "all"), (", no parents named", "-no-parents", "trees", "--no-parents"),
        (", clicks within the parent's lumen", "-near", "trees", "--near")]
SHOWN = ["case", "clicks", "started", "clicked mm", "covered, %", "not covered, thin, mm", "false, %", "reachable mm", "of mm",
         "wall, median mm", "radius bias mm", "track, processor s", "fit, processor s"]


def read(report):
    return {table["title"]: table["rows"] for table in json.loads(report.read_text())["tables"]}


def tables(vessels, folder, tag, lumen, subjects, *options):
    subprocess.run([vessels, *options, "--tag", tag, lumen, folder, *subjects], check=True, stdout=subprocess.DEVNULL)
    return read(folder / f"{tag}.json")


def cell(value):
    return "-" if value is None else f"{value:.3g}" if isinstance(value, float) else str(value)


def markdown(title, rows, columns):
    if not rows:
        return ""
    lines = [f"**{title}**", "", "| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    lines += ["| " + " | ".join(cell(row[column]) for column in columns) + " |" for row in rows]
    return "\n".join(lines) + "\n\n"


def summary(named):
    """The table of README.md: the sums of each set of runs."""
    lines = ["| | clicks | started | length covered | false | reachable |", "|---|---|---|---|---|---|"]
    for title, report in named:
        for kind, wanted in (("six trees", lambda case: case not in PATIENTS), ("ten patients", lambda case: case in PATIENTS)):
            cases = [row for row in report["Cases"] if wanted(row["case"]) and not row["case"].startswith("all")]

            def total(column):
                return sum(float(row[column]) for row in cases)

            if cases:
                shares = [total("covered mm") / total("clicked mm"), total("false mm") / total("found mm"),
                          total("reachable mm") / total("of mm")]
                lines.append(f"| {kind}, {title} | {total('clicks'):.0f} | {total('started'):.0f} | " +
                             " | ".join(f"{100 * share:.1f} %" for share in shares) + " |")
    return "\n".join(lines) + "\n\n"


def main():
    if len(sys.argv) not in (5, 6):
        sys.exit(__doc__)
    vessels, data, folder, lumen = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4]
    trees = sorted(str(file) for file in (data / "arteries").glob("*.swc"))
    if not trees:
        print(f"arteries.py: no trees, there is no {data / 'arteries'}/*.swc", file=sys.stderr)
    builds = [("now", lumen)] + ([("before", sys.argv[5])] if len(sys.argv) == 6 else [])
    named = []
    for build, program in builds:
        for what, tag, subjects, *options in RUNS:
            if subjects := (trees if subjects == "trees" else trees + PATIENTS):
                known = folder / f"{build}{tag}.json"
                keep = build == "before" and known.exists()
                rows = read(known) if keep else tables(vessels, folder, build + tag, program, subjects, *options)
                named.append((build + what, rows))
    now = named[0][1]
    text = "# Real arterial trees and synthetic patients\n\n"
    text += ("The six trees (see their README; healthy adults, BraVa) are drawn as volumes of 0.3 mm with 6 % of noise, the "
             "patients are `lumen phantom patient` with seeds 1 to 10. One click to a vessel near its start, a fifth of a radius "
             "off its axis (a quarter for patients), parents named; of the trees every vessel longer than 5 mm with a median "
             "radius of 1.5 voxels or more. A true point is covered if an axis of the case passes within the true radius, "
             "whatever its label. An axis is false where it is farther than half a voxel from every true lumen. Thin is what has a "
             "radius below 1.5 voxels there. Clicks within the parent's lumen lie one radius from where the axis begins.\n\n")
    text += summary(named)
    for title, report in named:
        text += markdown(title.capitalize(), report["Cases"], SHOWN)
    long = [row for row in now["Not covered"] if float(row["length mm"]) >= 2]
    text += markdown("Now, not covered over 2 mm or more", long, ["case", "branch", "its click", "from mm", "to mm", "place", "radius mm"])
    long = [row for row in now["False"] if float(row["length mm"]) >= 2]
    text += markdown("Now, false over 2 mm or more", long, ["case", "branch", "from mm", "to mm", "place", "radius mm"])
    text = text.rstrip() + "\n"
    (folder / "arteries.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
