#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Walls of models that were fitted to wall points, and to the volume's intensities, beside the truth.

  image_fits.py DATA FOLDER LUMEN [SEEDS [NAME ...]]

Draws phantoms with SEEDS (5) noise seeds each, converts them by their seeds (`lumen convert --seeds-only`), fits the cases
to the volume (`lumen fit --image`), and measures both surfaces: thin vessels of 0.6 to 1.5 voxels beside a trunk, two that
touch, a stenosis of 70 %, and noise of 15 %. The surface is that of `lumen convert --patches`, on which each vessel has its
own wall; a vertex's error is its distance from the round cones of its own true branch, outward. Vertices near forks and
ends are left out. The radius error of a place is the mean error around it. *intervals* counts how many radii lie within 1.96 of the
standard deviations that the fit states (LUMEN_image.deviation). Then come the real volumes of DATA, which have no
truth: the walls' offsets by `lumen check`. NAME: thin, touching, stenosis, fork, helix, intervals or real; all without one. Writes
FOLDER/image_fits.md and prints it. (`python3-numpy`, `python3-scipy`)"""
import json
import sys
from pathlib import Path

import numpy
from scipy.spatial import cKDTree

from timed_program import run

CLICKS = Path(__file__).resolve().parents[2] / "data"
REAL = [("3DRA", "aneurism-3dra.nrrd", "aneurism-3dra"), ("aorta", "aorta/aorta.mha", "aorta"), ("fistula", "avf/avf.nii", "avf")]
VOXEL = 0.4
THIN = (0.6, 0.8, 1.0, 1.5)  # voxels
TRUNK = 3.0                  # voxels
TOUCHING = 1.0               # voxels between the walls of two vessels
EDGES_LEFT_OUT = 3.0         # voxels beside a fork's parent and the ends of the true axis
BIN = 1.0                    # voxels of a place along an axis


def swc(vessels):
    """The text of vessels, each (parent: None or (vessel, sample), [(x, y, z, radius)])."""
    lines, first = [], []
    for parent, samples in vessels:
        first.append(len(lines) + 1)
        for i, sample in enumerate(samples):
            number = len(lines) + 1
            above = number - 1 if i else -1 if parent is None else first[parent[0]] + parent[1]
            lines.append(f"{number} 2 " + " ".join(f"{value:.5f}" for value in sample) + f" {above}")
    return "\n".join(lines) + "\n"


def comb():
    """A trunk along z from which thin vessels leave, and clicks on all."""
    radius, length = TRUNK * VOXEL, 36 * VOXEL
    z = numpy.linspace(0, 56 * VOXEL, 113)
    trunk = [(0.15 * numpy.sin(t / 4), 0, t, radius) for t in z]
    vessels, clicks = [(None, trunk)], []
    for i, thin in enumerate(THIN):
        at = 22 + 24 * i
        x, _, foot, _ = trunk[at]
        turn = numpy.radians(20 + 180 * (i % 2))
        way = numpy.linspace(0, length, 73)[1:]
        path = [(x + s * numpy.cos(turn), s * numpy.sin(turn) + 0.4 * numpy.sin(s / 4), foot + 0.03 * s, thin * VOXEL)
                for s in way]
        vessels.append(((0, at), path))
        clicks.append((path, thin))
    return swc(vessels), trunk, clicks


def narrowing():
    """A bent vessel that narrows to 30 %."""
    out = []
    for t in numpy.linspace(0, 60 * VOXEL, 241):
        from_middle = abs(t - 30 * VOXEL) / (9 * VOXEL)
        share = 1 - 0.7 * (0.5 * (1 + numpy.cos(numpy.pi * from_middle)) if from_middle < 1 else 0)
        out.append((2 * numpy.sin(numpy.pi * t / (60 * VOXEL)), 0.2 * t, t, TRUNK * VOXEL * share))
    return out


def seeds_file(path, branches):
    path.write_text(json.dumps({"format": "lumen-seeds", "version": 1, "coordinateSystem": "LPS", "units": "mm",
                                "branches": branches}))


def seed(label, samples, at, **more):
    return {"label": label, "points": [[float(x) for x in samples[at][:3]]], "radius": float(samples[at][3]), **more}


def thin_phantom(folder, lumen, number):
    text, trunk, clicks = comb()
    tree, stem = folder / "comb.swc", folder / f"comb-{number}"
    tree.write_text(text)
    draw(lumen, stem, number, "--tree", tree)
    branches = [seed("trunk", trunk, 56)]
    for samples, thin in clicks:
        branches.append(seed(f"thin-{thin}", samples, 18, parent="trunk"))
    seeds_file(stem.with_suffix(".json"), branches)
    return stem


def narrow_phantom(folder, lumen, number):
    samples = narrowing()
    tree, stem = folder / "narrow.swc", folder / f"narrow-{number}"
    tree.write_text(swc([(None, samples)]))
    draw(lumen, stem, number, "--tree", tree)
    seeds_file(stem.with_suffix(".json"), [seed("root", samples, 20)])
    return stem


def named_phantom(name, noise, folder, lumen, number):
    stem = folder / f"{name}-{number}"
    draw(lumen, stem, number, name, noise=noise, more=["--size", 64, "--seeds", stem.with_suffix(".json")])
    return stem


def draw(lumen, stem, number, *subject, noise=0.05, more=()):
    run(lumen, "phantom", *subject, stem.with_suffix(".nrrd"), "--truth", stem.with_suffix(".truth.lumen.json"),
        "--seed", number, "--voxel", VOXEL, "--noise", noise, *more)


def truth_of(stem):
    tree = json.loads(stem.with_suffix(".truth.lumen.json").read_text())["tree"]
    out = []
    for branch in tree["branches"]:
        nodes = slice(branch["firstNode"], branch["firstNode"] + branch["nodeCount"])
        out.append((numpy.array(tree["centre"][nodes]), numpy.array(tree["radius"][nodes]), branch["parentNode"] is not None
                    and branch["parentNode"] >= 0))
    return out


def patches(lumen, case):
    """The vertices of each branch's wall."""
    mesh = case.with_suffix(".obj")
    run(lumen, "convert", case, mesh, "--patches")
    points, groups = [], []
    for line in mesh.read_text().splitlines():
        word = line.split()
        if not word:
            continue
        if word[0] == "v":
            points.append([float(x) for x in word[1:4]])
        elif word[0] == "g":
            groups.append(set())
        elif word[0] == "f":
            groups[-1].update(int(corner.split("/")[0]) - 1 for corner in word[1:])
    mesh.unlink()
    points = numpy.array(points)
    return [points[sorted(group)] for group in groups]


