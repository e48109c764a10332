#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Circles of Willis of lumen phantom with missing parts and noise, and the networks that lumen makes of them without a click.

  circles.py FOLDER LUMEN [further]
  circles.py hold LUMEN

Inlets are right if each true root has a root within twice its radius, and no other root lies in a true vessel. Links are right if they join
the same inlets as often as the true ones do. Names are those of lumen names --anatomy. Volumes and cases stay in FOLDER, and so does circles.md, which is printed too.
`further` are circles that no rule was made on: other variants, noises, seeds and sizes.

The second form is a test: it draws the circles of HELD, and fails if a network is wrong.
"""
import re
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

from drawn_into import run
from forks import Found, tree_of

# Missing parts; the most frequent variants are those of one communicating artery, of A1 and of P1.
VARIANTS = ("", "Acom", "L-Pcom", "R-Pcom", "L-A1", "R-A1", "L-P1", "R-P1", "L-Pcom,R-Pcom", "Acom,L-Pcom", "Acom,R-P1", "L-A1,R-P1",
            "R-A1,R-Pcom", "L-P1,R-P1", "L-P1,R-Pcom", "Acom,L-Pcom,R-Pcom")
NOISES = (0.05, 0.1, 0.15)
CIRCLES = [(v, NOISES[k % 3], k + 1) for k, v in enumerate(VARIANTS)] + [("", 0.15, 21), ("", 0.1, 22), ("L-Pcom", 0.15, 23), ("Acom", 0.15, 24)]
# and the voxel's edge, mm
FURTHER = [("L-A1", 0.1, 201, 0.41), ("R-P1", 0.1, 202, 0.39), ("", 0.1, 203, 0.42), ("R-A1,L-Pcom", 0.08, 204, 0.4), ("L-P1,Acom", 0.1, 205, 0.41),
           ("L-Pcom", 0.12, 206, 0.4), ("R-A1,R-P1", 0.1, 207, 0.41), ("L-P1,R-P1,L-Pcom", 0.1, 208, 0.4), ("Acom", 0.07, 209, 0.42)]
HELD = [("", 0.05, 1), ("R-A1,R-Pcom", 0.05, 13)]


def root_of(tree, node):
    while tree["parent"][node] >= 0: node = tree["parent"][node]
    return node


def joined_inlets(tree, name):
    """The names of the two inlets that each link joins."""
    return Counter(tuple(sorted(str(name.get(root_of(tree, n))) for n in link)) for link in tree.get("links", []))


def network(lumen, case, truth):
    """Whether the inlets are right, and the links that are right, missing and false."""
    found, true = tree_of(lumen, case), tree_of(lumen, truth)
    true_roots = {n: true["branches"][true["branch"][n]]["label"] for n, p in enumerate(true["parent"]) if p < 0}
    places, names, extra = Found(true), {}, 0
    for n, parent in enumerate(found["parent"]):
        if parent >= 0: continue
        near = [name for root, name in true_roots.items()
                if np.linalg.norm(np.subtract(found["centre"][n], true["centre"][root])) < 2 * true["radius"][root]]
        if near: names[n] = near[0]
        elif places.at(found["centre"][n], 1) is not None: extra += 1
    wanted, got = joined_inlets(true, true_roots), joined_inlets(found, names)
    return sorted(names.values()) == sorted(true_roots.values()) and extra == 0, (wanted & got).total(), (wanted - got).total(), (got - wanted).total()


def names(lumen, case, truth):
    """The number of true arteries that have their name on more than half of their nodes, and of those that have another one there."""
    named = case.with_suffix(".named.lumen")
    run(lumen, "names", case, "--anatomy", "--out", named)
    found, true = tree_of(lumen, named), tree_of(lumen, truth)
    places, right, wrong = Found(found), 0, 0
    for branch in true["branches"]:
        nodes = range(branch["firstNode"], branch["firstNode"] + branch["nodeCount"])
        at = [places.at(true["centre"][n], true["radius"][n]) for n in nodes]
        has = Counter(re.sub(r"(-\d+)+$", "", found["branches"][found["branch"][n]]["label"]) for n in at if n is not None)
        for label in [n for n in has if n == "vessel" or re.match(r"[A-Z]+\.\d", n)]: del has[label]
        right += has[branch["label"]] > len(nodes) / 2
        wrong += has.total() - has[branch["label"]] > len(nodes) / 2
    return right, len(true["branches"]), wrong


def figures(folder, lumen, without, noise, seed, voxel=0.4):
    volume, truth, case = (folder / f"circle-{seed}{end}" for end in (".nrrd", ".truth.lumen", ".lumen"))
    run(lumen, "phantom", "willis", volume, "--truth", truth, "--size", 128, "--voxel", voxel, "--noise", noise, "--seed", seed,
        *(("--without", without) if without else ()))
    run(lumen, "track", volume, case)
    return *network(lumen, case, truth), *names(lumen, case, truth)


def hold(lumen):
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for circle in HELD:
            inlets, _, missing, false, named, arteries, wrong = figures(Path(folder), lumen, *circle)
            if wrong or named < 0.7 * arteries: faults.append(f"without {circle[0] or 'nothing'}: {named} of {arteries} names, {wrong} wrong")
            if not inlets or missing or false: faults.append(f"without {circle[0] or 'nothing'}: inlets right {inlets}, links missing {missing}, false {false}")
    sys.exit("\n".join(faults) or 0)


def main():
    if sys.argv[1] == "hold": hold(sys.argv[2])
    folder, lumen = Path(sys.argv[1]), sys.argv[2]
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["| missing | noise | inlets | links right | missing | false | names | wrong |", "|---|--:|---|--:|--:|--:|--:|--:|"]
    sums = np.zeros(7, int)
    circles = FURTHER if "further" in sys.argv[3:] else CIRCLES
    for without, noise, *more in circles:
        row = figures(folder, lumen, without, noise, *more)
        sums += np.array(row, int)
        lines.append(f"| {without.replace(',', ', ') or 'nothing'} | {noise} | {'right' if row[0] else 'wrong'} | {row[1]} | {row[2]} | {row[3]} | {row[4]} of {row[5]} | {row[6]} |")
        print(lines[-1], flush=True)
    lines.append(f"| {len(circles)} circles | | {sums[0]} right | {sums[1]} | {sums[2]} | {sums[3]} | {sums[4]} of {sums[5]} | {sums[6]} |")
    (folder / "circles.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__": main()
