#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Arterial trees drawn into a real scan, and what lumen finds of them without a click.

  drawn_into.py DATA FOLDER LUMEN [TREE ...]
  drawn_into.py score LUMEN FOUND TRUTH

Draws each tree of DATA/arteries (TREE: names of files, without ending) into the head CT of DATA/prior, converts the volume with default
options, and scores the case. Volumes and cases stay in FOLDER, and so does drawn_into.md, which is printed too. The axis y of the trees
runs from the neck to the crown, which is z in the scan.

The second form scores one case, or a volume, which it converts first. Found: share of the length of true vessels with a diameter over a
voxel (the cubic root of its volume) that lies within a true radius or a voxel of a found axis. False: share of the found length that
lies farther from every true axis.
"""
import itertools
import json
import math
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path

UPRIGHT = "90,0,0"
STEP = 0.25  # mm between samples of an axis
CELL = 2.0  # mm


def run(*words):
    """The JSON answer and the seconds that it took."""
    begin = time.monotonic()
    done = subprocess.run([str(word) for word in words] + ["--json", "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode != 0: sys.exit(f"drawn_into.py: {' '.join(map(str, words))}\n{done.stderr}")
    return json.loads(done.stdout), time.monotonic() - begin


def read_swc(file):
    """The nodes of a tree in mm."""
    rows = [line.split() for line in Path(file).read_text().splitlines() if line.strip() and line[0] != "#"]
    place = {row[0]: k for k, row in enumerate(rows)}
    return {"centre": [[float(x) for x in row[2:5]] for row in rows], "radius": [float(row[5]) for row in rows],
            "parent": [place.get(row[6], -1) for row in rows]}


class Axes:
    """The axes of a case as short pieces (middle, radius, length), which are looked up by place."""

    def __init__(self, lumen, case):
        if Path(case).suffix == ".swc": tree, voxel = read_swc(case), None
        else:
            with tempfile.TemporaryDirectory() as folder:
                twin = Path(folder) / "case.lumen.json"
                run(lumen, "convert", case, twin)
                whole = json.loads(twin.read_text())
            tree, voxel = whole["tree"], whole["metadata"].get("voxelSize")
        self.voxel, self.pieces, self.cells = voxel, [], defaultdict(list)
        for node, parent in enumerate(tree["parent"]):
            if parent < 0: continue
            a, b, r, s = tree["centre"][parent], tree["centre"][node], tree["radius"][parent], tree["radius"][node]
            count = math.ceil(math.dist(a, b) / STEP)
            for t in ((i + 0.5) / count for i in range(count)):
                piece = [p + t * (q - p) for p, q in zip(a, b)], r + t * (s - r), math.dist(a, b) / count
                self.pieces.append(piece)
                self.cells[tuple(x // CELL for x in piece[0])].append(piece)

    def near(self, point, reach):
        """The pieces whose middles may lie within `reach` of a point."""
        spans = [range(int((x - reach) // CELL), int((x + reach) // CELL) + 1) for x in point]
        for cell in itertools.product(*spans): yield from self.cells.get(cell, ())


def score(lumen, case, truth):
    """True length that counts, the share of it that is found, found length, the share of it that is false."""
    return compare(Axes(lumen, truth), Axes(lumen, case))


def compare(true, found):
    """The same of axes."""
    voxel, widest = true.voxel, max(radius for _, radius, _ in true.pieces)
    wide = [(p, max(r, voxel), length) for p, r, length in true.pieces if 2 * r > voxel]
    held = sum(length for p, reach, length in wide if any(math.dist(p, q) <= reach for q, _, _ in found.near(p, reach)))
    right = sum(length for p, _, length in found.pieces
                if any(math.dist(p, q) <= max(r, voxel) for q, r, _ in true.near(p, max(widest, voxel))))
    true_mm, found_mm = sum(piece[2] for piece in wide), sum(piece[2] for piece in found.pieces)
    return true_mm, held / true_mm if true_mm else 1, found_mm, 1 - right / found_mm if found_mm else 0


def row(lumen, name, found, truth, folder):
    """A row of the table for a case, or for a volume, which is converted into `folder`."""
    time_taken = "-"
    if found.suffix != ".lumen":
        case = folder / f"{name}.lumen"
        _, seconds = run(lumen, "convert", found, case)
        found, time_taken = case, f"{seconds:.0f}"
    true_mm, share, found_mm, false = score(lumen, found, truth)
    return f"| {name} | {true_mm:.0f} | {share:.3f} | {found_mm:.0f} | {false:.3f} | {time_taken} |"


def main():
    heading = "| tree | mm over a voxel | found | mm found | false | s |\n|---|---|---|---|---|---|"
    if sys.argv[1] == "score":
        lumen, found, truth = sys.argv[2], *map(Path, sys.argv[3:])
        with tempfile.TemporaryDirectory() as folder: print(heading, row(lumen, found.stem, found, truth, Path(folder)), sep="\n")
        return
    data, folder, lumen, *names = sys.argv[1:]
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    lines = [heading]
    for tree in sorted(Path(data, "arteries").glob("*.swc")):
        if names and tree.stem not in names: continue
        volume, truth = folder / f"{tree.stem}.nrrd", folder / f"{tree.stem}.truth.lumen"
        run(lumen, "phantom", "--tree", tree, "--into", Path(data, "prior/head-ct-native.nrrd"), "--turn", UPRIGHT, volume, "--truth", truth)
        lines.append(row(lumen, tree.stem, volume, truth, folder))
    (folder / "drawn_into.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__": main()