def from_axis(points, branch):
    """Distance of points from the round cones of a branch, outward, the place along it, and from its ends, mm."""
    centre, radius, _ = branch
    step = centre[1:] - centre[:-1]
    square = (step ** 2).sum(1)
    arc = numpy.concatenate([[0], numpy.cumsum(numpy.sqrt(square))])
    best = numpy.full(len(points), numpy.inf)
    place = numpy.zeros(len(points))
    for i in range(len(step)):
        t = numpy.clip((points - centre[i]) @ step[i] / square[i], 0, 1)
        d = numpy.linalg.norm(points - centre[i] - t[:, None] * step[i], axis=1) - (radius[i] + t * (radius[i + 1] - radius[i]))
        nearer = d < best
        best[nearer], place[nearer] = d[nearer], (arc[i] + t * numpy.sqrt(square[i]))[nearer]
    return best, place, arc[-1]


def errors(walls, truth):
    """The vertices of each true branch's wall: their errors, places, and gaps to another vessel's wall, in voxels."""
    owner = {}
    for wall in walls:
        found = [numpy.median(numpy.abs(from_axis(wall, branch)[0])) for branch in truth]
        owner.setdefault(int(numpy.argmin(found)), []).append(wall)
    out = {}
    for index, parts in owner.items():
        wall = numpy.concatenate(parts)
        error, place, length = from_axis(wall, truth[index])
        others = [from_axis(wall, branch)[0] for i, branch in enumerate(truth) if i != index]
        gap = numpy.min(others, axis=0) if others else numpy.full(len(wall), numpy.inf)
        kept = (place > EDGES_LEFT_OUT * VOXEL) & (place < length - EDGES_LEFT_OUT * VOXEL)
        if truth[index][2] or any(branch[2] for branch in truth):  # forks
            kept &= gap > EDGES_LEFT_OUT * VOXEL
        out[index] = error[kept] / VOXEL, place[kept] / VOXEL, gap[kept] / VOXEL
    return out


