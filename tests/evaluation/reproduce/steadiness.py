#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether results depend on none of these: random seeds, containers, an origin or clicks that move a little, and careless clicks.

  steadiness.py DATA FOLDER LUMEN [NAME ...]

Phantoms and the volumes of DATA are converted by default options, again with ten random seeds, from other containers of the same voxels
(MetaImage, NIfTI, DICOM where voxels are whole numbers), with the origin moved by a nanometre, and with the vessels that were found
as clicks, which move by 1 nm, 1 um and 0.1 voxel. A vessel *comes or goes* if it is longer than 5 mm and more than half of it lies
outside of all vessels of the other case. Then the trees of DATA/arteries and ten patients are clicked carelessly in ten drawings, with
parents named and without. NAMEs choose volumes or trees. Needs python3-nibabel, python3-pydicom, python3-scipy. Volumes are deleted
again; steadiness.md stays in FOLDER and is printed.
"""
import json
import subprocess
import sys
from pathlib import Path

import numpy
from scipy.spatial import cKDTree

from forks import tree_of
from volumes import read, write_dicom, write_metaimage, write_nifti, write_nrrd

PHANTOMS = [("bifurcation", ["bifurcation"]), ("kissing", ["kissing"]), ("willis", ["willis"]), ("patient-1", ["patient", "--seed", "1"])]
VOLUMES = [("3DRA", "aneurism-3dra.nrrd"), ("aorta", "aorta/aorta.mha"), ("fistula", "avf/avf.nii"),
           ("carotid, speed of blood", "more/carotid-pcmr.nrrd")]
RANDOM_SEEDS = range(1, 11)
DRAWINGS = range(1, 11)
LONG = 5.0  # mm
MOVES = [("1 nm", 1e-6), ("1 um", 1e-3)]  # mm


def convert(lumen, volume, case, *options):
    done = subprocess.run([str(x) for x in (lumen, "convert", volume, case, "--json", "--quiet", *options)], capture_output=True, text=True, check=False)
    if done.returncode != 0: sys.exit(f"steadiness.py: {volume}: {done.stderr}")
    return json.loads(done.stdout)["length_mm"], tree_of(lumen, case)


def strangers(tree, other):
    """Vessels of a tree that are longer than LONG and lie mostly outside of all vessels of another tree."""
    centres = numpy.array(other["centre"])
    near, radii, found = cKDTree(centres), numpy.array(other["radius"]), 0
    for branch in tree["branches"]:
        nodes = numpy.array(tree["centre"][branch["firstNode"]:branch["firstNode"] + branch["nodeCount"]])
        if len(nodes) < 2 or numpy.linalg.norm(numpy.diff(nodes, axis=0), axis=1).sum() <= LONG: continue
        away, index = near.query(nodes)
        found += (away > numpy.maximum(radii[index], 0.5)).mean() > 0.5
    return found


def compared(first, others):
    """Greatest difference from the first length as a share, and the most vessels that come or go."""
    if not others: return "-"
    spread = max(abs(length - first[0]) for length, _ in others) / first[0]
    changed = max(strangers(tree, first[1]) + strangers(first[1], tree) for _, tree in others)
    return f"{100 * spread:.2f} %, {changed}"


def moved_clicks(folder, seeds, by):
    """The seeds with each control point moved by a vector of this length, in a fixed pseudo-random direction."""
    document, random = json.loads(seeds.read_text()), numpy.random.default_rng(1)
    for markup in document["markups"]:
        for point in markup["controlPoints"]:
            step = random.normal(size=3)
            point["position"] = [float(x) for x in numpy.array(point["position"]) + by * step / numpy.linalg.norm(step)]
    file = folder / "moved.mrk.json"
    file.write_text(json.dumps(document))
    return file


def steady_row(lumen, folder, name, file):
    volume, case = read(file), folder / "steady.lumen"
    first = convert(lumen, file, case)
    seeds = [convert(lumen, file, case, "--random-seed", seed) for seed in RANDOM_SEEDS]
    containers = []
    for written, write in (("v.mha", write_metaimage), ("v.nii", write_nifti), ("v.nrrd", write_nrrd)):
        write(volume, folder / written)
        containers.append(convert(lumen, folder / written, case))
        (folder / written).unlink()
    if volume.voxels.dtype.kind in "iu":
        write_dicom(volume, folder / "v")
        containers.append(convert(lumen, folder / "v", case))
        for slice_ in (folder / "v").iterdir(): slice_.unlink()
        (folder / "v").rmdir()
    write_nrrd(volume, folder / "v.nrrd", 1e-6)
    origin = [convert(lumen, folder / "v.nrrd", case)]
    (folder / "v.nrrd").unlink()
    clicks = folder / "clicks.mrk.json"
    clicks.unlink(missing_ok=True)
    subprocess.run([str(lumen), "seeds", str(file), str(clicks), "--quiet"], check=True, capture_output=True)
    hinted = convert(lumen, file, case, "--seeds", clicks)
    voxel = float(numpy.linalg.norm(volume.affine[:3, :3], axis=0).min())
    moves = [compared(hinted, [convert(lumen, file, case, "--seeds", moved_clicks(folder, clicks, by))]) for _, by in (*MOVES, ("voxel", 0.1 * voxel))]
    return f"| {name} | {first[0]:.0f} | {compared(first, seeds)} | {compared(first, containers)} | {compared(first, origin)} | {' | '.join(moves)} |"


def careless_row(lumen, folder, name, options):
    """Length covered and false without a click, and the worst of ten drawings of careless clicks, parents named or not."""
    volume, truth, case, seeds = (folder / f"careless{end}" for end in (".nrrd", ".truth.lumen", ".lumen.json", ".json"))

    def figures(*hints):
        subprocess.run([str(lumen), "convert", str(volume), str(case), "--quiet", *map(str, hints)], check=True, capture_output=True)
        twin = json.loads(case.read_text())
        for i, branch in enumerate(twin["tree"]["branches"]): branch["label"] = f"found {i}"  # lumen compare would pair vessels by name, not by place
        case.write_text(json.dumps(twin))
        score = json.loads(subprocess.run([str(lumen), "compare", str(case), str(truth), "--json", "--quiet"],
                                          check=True, capture_output=True, text=True).stdout)
        return length - score["missed_mm"], score["false_mm"]

    rows = {"named": [], "not named": []}
    for drawing in DRAWINGS:
        made = json.loads(subprocess.run([str(x) for x in (lumen, "phantom", *options, volume, "--truth", truth, "--seeds", seeds, "--clicks", "careless",
                                                            "--click-drawing", drawing, "--json", "--quiet")], check=True, capture_output=True, text=True).stdout)
        length = made["length_mm"]
        if drawing == DRAWINGS[0]: alone = figures()
        rows["named"].append(figures("--seeds", seeds))
        document = json.loads(seeds.read_text())
        for seed in document["branches"]: seed.pop("parent", None)
        seeds.write_text(json.dumps(document))
        rows["not named"].append(figures("--seeds", seeds))
    for file in (volume, truth, case, seeds): file.unlink()
    worst = [f"{100 * min(c for c, _ in drawn) / length:.2f} %, {max(f for _, f in drawn):.1f} mm" for drawn in rows.values()]
    return f"| {name} | {100 * alone[0] / length:.2f} %, {alone[1]:.1f} mm | {' | '.join(worst)} |"


def main():
    data, folder, lumen, names = Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3]).resolve(), set(sys.argv[4:])
    folder.mkdir(parents=True, exist_ok=True)
    wanted = lambda name: not names or name in names
    lines = ["# Steadiness", "", "Greatest change of the total length, and the most vessels of over 5 mm that come or go.", "",
             "| volume | mm | ten random seeds | containers | origin by 1 nm | clicks by 1 nm | 1 um | 0.1 voxel |", "|---|--:|---|---|---|---|---|---|"]
    for name, options in PHANTOMS:
        if not wanted(name): continue
        subprocess.run([str(lumen), "phantom", *options, str(folder / "p.nrrd"), "--quiet"], check=True, capture_output=True)
        lines.append(steady_row(lumen, folder, name, folder / "p.nrrd"))
        print(lines[-1], flush=True)
    for name, file in VOLUMES:
        if wanted(name) and (data / file).exists():
            lines.append(steady_row(lumen, folder, name, data / file))
            print(lines[-1], flush=True)
    lines += ["", "## Careless clicks", "", "Length covered and false length without a click, and the least and the most of ten drawings.", "",
              "| volume | no click | parents named, worst | not named, worst |", "|---|---|---|---|"]
    designs = [(f"patient-{seed} clicked", ["patient", "--seed", seed]) for seed in range(1, 11)]
    designs += [(tree.stem, ["--tree", tree, "--voxel", 0.3]) for tree in sorted((data / "arteries").glob("*.swc"))]
    for name, options in designs:
        if wanted(name):
            lines.append(careless_row(lumen, folder, name, options))
            print(lines[-1], flush=True)
    (folder / "steadiness.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
