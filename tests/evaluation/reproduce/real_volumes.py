#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Results on the real volumes: clicks, reachable length, agreement of the walls, ends.

  real_volumes.py DATA FOLDER LUMEN [BEFORE]

Converts the volumes of DATA (aneurism-3dra.nrrd, aorta/aorta.mha, avf/avf.nii) by the clicks in tests/data with the program
LUMEN, and with an older one, BEFORE, whose cases LUMEN judges as well. The cases stay in FOLDER; so do real_volumes.md,
which is printed too, and real_volumes.json. There is no truth for these volumes: `lumen check` reports where the walls lie
beside the half-maximum edges of the volume, and which bright vessels are left out.

A click started if its label is not among those that failed. It reaches the visible end if, besides, no open end of its
branch has a vessel beyond it that `lumen check` sees; a root has two ends. Ends at another vessel are not open.
"""
import json
import os
import subprocess
import sys
import time
from pathlib import Path

CLICKS = Path(__file__).resolve().parents[2] / "data"
VOLUMES = [("3DRA", "aneurism-3dra.nrrd", "aneurism-3dra"), ("aorta", "aorta/aorta.mha", "aorta"), ("fistula", "avf/avf.nii", "avf")]


def run(*words):
    """Standard output, and seconds of wall and of processor."""
    begin = time.monotonic()
    before = os.times()
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    after = os.times()
    if done.returncode != 0:
        sys.exit(f"real_volumes.py: {' '.join(map(str, words))}\n{done.stderr}")
    processor = after.children_user + after.children_system - before.children_user - before.children_system
    return done.stdout, time.monotonic() - begin, processor


def judge(lumen, maker, volume, clicks, case):
    answer, wall, processor = run(maker, "convert", volume, case, "--seeds", clicks, "--seeds-only", "--json")
    made = json.loads(answer)
    info = json.loads(run(lumen, "info", case, "--json")[0])
    check = json.loads(run(lumen, "check", volume, case, "--json")[0])
    labels = [branch["label"] for branch in json.loads(clicks.read_text())["branches"]]
    failed = {seed["label"]: seed["reason"] for seed in made["failed_seeds"]}
    going = {}
    for end in check["ends"]:
        if end["goes_on_mm"]:
            going.setdefault(end["branch"], []).append(end)
    return {
        "clicks": len(labels), "failed": failed, "goes_on": going,
        "started": len([label for label in labels if label not in failed]),
        "whole": len([label for label in labels if label not in failed and label not in going]),
        "length": made["length_mm"], "reachable": info["reachable"], "wall": check["wall"],
        "dark": check["dark_share"], "missing": check["missing_mm"], "coverage": check["coverage_share"],
        "seconds": wall, "processor": processor,
    }


def percent(part, digits=1):
    return "-" if part is None else f"{100 * part:.{digits}f}"


def table(head, rows):
    line = "| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n"
    return line + "".join("| " + " | ".join(str(cell) for cell in row) + " |\n" for row in rows) + "\n"


def place(position):
    return "(" + ", ".join(f"{x:.0f}" for x in position) + ")"


def summary(results):
    """The table of README.md: each figure before and now, or now alone."""
    cells = {
        "vessels clicked": lambda r: r["clicks"], "started": lambda r: r["started"], "to the visible end": lambda r: r["whole"],
        "reachable, mm": lambda r: f"{r['reachable']['length_mm']:.0f} of {r['reachable']['of_mm']:.0f}",
        "wall, median": lambda r: f"{r['wall']['offset_voxels']['median']:+.2f}",
        "90 %": lambda r: f"{r['wall']['offset_voxels']['p90_absolute']:.2f}",
        "beyond a voxel": lambda r: percent(r["wall"]["beyond_voxel_share"]) + " %",
    }
    rows = []
    for name in dict.fromkeys(name for name, _ in results):
        before, now = results.get((name, "before")), results[name, "now"]
        row = [name]
        for title, cell in cells.items():
            changed = before and cell(before) != cell(now)
            row.append(f"{cell(before)} → {cell(now)}" if changed else cell(now))
        rows.append(row)
    return table(["volume", *cells], rows)


def report(results):
    rows = []
    for (name, build), r in results.items():
        voxels, reach = r["wall"]["offset_voxels"], r["reachable"]
        rows.append([name, build, r["clicks"], r["started"], r["whole"], f"{r['length']:.0f}",
                     f"{reach['length_mm']:.0f} of {reach['of_mm']:.0f}", percent(reach["length_mm"] / reach["of_mm"]),
                     f"{voxels['median']:+.2f}", f"{voxels['median_absolute']:.2f}", f"{voxels['p90_absolute']:.2f}",
                     percent(r["wall"]["beyond_voxel_share"]), percent(r["wall"]["no_edge_share"]), percent(r["dark"]),
                     f"{r['missing']:.0f}", percent(r["coverage"]), f"{r['seconds']:.1f}", f"{r['processor']:.1f}"])
    text = "# Real volumes\n\n"
    text += ("One click to a vessel, those in `tests/data`, default parameters. Reachable is what a tool can be pushed through "
             "from the roots on. The wall's offset from the half-maximum edge is in voxels, positive where the model is too "
             "wide. Missing are bright vessels that are connected with the tree, clicked or not; covered is the share of "
             "what is seen that the case holds. How each is measured: docs/method.md, section 7.\n\n")
    text += summary(results)
    text += table(["volume", "build", "clicks", "started", "to the visible end", "length mm", "reachable mm", "reachable, %",
                   "wall offset, median", "its size, median", "90 %", "beyond a voxel, %", "no edge, %", "dark lumen, %",
                   "missing mm", "covered, %", "s", "processor s"], rows)
    latest = {}
    for (name, _), result in results.items():  # of the last build
        latest[name] = result
    rows = [[name, label, reason] for name, r in latest.items() for label, reason in r["failed"].items()]
    if rows:
        text += "**Clicks that started no vessel**\n\n" + table(["volume", "click", "why"], rows)
    rows = [[name, label, "begin" if end["first"] else "end", place(end["position"]), f"{end['goes_on_mm']:.1f}"]
            for name, r in latest.items() for label, ends in r["goes_on"].items() for end in ends]
    if rows:
        text += "**Ends beyond which a vessel is seen**\n\n" + table(["volume", "click", "which", "at", "seen beyond it, mm"], rows)
    rows = [[name, p["branch"], p["node"], f"{p['beyond_mm']:.1f}"] for name, r in latest.items() for p in r["reachable"]["closed"]]
    if rows:
        text += "**Where a tool is stopped**\n\n" + table(["volume", "branch", "node", "beyond it, mm"], rows)
    return text


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    data, folder, lumen = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    folder.mkdir(parents=True, exist_ok=True)
    results = {}
    for name, file, stem in VOLUMES:
        if not (data / file).exists():
            print(f"real_volumes.py: {name} skipped, there is no {data / file}", file=sys.stderr)
            continue
        for build, maker in ([("before", sys.argv[4])] if len(sys.argv) == 5 else []) + [("now", lumen)]:
            case = folder / f"{stem}-{build}.lumen"
            results[name, build] = judge(lumen, maker, data / file, CLICKS / f"{stem}.seeds.json", case)
    (folder / "real_volumes.json").write_text(json.dumps({f"{n}, {b}": r for (n, b), r in results.items()}, indent=1) + "\n")
    text = report(results).rstrip() + "\n"
    (folder / "real_volumes.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
