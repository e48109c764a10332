#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Organs of lumen phantom, and what lumen finds of their vessels without a click.

  organs.py FOLDER LUMEN [NAME ...]
  organs.py hold LUMEN

Found and false are those of drawn_into.py; a join is an edge of the found tree that leads from a vessel of one system to one of the other.
Volumes and cases stay in FOLDER, and so does organs.md, which is printed too.

The second form is a test: it draws the organs of HELD, and fails if less is found or more is false than stated there.
"""
import sys
import tempfile
from pathlib import Path

from drawn_into import run, score
from forks import Found, tree_of

ORGANS = ("heart", "liver", "lungs", "dissection", "kidneys", "legs", "retina")
# The least share that is found, and the greatest that is false. The femoral arteries lie on the bone for a quarter of their length.
HELD = {"liver": (0.95, 0.01), "dissection": (0.95, 0.01), "legs": (0.80, 0.02)}


def count_joins(lumen, case, truth):
    """Edges of a found tree from a vessel of one system to one of the other; nodes between that lie in no true vessel are passed over."""
    found, true = tree_of(lumen, case), tree_of(lumen, truth)
    places, systems = Found(true), []
    for centre, parent in zip(found["centre"], found["parent"]):
        at = places.at(centre, 1)
        own = None if at is None else true["branches"][true["branch"][at]]["label"].rsplit("-", 1)[0]
        systems.append((own, systems[parent][1] if own is None and parent >= 0 else own))
    edges = [(n, parent) for n, parent in enumerate(found["parent"]) if parent >= 0] + found.get("links", [])
    return sum(systems[a][0] is not None and systems[b][1] is not None and systems[a][0] != systems[b][1] for a, b in edges)


def figures(folder, lumen, name):
    """True length that counts, the share of it that is found, found length, the share of it that is false, joins, seconds."""
    volume, truth, case = (folder / f"{name}{end}" for end in (".nrrd", ".truth.lumen", ".lumen"))
    run(lumen, "phantom", name, volume, "--truth", truth)
    _, seconds = run(lumen, "track", volume, case)
    return *score(lumen, case, truth), count_joins(lumen, case, truth), seconds


def hold(lumen):
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for name, (least, most) in HELD.items():
            _, found, _, false, *_ = figures(Path(folder), lumen, name)
            if found < least or false > most: faults.append(f"{name}: {found:.3f} found, {false:.3f} false; expected {least} or more, {most} or less")
    sys.exit("\n".join(faults) or 0)


def main():
    if sys.argv[1] == "hold": hold(sys.argv[2])
    folder, lumen, *names = sys.argv[1:]
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["| organ | mm over a voxel | found | mm found | false | joins | s |", "|---|--:|--:|--:|--:|--:|--:|"]
    for name in names or ORGANS:
        true_mm, found, found_mm, false, joins, seconds = figures(folder, lumen, name)
        lines.append(f"| {name} | {true_mm:.0f} | {found:.3f} | {found_mm:.0f} | {false:.3f} | {joins} | {seconds:.0f} |")
    (folder / "organs.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__": main()