def radius_errors(error, place):
    bins = numpy.floor(place / BIN).astype(int)
    return numpy.array([[b * BIN, error[bins == b].mean()] for b in numpy.unique(bins)])


def rms(values):
    return float(numpy.sqrt(numpy.mean(numpy.square(values))))


def figures(name, stem, lumen, case):
    """Figures of one case: {title: (value, unit)}, lengths in voxels."""
    truth = truth_of(stem)
    found = errors(patches(lumen, case), truth)
    if name == "thin":
        out = {}
        for i, thin in enumerate(THIN):
            if i + 1 in found and len(found[i + 1][0]):
                mean = radius_errors(*found[i + 1][:2])[:, 1]
                out[f"thin {thin}: radius error, RMS"] = rms(mean)
                out[f"thin {thin}: radius error, mean"] = float(mean.mean())
                out[f"thin {thin}: length, share"] = len(mean) * BIN / (36 - TRUNK - 2 * EDGES_LEFT_OUT)
        return out
    error = numpy.concatenate([e for e, _, _ in found.values()])
    if name == "touching":
        gap = numpy.concatenate([g for _, _, g in found.values()])
        near = numpy.abs(error[gap < TOUCHING])
        return {"touching: wall error where they touch, RMS": rms(near), "touching: 90 %": float(numpy.percentile(near, 90)),
                "touching: wall error elsewhere, RMS": rms(error[gap > 3])}
    if name == "stenosis":
        centre, radius, _ = truth[0]
        arc = numpy.concatenate([[0], numpy.cumsum(numpy.linalg.norm(centre[1:] - centre[:-1], axis=1))]) / VOXEL
        mean = radius_errors(*found[0][:2])
        wall = mean[:, 1] + numpy.interp(mean[:, 0] + 0.5 * BIN, arc, radius) / VOXEL
        return {"stenosis: least radius, error in %": 100 * (wall.min() / (radius.min() / VOXEL) - 1),
                "stenosis: wall error, RMS": rms(error)}
    return {f"{name}, noise 15 %: wall error, RMS": rms(error), f"{name}, noise 15 %: 90 %": float(numpy.percentile(numpy.abs(error), 90))}


PHANTOMS = {
    "thin": thin_phantom,
    "touching": lambda *a: named_phantom("kissing", 0.05, *a),
    "stenosis": narrow_phantom,
    "fork": lambda *a: named_phantom("bifurcation", 0.15, *a),
    "helix": lambda *a: named_phantom("helix", 0.15, *a),
}


def table(head, rows):
    return "".join("| " + " | ".join(str(cell) for cell in row) + " |\n" for row in [head, ["---"] + ["--:"] * (len(head) - 1), *rows])


def phantoms(folder, lumen, count, names):
    values, seconds = {}, [0.0, 0.0]
    for name, make in PHANTOMS.items():
        if name not in names:
            continue
        for number in range(1, count + 1):
            stem = make(folder, lumen, number)
            volume, points, image = stem.with_suffix(".nrrd"), stem.with_suffix(".points.lumen"), stem.with_suffix(".image.lumen")
            seconds[0] += run(lumen, "convert", volume, points, "--seeds", stem.with_suffix(".json"), "--seeds-only")[1]
            seconds[1] += run(lumen, "fit", points, image, "--image", volume)[1]
            for column, case in enumerate((points, image)):
                for title, value in figures(name, stem, lumen, case).items():
                    values.setdefault(title, ([], []))[column].append(value)
    rows = [[title, *(f"{numpy.median(v):.3f} ({min(v):.3f} to {max(v):.3f})" if v else "-" for v in pair)] for title, pair in values.items()]
    return (f"Phantoms, {count} noise seeds each: median (least to greatest), in voxels.\n\n" + table(["", "points", "image"], rows) +
            f"\nProcessor seconds: {seconds[0]:.1f} for the conversions, {seconds[1]:.1f} for the fits to the image.\n\n")


