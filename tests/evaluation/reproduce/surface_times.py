#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The time of a closed surface over its number of triangles.

  surface_times.py LUMEN FOLDER CASE [REPEATS [BEFORE]]

LUMEN and BEFORE are builds of the program. Runs `lumen convert CASE SURFACE.vtp --edge SHARE` with shares of the radius that give
10,000 to 4 million triangles, REPEATS times each (usually once), with both builds in turn, and takes the least processor time of each.
FOLDER gets surface_times.md, which is printed too, and surface_times.plot.json for plots.py.
"""
import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path

COUNTS = [10_000, 30_000, 100_000, 300_000, 1_000_000, 2_000_000, 4_000_000]
FIRST_SHARE = 0.25  # radii: the usual edge, which shows how many triangles the case has
LONGEST_SHARE = 0.78  # radii: an eighth of the circumference, above which no edge grows longer
TOLERANCE = 1.15  # of a number of triangles


def make(lumen, case, out, share):
    """Triangles, seconds of wall and of processor, and MB at most."""
    begin = time.monotonic()
    process = subprocess.Popen([lumen, "convert", case, out, "--edge", f"{share:.4g}r", "--json", "--quiet"], stdout=subprocess.PIPE)
    answer = process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    wall = time.monotonic() - begin
    if status != 0:
        sys.exit(f"surface_times.py: {lumen} fails with an edge of {share:.4g} radii")
    return json.loads(answer)["surface"]["triangles"], wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def share_for(wanted, known):
    """The edge for a number of triangles, from the runs so far: triangles fall with its square."""
    share, triangles = min(known, key=lambda run: abs(math.log(run[1] / wanted)))
    return min(LONGEST_SHARE, share * math.sqrt(triangles / wanted))


def measure(builds, case, folder, repeats):
    known, rows = [(FIRST_SHARE, make(builds[-1], case, folder / "surface.vtp", FIRST_SHARE)[0])], []
    for wanted in COUNTS:
        share = share_for(wanted, known)
        if rows and share >= LONGEST_SHARE:
            continue
        for _ in range(2):  # the second look corrects the square law, which fails where edges are long
            runs = [[make(lumen, case, folder / "surface.vtp", share) for lumen in builds] for _ in range(repeats)]
            found = runs[0][-1][0]
            known.append((share, found))
            better = share_for(wanted, known)
            if 1 / TOLERANCE < found / wanted < TOLERANCE or better == share:
                break
            share = better
        best = [min((run[b] for run in runs), key=lambda one: one[2]) for b in range(len(builds))]
        rows.append((share, best))
        print(f"{best[-1][0]} triangles: {best[-1][2]:.1f} s", file=sys.stderr, flush=True)
    return rows


def report(rows, case, names):
    head = ["edge, radii"] + [f"{title}{name}" for name in names
                              for title in ("triangles", "s", "processor s", "us of processor a triangle", "MB")]
    text = "# Time of a surface over its triangles\n\n"
    text += (f"`lumen convert {case.name} SURFACE.vtp --edge SHARE`, by `surface_times.py`: seconds of wall and of processor for the whole "
             "command, which reads the case and writes the file, too.\n\n")
    text += "| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n"
    for share, best in rows:
        cells = [f"{share:.3g}"]
        for triangles, wall, processor, memory in best:
            cells += [f"{triangles:,}", f"{wall:.1f}", f"{processor:.1f}", f"{1e6 * processor / triangles:.1f}", f"{memory:.0f}"]
        text += "| " + " | ".join(cells) + " |\n"
    first, last = rows[0][1][-1], rows[-1][1][-1]
    slope = math.log(last[2] / first[2]) / math.log(last[0] / first[0])
    return text + f"\nFrom the first row to the last, processor time grows with the power {slope:.2f} of the triangles.\n"


def plot(rows, names):
    curves = []
    for b, name in enumerate(names):
        curves.append({"name": "processor" + name, "dashed": False, "points": [[best[b][0], round(best[b][2], 3)] for _, best in rows]})
    at, _, seconds, _ = min((best[-1] for _, best in rows), key=lambda run: abs(math.log(run[0] / 1e6)))
    line = [[best[-1][0], round(seconds * best[-1][0] / at, 3)] for _, best in rows]
    curves.append({"name": "proportional", "dashed": True, "points": line})
    return {"title": "Time of a closed surface", "x": "triangles", "y": "s", "logarithmic": True, "logarithmic_x": True, "curves": curves}


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    lumen, folder, case = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    repeats = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    builds, names = ([sys.argv[5], lumen], [", before", ", now"]) if len(sys.argv) > 5 else ([lumen], [""])
    folder.mkdir(parents=True, exist_ok=True)
    rows = measure(builds, case, folder, repeats)
    text = report(rows, case, names)
    (folder / "surface_times.md").write_text(text)
    (folder / "surface_times.plot.json").write_text(json.dumps(plot(rows, names)) + "\n")
    print(text, end="")


if __name__ == "__main__":
    main()
