#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Arteries and veins in drawn organs, as computed tomography shows them, and what lumen finds of them without a click.

  organs.py FOLDER LUMEN [NAME ...]
  organs.py hold LUMEN

Each row of ORGANS is a body of shapes with their Hounsfield units, painted one over the other, and two systems of vessels. The shapes become
a scan of 1 mm voxels with blur, noise, edges that breathe between slices, and streaks; `lumen phantom --tree --veins --into` draws the
vessels into it, with the truth. Found and false are those of drawn_into.py; a join is an edge of the found tree that leads from a vessel of
one system to one of the other. Volumes and cases stay in FOLDER, and so does organs.md, which is printed too. Needs python3-numpy.

The second form is a test: it draws the organs of HELD, and fails if less is found or more is false than stated there.
"""
import math
import random
import sys
import tempfile
from pathlib import Path

import numpy

from drawn_into import run, score
from forks import Found, tree_of

SIZE = (112, 112, 96)  # voxels of 1 mm
BLUR, NOISE, STREAK, BREATH = 0.6, 11.0, 12.0, 1.2  # mm, HU, HU, mm

# Shapes: centre and half axes in mm, HU, and the power of the norm of an ellipsoid that is rather a box. An infinite half axis makes a cylinder.
INF, BOX = math.inf, 8
BODY = [((56, 56, 48), (52, 44, 46), -90, BOX), ((56, 56, 48), (48, 40, 44), 45, BOX)]
SPINE = [((56, 86, 48), (11, 9, 42), 700, BOX), ((56, 86, 48), (9, 7, 40), 180, BOX)]


def fork(at, along, length, radius, depth, angle=0.6, shorter=0.75, seed=1):
    """A vessel that divides `depth` times, as (points, radii) of chains."""
    chance = random.Random(seed)
    chains = []

    def grow(at, along, across, length, radius, depth):
        along = along / numpy.linalg.norm(along)
        side = across - across.dot(along) * along
        side = side / numpy.linalg.norm(side)
        bend = 0.12 * length * chance.choice((-1, 1))
        points = [at + t * length * along + bend * math.sin(math.pi * t) * numpy.cross(along, side) for t in numpy.linspace(0, 1, 9)]
        chains.append((points, numpy.linspace(radius, 0.9 * radius, 9)))
        if depth == 0: return
        for sign in (1, -1):
            turn = angle * chance.uniform(0.8, 1.2)
            grow(points[-1], math.cos(turn) * along + sign * math.sin(turn) * side, numpy.cross(along, side) + 0.2 * side,
                 shorter * length, 0.79 * radius, depth - 1)

    grow(numpy.array(at, float), numpy.array(along, float), numpy.array((0.9, 0.4, 0.2)), length, radius, depth)
    return chains


def line(*places, radius, to=None):
    """A smooth vessel through places."""
    knots = numpy.array(places, float)
    at = numpy.linspace(0, len(knots) - 1, 12 * len(knots))
    points = numpy.stack([numpy.interp(at, range(len(knots)), knots[:, k]) for k in range(3)], axis=1)
    for _ in range(12): points[1:-1] = (points[:-2] + 2 * points[1:-1] + points[2:]) / 4
    return [(list(points), numpy.linspace(radius, to or radius, len(points)))]


def on_heart(angle, turn, low, radius, apart=0.0):
    """A vessel that winds down the ventricle from its base."""
    places = []
    for t in numpy.linspace(0, 1, 25):
        a, h = angle + turn * t + 0.1 * math.sin(9 * t), 0.9 - (0.9 - low) * t
        across = (33 + apart) * math.sqrt(max(0.05, 1 - (0.85 * h) ** 2))
        places.append((56 + across * math.cos(a), 52 + 0.85 * across * math.sin(a), 48 + 38 * h))
    return line(*places, radius=radius, to=0.6 * radius)


def mirrored(chains):
    return chains + [([numpy.array((112, 0, 0)) + p * (-1, 1, 1) for p in points], radii) for points, radii in chains]


LUNGS = [((31, 54, 48), (18, 30, 40), -850, 4), ((81, 54, 48), (18, 30, 40), -850, 4)]
PULMONARY = mirrored(line((56, 46, 20), (50, 46, 40), (44, 48, 48), radius=4) + fork((44, 48, 48), (-1, 0.2, 0.3), 14, 3, 3))
BRONCHI = mirrored(fork((44, 53, 48), (-1, 0.2, 0.3), 13, 3, 2))
FEMORAL = line((40, 44, 2), (42, 46, 48), (36, 50, 93), radius=3.2, to=2.6)
KIDNEYS = [((x, 66, 48), half, hu) for x in (30, 82) for half, hu in (((13, 12, 24), 175), ((8, 7, 15), 60))]
RENAL = mirrored(line((56, 66, 50), (64, 65, 48), (70, 66, 48), radius=2.6) + fork((70, 66, 48), (1, 0, 0.1), 9, 2.2, 2, 0.8))
LEGS = [((x, 56, 48), half, hu, BOX if half[0] > 9 else 2) for x in (31, 81)
        for half, hu in (((24, 30, 46), -90), ((21, 27, 44), 45), ((9, 9, 42), 1200), ((5, 5, 40), 60))]
# name: shapes, tubes of air with a wall, arteries, veins, HU of both over soft tissue
ORGANS = {
    "heart": (BODY + SPINE + [((56, 52, 48), (35, 30, 40), 105), ((56, 52, 48), (24, 19, 28), 370)], [],
              on_heart(-0.9, 1.6, -0.7, 2.2) + on_heart(-0.7, -1.8, -0.3, 2.0) + on_heart(1.6, 0.9, -0.5, 2.0), on_heart(-0.4, 1.6, -0.5, 1.8, 5), (330, 160)),
    "liver": (BODY + SPINE + [((52, 48, 50), (40, 30, 38), 110)], [], fork((58, 60, 14), (-0.2, -0.3, 1), 20, 3.4, 3),
              fork((50, 54, 88), (-0.1, -0.2, -1), 20, 3.8, 3, seed=4), (190, 160)),
    "lungs": (BODY + SPINE + LUNGS, BRONCHI, PULMONARY, mirrored(fork((46, 60, 30), (-1, 0, 0.6), 14, 3, 3, seed=3)), (320, 240)),
    "dissection": (BODY + SPINE + [((64, 70, 48), (1.4, 1.4, 3), 900)], [], line((55, 62, 0), (57, 60, 48), (54, 62, 95), radius=5) +
                   line((57, 60, 48), (70, 54, 50), (84, 56, 54), radius=2.5, to=2), line((67.2, 66, 0), (69, 64.5, 48), (66, 66, 95), radius=7.5), (330, 210)),
    "kidneys": (BODY + SPINE + KIDNEYS, [], line((56, 66, 0), (56, 66, 95), radius=6) + RENAL,
                line((44, 60, 0), (44, 60, 95), radius=7) + line((44, 60, 44), (56, 56, 43), (72, 63, 42), radius=3.2), (330, 140)),
    "legs": (LEGS, [],
             mirrored(FEMORAL + line((41, 45, 30), (30, 42, 52), (24, 44, 80), radius=2, to=1.4) + line((41, 46, 60), (50, 52, 72), radius=1.4)),
             mirrored(line((44, 50.5, 2), (46, 52.5, 48), (41, 55.5, 93), radius=3.6)), (320, 120)),
    "retina": ([((56, 64, 48), (48, 22, 42), 40, BOX)], [], fork((56, 55, 48), (1, 0, 0.3), 16, 2, 3) + fork((56, 55, 48), (-1, 0, 0.3), 16, 2, 3, seed=2),
               fork((56, 61, 45), (1, 0, -0.2), 16, 2.4, 3, seed=5) + fork((56, 61, 45), (-1, 0, -0.2), 16, 2.4, 3, seed=6), (300, 200)),
}

# The least share that is found, and the greatest that is false.
HELD = {"liver": (0.95, 0.01), "dissection": (0.95, 0.01), "legs": (0.90, 0.02)}


def inside(places, shape):
    centre, half, _, power = (*shape, 2)[:4]
    norm = sum(numpy.abs((places[k] - centre[k]) / half[k]) ** power for k in range(3)) ** (1 / power)
    return numpy.clip(0.5 + (1 - norm) * min(half), 0, 1)


def in_tubes(places, chains, wall):
    share = numpy.zeros(SIZE, numpy.float32)
    for points, radii in chains:
        for point, radius in zip(points, radii):
            share = numpy.maximum(share, numpy.clip(0.5 + radius + wall - numpy.sqrt(sum((places[k] - point[k]) ** 2 for k in range(3))), 0, 1))
    return share


def blurred(values):
    reach = numpy.arange(-3, 4)
    taps = numpy.exp(-reach ** 2 / (2 * BLUR ** 2))
    for axis in range(3):
        wide = numpy.pad(values, [(3, 3) if k == axis else (0, 0) for k in range(3)], mode="edge")
        values = sum(tap / taps.sum() * numpy.take(wide, range(i, i + SIZE[axis]), axis) for i, tap in enumerate(taps))
    return values


def scan(shapes, airways, seed):
    """The body without vessels."""
    chance = numpy.random.default_rng(seed)
    x, y, z = numpy.meshgrid(*(numpy.arange(n, dtype=numpy.float32) for n in SIZE), indexing="ij")
    places = (x, y + numpy.float32(BREATH) * numpy.sin(2 * math.pi * z / 9), z)
    values = numpy.full(SIZE, -1000, numpy.float32)
    tubes = [(in_tubes(places, airways, wall), hu) for wall, hu in ((1.2, 20), (0, -1000))] if airways else []
    for share, hu in [(inside(places, shape), shape[2]) for shape in shapes] + tubes: values += share * (hu - values)
    angle = chance.uniform(0, math.pi, SIZE[2])
    values = blurred(values) + STREAK * (values > -300) * numpy.cos(2 * math.pi / 4 * (x * numpy.cos(angle) + y * numpy.sin(angle)))
    return numpy.rint(values + NOISE * chance.normal(size=SIZE)).astype("<i2")


def write_scan(file, voxels):
    file.write_bytes(("NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: %d %d %d\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                      "space origin: (0,0,0)\nkinds: domain domain domain\nendian: little\nencoding: raw\n\n" % SIZE).encode() + voxels.tobytes(order="F"))


def write_swc(file, chains):
    """The chains as a tree: one that begins where a point of another is hangs on it."""
    rows, places = [], {}
    for points, radii in chains:
        parent = -1
        for k, (point, radius) in enumerate(zip(points, radii)):
            key = tuple(numpy.round(point, 3))
            if k == 0:
                near = min(places, key=lambda other: math.dist(other, key), default=None)
                if near is not None and math.dist(near, key) < 2:
                    parent = places[near]
                    continue
            rows.append(f"{len(rows) + 1} 0 {point[0]:.3f} {point[1]:.3f} {point[2]:.3f} {radius:.3f} {parent}")
            parent = places[key] = len(rows)
    file.write_text("\n".join(rows) + "\n")


def count_joins(lumen, case, truth):
    """Edges of a found tree from a vessel of one system to one of the other; nodes between that lie in no true vessel are passed over."""
    found, true = tree_of(lumen, case), tree_of(lumen, truth)
    places, systems = Found(true), []
    for centre, parent in zip(found["centre"], found["parent"]):
        at = places.at(centre, 1)
        own = None if at is None else true["branches"][true["branch"][at]]["label"].split("-")[0]
        systems.append((own, systems[parent][1] if own is None and parent >= 0 else own))
    edges = [(n, parent) for n, parent in enumerate(found["parent"]) if parent >= 0] + found.get("links", [])
    return sum(systems[a][0] is not None and systems[b][1] is not None and systems[a][0] != systems[b][1] for a, b in edges)


def figures(folder, lumen, name):
    """True length that counts, the share of it that is found, found length, the share of it that is false, joins, seconds."""
    shapes, airways, arteries, veins, levels = ORGANS[name]
    file = {end: folder / f"{name}{end}" for end in ("-body.nrrd", "-arteries.swc", "-veins.swc", ".nrrd", ".truth.lumen", ".lumen")}
    write_scan(file["-body.nrrd"], scan(shapes, airways, 1))
    write_swc(file["-arteries.swc"], arteries)
    write_swc(file["-veins.swc"], veins)
    run(lumen, "phantom", "--tree", file["-arteries.swc"], "--veins", file["-veins.swc"], "--into", file["-body.nrrd"], "--move", "0,0,0",
        "--contrast", levels[0], "--vein-contrast", levels[1], file[".nrrd"], "--truth", file[".truth.lumen"])
    _, seconds = run(lumen, "track", file[".nrrd"], file[".lumen"])
    return *score(lumen, file[".lumen"], file[".truth.lumen"]), count_joins(lumen, file[".lumen"], file[".truth.lumen"]), seconds


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
