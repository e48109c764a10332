#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Voxels of the lumen that the balls along a centerline tree paint, and paint outside of it, as tube segmenters are scored.

  painted.py LUMEN VOLUME CASE THRESHOLD [THRESHOLD ...]

A voxel is lumen if it is brighter than the threshold. It is painted if its middle lies in a ball whose centre and radius are linear
between those of two nodes that an edge joins. Prints one line for each threshold, of which half of the contrast is one choice.
"""
import sys
from pathlib import Path

import numpy

from forks import tree_of
from volumes import read


def painted(volume, tree):
    """Voxels within the balls along the edges."""
    centres, radii = numpy.array(tree["centre"]), numpy.array(tree["radius"])
    index = numpy.linalg.inv(volume.affine)
    spacing = numpy.linalg.norm(volume.affine[:3, :3], axis=0)
    paint = numpy.zeros(volume.voxels.shape, bool)
    for node, parent in enumerate(tree["parent"]):
        ends = [node, node if parent < 0 else parent]
        steps = max(2, int(numpy.ceil(numpy.linalg.norm(centres[ends[0]] - centres[ends[1]]) / (0.25 * spacing.min()))))
        for t in numpy.linspace(0, 1, steps):
            centre, radius = ((1 - t) * x[ends[0]] + t * x[ends[1]] for x in (centres, radii))
            place = (index @ [*centre, 1])[:3]
            low = numpy.maximum(numpy.floor(place - radius / spacing), 0).astype(int)
            high = numpy.minimum(numpy.ceil(place + radius / spacing) + 1, paint.shape).astype(int)
            if (high <= low).any(): continue
            axes = numpy.ogrid[tuple(slice(a, b) for a, b in zip(low, high))]
            square = sum(((axis - p) * s) ** 2 for axis, p, s in zip(axes, place, spacing))  # axes of the volume are at right angles
            paint[tuple(slice(a, b) for a, b in zip(low, high))] |= square <= radius * radius
    return paint


def main():
    lumen, file, case = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
    volume, tree = read(file), tree_of(lumen, case)
    paint = painted(volume, tree)
    print(f"{len(tree['branches'])} vessels, {sum(p < 0 for p in tree['parent'])} trees")
    for threshold in map(float, sys.argv[4:]):
        inside = volume.voxels > threshold
        print(f"above {threshold:g}: {inside.sum()} voxels of lumen, {100 * (paint & inside).sum() / inside.sum():.1f} % painted; "
              f"{100 * (paint & ~inside).sum() / paint.sum():.1f} % of the paint outside")


if __name__ == "__main__":
    main()
