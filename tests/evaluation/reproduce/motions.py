#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Walls of cases that were followed through the phases of a motion, beside the truth.

  motions.py DATA FOLDER LUMEN [SEEDS [NAME ...]]

Draws phantoms that move, SEEDS (3) noise seeds each, tracks the phase at rest without a click (`lumen track`), and follows it
(`lumen motion`). *warped* is the 3DRA of DATA, whose voxels a known motion moves. The error of a wall point is its distance from the true wall of the phase: the round cones of the true tree,
moved as the phantom's motion has it. The rest's own error is there in every phase. Trees of DATA/arteries are drawn with the
motion of the heart. NAME: coronary, hepatic, noise, fast or arteries; all without one. Writes FOLDER/motions.md and prints it.
(`python3-numpy`, `python3-scipy`)"""
import gzip
import json
import sys
from pathlib import Path

import numpy
from scipy.ndimage import map_coordinates
from scipy.spatial import cKDTree

from timed_program import run

NEAR = 24  # edges of the true tree that are tried for a point

# name: phantom, motion, phases, voxel, options
CASES = {
    "coronary": ("coronary", "heart", 10, 0.5, ("--size", 192)),
    "hepatic": ("hepatic", "breath", 10, 0.5, ("--size", 160)),
    "noise": ("coronary", "heart", 10, 0.5, ("--size", 192, "--noise", 0.15, "--psf", 1.0)),
    "fast": ("coronary", "heart", 4, 0.5, ("--size", 192)),
}


class Case:
    """A case with a motion, as arrays."""

    def __init__(self, file, lumen):
        text = file.with_suffix(".lumen.json")
        run(lumen, "convert", file, text, "--quiet")
        value = json.loads(text.read_text(encoding="utf-8"))
        text.unlink()
        tree, self.motion = value["tree"], value["motion"]
        self.centre, self.radius = numpy.array(tree["centre"]), numpy.array(tree["radius"])
        self.parent, self.along = numpy.array(tree["parent"]), numpy.array(tree["direction"])
        if "points" in value:
            offset = numpy.array(value["points"]["offset"])
            self.points = numpy.array(value["points"]["position"])
            self.owner = numpy.repeat(numpy.arange(len(offset) - 1), numpy.diff(offset))

    def pose(self, phase):
        m = self.motion
        return (numpy.array(m["centre"][phase]), numpy.array(m["rotation"][phase]), numpy.array(m["factor"][phase]))

    def wall_points(self, phase):
        centre, turn, factor = (a[self.owner] for a in self.pose(phase))
        return centre + factor[:, None] * rotated(turn, self.points - self.centre[self.owner])


def rotated(turn, vector):
    axis, w = turn[:, :3], turn[:, 3:]
    twice = 2 * numpy.cross(axis, vector)
    return vector + w * twice + numpy.cross(axis, twice)


def distances(points, case, phase):
    """Signed distances of points from the wall of a case at a phase."""
    centre, _, factor = case.pose(phase)
    radius = case.radius * factor
    child = numpy.flatnonzero(case.parent >= 0)
    above = case.parent[child]
    a, b, ra, rb = centre[above], centre[child], radius[above], radius[child]
    _, near = cKDTree((a + b) / 2).query(points, k=min(NEAR, len(child)))
    best = numpy.full(len(points), numpy.inf)
    for edge in near.T:
        along = b[edge] - a[edge]
        share = numpy.einsum("ij,ij->i", points - a[edge], along) / numpy.maximum(numpy.einsum("ij,ij->i", along, along), 1e-12)
        share = numpy.clip(share, 0, 1)
        gap = numpy.linalg.norm(points - a[edge] - share[:, None] * along, axis=1)
        best = numpy.minimum(best, gap - (ra[edge] + share * (rb[edge] - ra[edge])))
    return best


def follow(words, folder, lumen, phases, voxel):
    """A row of the table for one drawing."""
    for old in folder.glob("phase-*.nrrd"):
        old.unlink()
    run(lumen, "phantom", *words, "--phases", phases, "--voxel", voxel, "--truth", folder / "truth.lumen", "--quiet")
    volumes = sorted(folder.glob("phase-*.nrrd"))
    run(lumen, "track", volumes[0], folder / "rest.lumen", "--quiet")
    _, seconds = run(lumen, "motion", folder / "rest.lumen", *volumes, "--out", folder / "moving.lumen", "--quiet")
    found, truth = Case(folder / "moving.lumen", lumen), Case(folder / "truth.lumen", lumen)
    moved = max(numpy.linalg.norm(truth.pose(t)[0] - truth.centre, axis=1).max() for t in range(phases))
    errors = [distances(found.wall_points(t), truth, t) / voxel for t in range(phases)]
    rest, others = numpy.abs(errors[0]), numpy.abs(numpy.concatenate(errors[1:]))
    return {"moved": moved, "rest": quantiles(rest), "moving": quantiles(others),
            "worst": max(numpy.quantile(numpy.abs(e), 0.9) for e in errors[1:]), "bias": numpy.concatenate(errors[1:]).mean(),
            "beyond": 100 * numpy.mean(others > 2), "seconds": seconds / phases}


def waves(points, height):
    """Moves of points, in voxels: waves of 160 voxels."""
    x, y, z = (2 * numpy.pi / 160 * points[..., k] for k in range(3))
    return height * numpy.stack([numpy.sin(y) + 0.6 * numpy.sin(z + 1), 0.8 * numpy.sin(z + 0.5), numpy.cos(x) + 0.4], -1)


def warped(data, folder, lumen):
    """A row of the table for each phase of a real volume that is moved by waves."""
    raw = (data / "aneurism-3dra.nrrd").read_bytes()
    voxels = numpy.frombuffer(gzip.decompress(raw[raw.index(b"\n\n") + 2:]), numpy.uint8).reshape(256, 256, 256)
    grid = numpy.stack(numpy.meshgrid(*[numpy.arange(256, dtype=numpy.float32)] * 3, indexing="ij"), -1)[..., ::-1]
    heights, files = (0, 2.5, 5, 7.5), []
    for number, height in enumerate(heights):
        source = grid
        for _ in range(8):
            source = (grid - waves(source, height)).astype(numpy.float32)
        moved = map_coordinates(voxels, [source[..., k] for k in (2, 1, 0)], order=3, mode="nearest", output=numpy.float32) if height else voxels
        files.append(folder / f"warped-{number}.nrrd")
        head = ("NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 256 256 256\nspace directions: (1,0,0) (0,1,0) "
                "(0,0,1)\nkinds: domain domain domain\nencoding: raw\nspace origin: (0,0,0)\n\n")
        files[-1].write_bytes(head.encode() + numpy.clip(numpy.round(moved), 0, 255).astype(numpy.uint8).tobytes())
    run(lumen, "track", files[0], folder / "rest.lumen", "--quiet")
    _, seconds = run(lumen, "motion", folder / "rest.lumen", *files, "--out", folder / "moving.lumen", "--quiet")
    found = Case(folder / "moving.lumen", lumen)
    out = found.points - found.centre[found.owner]
    out -= numpy.einsum("ij,ij->i", out, found.along[found.owner])[:, None] * found.along[found.owner]
    out /= numpy.linalg.norm(out, axis=1)[:, None] + 1e-9
    for phase, height in enumerate(heights):
        way = found.wall_points(phase) - found.points - waves(found.points, height)
        across = numpy.einsum("ij,ij->i", way, rotated(found.pose(phase)[1][found.owner], out))
        errors = quantiles(numpy.abs(across))
        moved = numpy.linalg.norm(waves(found.centre, height), axis=1).max()
        yield (f"| 3DRA, warped | 1 | {moved:.1f} | - | " + " / ".join(f"{e:.3f}" for e in errors) +
               f" | {errors[1]:.3f} | {across.mean():.3f} | {100 * numpy.mean(numpy.abs(across) > 2):.3f} | {seconds / len(heights):.3f} |")


def quantiles(errors):
    return [numpy.quantile(errors, q) for q in (0.5, 0.9, 0.99)]


def line(name, rows):
    def text(value):
        return f"{numpy.median([value(row) for row in rows]):.3f}"
    cells = [name, str(len(rows)), text(lambda r: r["moved"])]
    for key in ("rest", "moving"):
        cells.append(" / ".join(text(lambda r, q=q, key=key: r[key][q]) for q in range(3)))
    cells += [text(lambda r: r["worst"]), text(lambda r: r["bias"]), text(lambda r: r["beyond"]), text(lambda r: r["seconds"])]
    return "| " + " | ".join(cells) + " |"


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    data, folder, lumen = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    seeds, names = int(sys.argv[4]) if len(sys.argv) > 4 else 3, sys.argv[5:]
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["# Motions that are followed through phases", "",
             "`motions.py`: medians over noise seeds, wall errors in voxels (median / 90 % / 99 % of the wall points).", "",
             "| | seeds | moves by up to, mm | at rest | in the other phases | 90 %, worst phase | mean, outward | beyond 2 voxels, % | s of processor a phase |",
             "|---|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for name, (phantom, motion, phases, voxel, options) in CASES.items():
        if names and name not in names:
            continue
        rows = [follow((phantom, folder / "phase.nrrd", "--motion", motion, "--seed", seed, *options), folder, lumen, phases, voxel)
                for seed in range(1, seeds + 1)]
        lines.append(line(name, rows))
        print(lines[-1], flush=True)
    for tree in sorted((data / "arteries").glob("BH*.swc")) if not names or "arteries" in names else []:
        rows = [follow(("--tree", tree, folder / "phase.nrrd", "--motion", "heart"), folder, lumen, 4, 0.5)]
        lines.append(line(tree.stem, rows))
        print(lines[-1], flush=True)
    for row in warped(data, folder, lumen) if not names or "warped" in names else []:
        lines.append(row)
        print(row, flush=True)
    (folder / "motions.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
