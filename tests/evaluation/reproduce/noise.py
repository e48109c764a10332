#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Vessels that come and go when noise is added to a volume, and whether their confidence said so.

  noise.py DATA FOLDER LUMEN [NAME ...]

Each volume is converted with default options, and again in ten drawings with normal noise of 1 and 3 % of its range. A vessel comes or goes if
it is longer than 5 mm and lies mostly outside of all vessels of the other case. *Foretold by* is the share of pairs of a vessel that most
drawings lose and one that they keep in which the first has the lower value: the inlier rate, contrast over noise as `lumen check` states it, and
the lower one of the ranks by both; .5 is chance. Needs what steadiness.py needs. Volumes are deleted again; noise.md stays in FOLDER and is printed.
"""
import json
import subprocess
import sys
from pathlib import Path

import numpy
from scipy.spatial import cKDTree

from steadiness import LONG, VOLUMES, convert, strangers
from volumes import Volume, read, write_nrrd

SHARES, DRAWINGS = (0.01, 0.03), range(1, 11)


def long_vessels(tree):
    """Numbers and nodes of the vessels of over 5 mm."""
    for number, branch in enumerate(tree["branches"]):
        nodes = numpy.array(tree["centre"][branch["firstNode"]:branch["firstNode"] + branch["nodeCount"]])
        if len(nodes) > 1 and numpy.linalg.norm(numpy.diff(nodes, axis=0), axis=1).sum() > LONG: yield number, nodes


def is_in(nodes, tree):
    away, index = cKDTree(numpy.array(tree["centre"])).query(nodes)
    return (away <= numpy.maximum(numpy.array(tree["radius"])[index], 0.5)).mean() >= 0.5


def ranks(values):
    return numpy.argsort(numpy.argsort([0 if value is None else value for value in values]))


def foretold(values, is_lost):
    lost, kept = ([v for v, lost in zip(values, is_lost) if lost == side and v is not None] for side in (True, False))
    pairs = [(a < b) + 0.5 * (a == b) for a in lost for b in kept]
    return f"{sum(pairs) / len(pairs):.2f}" if pairs else "-"


def rows(lumen, folder, name, file):
    case, noisy = folder / "noise.lumen", folder / "noise.nrrd"
    volume = read(file)
    extent = float(volume.voxels.max()) - float(volume.voxels.min())
    length, tree = convert(lumen, file, case)
    check = json.loads(subprocess.run([str(lumen), "check", str(file), str(case), "--json", "--quiet"], check=True, capture_output=True, text=True).stdout)
    vessels = list(long_vessels(tree))
    for share in SHARES:
        found = []
        for drawing in DRAWINGS:
            noise = numpy.random.default_rng(drawing).normal(size=volume.voxels.shape)
            write_nrrd(Volume((volume.voxels + share * extent * noise).astype(numpy.float32), volume.affine), noisy)
            found.append(convert(lumen, noisy, case))
        noisy.unlink()
        lengths = [each for each, _ in found]
        gone, come = ([strangers(*pair) for pair in pairs] for pairs in ([(tree, other) for _, other in found], [(other, tree) for _, other in found]))
        is_lost = [sum(is_in(nodes, other) for _, other in found) < len(found) / 2 for _, nodes in vessels]
        inliers = [tree["branches"][n].get("meanInlierRate") for n, _ in vessels]
        contrast = [check["branches"][n]["wall"]["contrast_to_noise"] for n, _ in vessels]
        both = [min(pair) for pair in zip(ranks(inliers), ranks(contrast))]
        said = [foretold(values, is_lost) for values in (inliers, contrast, both)]
        yield (f"| {name} | {100 * share:.0f} % | {length:.0f} | {min(lengths):.0f} to {max(lengths):.0f} | {len(vessels)} | {numpy.mean(gone):.1f} | "
               f"{numpy.mean(come):.1f} | {' | '.join(said)} |")


def main():
    data, folder, lumen, names = Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3]).resolve(), set(sys.argv[4:])
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["# Noise", "", "| volume | noise | mm | with noise | vessels over 5 mm | gone | come | foretold by inliers | by contrast | by both |",
             "|---|--:|--:|---|--:|--:|--:|--:|--:|--:|"]
    for name, file in VOLUMES:
        if (names and name not in names) or not (data / file).exists(): continue
        for line in rows(lumen, folder, name, data / file):
            lines.append(line)
            print(line, flush=True)
    (folder / "noise.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