def intervals(folder, lumen, count):
    """How often the truth lies in an interval of 95 %: the radii of nodes against those of the nearest true ones."""
    rows = []
    for name in ("tube", "helix", "bifurcation", "kissing"):
        for noise in (0.05, 0.15):
            errors_in_deviations = []
            for number in range(1, count + 1):
                stem = named_phantom(name, noise, folder, lumen, number)
                volume, case, fitted = stem.with_suffix(".nrrd"), stem.with_suffix(".points.lumen"), stem.with_suffix(".image.lumen.json")
                run(lumen, "convert", volume, case, "--seeds", stem.with_suffix(".json"), "--seeds-only")
                run(lumen, "fit", case, fitted, "--image", volume)
                twin, truth = json.loads(fitted.read_text()), json.loads(stem.with_suffix(".truth.lumen.json").read_text())["tree"]
                deviation = numpy.array(twin["nodeArrays"]["LUMEN_image.deviation"])
                away, nearest = cKDTree(truth["centre"]).query(twin["tree"]["centre"])
                radius = numpy.array(truth["radius"])[nearest]
                known = (deviation > 0) & (away < 0.5 * radius)
                errors_in_deviations.extend((numpy.array(twin["tree"]["radius"]) - radius)[known] / deviation[known])
            size = numpy.abs(errors_in_deviations)
            rows.append([name, f"{100 * noise:.0f} %", len(size), f"{100 * (size < 1.96).mean():.1f} %", f"{numpy.median(errors_in_deviations):+.2f}"])
    return (f"Radii within 1.96 standard deviations of the truth, {count} noise seeds each.\n\n" +
            table(["phantom", "noise", "nodes", "in the interval", "median error in deviations"], rows) + "\n")


def real(data, folder, lumen):
    rows = []
    for name, file, clicks in REAL:
        volume, points, image = data / file, folder / f"{clicks}.points.lumen", folder / f"{clicks}.image.lumen"
        if not volume.exists():
            continue
        seconds = [run(lumen, "convert", volume, points, "--seeds", CLICKS / f"{clicks}.seeds.json", "--seeds-only")[1],
                   run(lumen, "fit", points, image, "--image", volume)[1]]
        for title, case, second in zip(("points", "image"), (points, image), seconds):
            check = json.loads(run(lumen, "check", volume, case, "--json")[0])
            reach = json.loads(run(lumen, "info", case, "--json")[0])["reachable"]
            wall, offset = check["wall"], check["wall"]["offset_voxels"]
            rows.append([name, title, f"{offset['median']:+.3f}", f"{offset['median_absolute']:.3f}", f"{offset['p90_absolute']:.3f}",
                         f"{100 * wall['beyond_voxel_share']:.1f}", f"{100 * wall['no_edge_share']:.1f}",
                         f"{100 * check['dark_share']:.2f}", f"{reach['length_mm']:.0f} of {reach['of_mm']:.0f}", f"{second:.1f}"])
    return "Real volumes, by `lumen check`.\n\n" + table(
        ["volume", "fitted to", "offset, median", "its size, median", "90 %", "beyond a voxel, %", "no edge, %", "dark, %", "reachable mm",
         "processor s"], rows)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    data, folder, lumen = map(Path, sys.argv[1:4])
    count = int(sys.argv[4]) if len(sys.argv) > 4 else 5
    names = sys.argv[5:] or [*PHANTOMS, "intervals", "real"]
    folder.mkdir(parents=True, exist_ok=True)
    text = "# Fits to wall points, and to intensities\n\n"
    if set(names) & set(PHANTOMS):
        text += phantoms(folder, lumen, count, names)
    if "intervals" in names:
        text += intervals(folder, lumen, count)
    if "real" in names:
        text += real(data, folder, lumen)
    (folder / "image_fits.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
