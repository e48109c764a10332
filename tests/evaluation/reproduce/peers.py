#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""VMTK, TubeTK, kimimaro and skan beside lumen, on the same maps and volumes, by the same score.

  peers.py DATA FOLDER LUMEN [INPUT ...]
  peers.py hold DATA LUMEN

A coarse map is made from a true tree: voxels of 1.5 mm, a place beside by a voxel of the scan, without the thinnest 40 % of the length,
with gaps of 4 to 8 mm every 30 mm. Inputs are the maps of arterial trees alone (BG05-map, ...), a tree drawn into the head CT of DATA/prior, with its map
and one of bone (BG08-head), and the MR angiogram of DATA/aorta with a map made of VMTK's centerline. kimimaro, skan and VMTK's network
extraction read the map; VMTK's level sets and TubeTK the volume, from the map; lumen the map, the volume, and both. Found and false are
those of drawn_into.py; nothing is false in the aorta, whose truth is a part of it. Radii are compared where an axis is right, with the
radius of the nearest true axis, in edges of a voxel of the volume, or else of the map. Seconds are of a processor.

Everything stays in FOLDER, and so does peers.md, which is printed too. The second form is a test: it fails where a peer finds more than lumen
does with the map, or, in a volume, where less of what a peer finds is false. Runs in an environment with the packages of peers.txt:
python3.12 -m venv ENV && ENV/bin/pip install --require-hashes -r peers.txt && ENV/bin/python peers.py ...
"""
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
import SimpleITK
from scipy.spatial import cKDTree

from drawn_into import UPRIGHT, Axes, compare, run
from peer_trees import PEERS

COARSE, FINE = 1.5, 0.6  # mm, edges of a map's voxels, and of the scan's where there is none
LOST, APART, GAPS = 0.4, 30.0, (4.0, 8.0)  # share of the length; mm between gaps; their lengths, mm
BONE = 500  # HU
MOST = 60  # seconds of a processor that one has
INPUTS = ("BG05-map", "BG08-head", "aorta")
ON_VOLUME = ("vmtk-levels", "tubetk")


def coarse_map(file, true, shift, volume, bone):
    """Draws a map: 1 are vessels, 2 is bone of the volume."""
    points, radii, lengths = (numpy.array(column) for column in zip(*true.pieces))
    kept, chance = radii > numpy.quantile(radii, LOST), numpy.random.default_rng(1)
    for _ in range(round(lengths[kept].sum() / APART)):
        kept &= numpy.linalg.norm(points - points[chance.integers(len(points))], axis=1) > chance.uniform(*GAPS) / 2
    points, radii = points[kept], radii[kept]
    low = numpy.array(volume.GetOrigin()) if volume else points.min(axis=0) - 5
    high = low + numpy.array(volume.GetSize()) * volume.GetSpacing() if volume else points.max(axis=0) + 5
    size = numpy.ceil((high - low) / COARSE).astype(int)
    places = low + COARSE * numpy.stack(numpy.meshgrid(*map(numpy.arange, size), indexing="ij"), -1)
    labels = numpy.zeros(size, numpy.uint8)
    distance, nearest = cKDTree(points).query(places.reshape(-1, 3), k=4, distance_upper_bound=radii.max() + COARSE)
    reach = numpy.maximum(numpy.append(radii, 0), COARSE / 2)[nearest]  # a voxel wide at least
    labels.reshape(-1)[(distance < reach).any(axis=1)] = 1
    if bone:
        cells = numpy.minimum(numpy.rint((places - low) / volume.GetSpacing()).astype(int), numpy.array(volume.GetSize()) - 1)
        hard = SimpleITK.GetArrayViewFromImage(volume)[cells[..., 2], cells[..., 1], cells[..., 0]] > BONE
        labels[hard & (labels == 0)] = 2
    image = SimpleITK.GetImageFromArray(labels.transpose(2, 1, 0))
    image.SetSpacing([COARSE] * 3)
    image.SetOrigin((low + (shift, 0, 0)).tolist())
    SimpleITK.WriteImage(image, str(file), True)
    file.with_suffix(".json").write_text(json.dumps({"labels": {"background": 0, "artery": 1, "skull": 2}}))


def radius_errors(true, found):
    """Errors of radii where an axis is right: median with its sign, and the size that 90 % of the length do not exceed."""
    if not found.pieces: return math.nan, math.nan
    points, radii, _ = (numpy.array(column) for column in zip(*true.pieces))
    at, width, length = (numpy.array(column) for column in zip(*found.pieces))
    distance, nearest = cKDTree(points).query(at)
    right = distance <= numpy.maximum(radii[nearest], true.voxel)
    if not right.any(): return math.nan, math.nan
    errors, length = (width - radii[nearest])[right] / true.voxel, length[right]

    def share(values, part):
        order = numpy.argsort(values)
        return values[order][numpy.searchsorted(numpy.cumsum(length[order]), part * length.sum())]

    return share(errors, 0.5), share(abs(errors), 0.9)


class Input:
    """A true tree with its map, and perhaps a volume."""

    def __init__(self, data, folder, lumen, name):
        self.name, self.folder, self.lumen, self.options = name, folder, lumen, []
        self.map, truth, self.volume = folder / f"{name}.map.nrrd", folder / f"{name}.truth.lumen", None
        if name.endswith("-map"): truth = data / f"arteries/{name[:-4]}.swc"
        elif name.endswith("-head"):
            self.volume = folder / f"{name}.nrrd"
            run(lumen, "phantom", "--tree", data / f"arteries/{name[:-5]}.swc", "--into", data / "prior/head-ct-native.nrrd", "--turn", UPRIGHT,
                self.volume, "--truth", truth)
        else:
            self.volume, self.options = folder / f"{name}.nrrd", ["--only-labelled"]
            upright = SimpleITK.DICOMOrient(SimpleITK.ReadImage(str(data / "aorta/aorta.mha")), "LPS")  # peers know no axes
            SimpleITK.WriteImage(upright, str(self.volume))
            run(lumen, "convert", data / "aorta/aorta-centerline.vtp", "--frame", "ras", truth)
        self.image = SimpleITK.ReadImage(str(self.volume)) if self.volume else None
        self.true = Axes(lumen, truth)
        self.true.voxel = math.prod(self.image.GetSpacing()) ** (1 / 3) if self.volume else COARSE
        coarse_map(self.map, self.true, self.true.voxel if self.volume else FINE, self.image, name.endswith("-head"))

    def ways(self):
        """Programs that find the tree, as (name, command without the output)."""
        if self.volume and not self.options: yield "lumen, volume", [self.lumen, "convert", self.volume]
        if self.volume: yield "lumen, volume and map", [self.lumen, "convert", self.volume, "--label-map", self.map, "--label-table",
                                                        self.map.with_suffix(".json"), *self.options]
        else: yield "lumen, map", [self.lumen, "convert", self.map, "--label", 1]
        for peer in PEERS:
            if peer not in ON_VOLUME or self.volume:
                yield peer, [sys.executable, "-B", Path(__file__).with_name("peer_trees.py"), peer, self.map, self.volume or "-"]

    def result(self, way, command):
        """Share found, mm found, share false, both errors of radii, seconds; or why there is none."""
        end = "lumen" if command[0] == self.lumen else "tre" if way == "tubetk" else "swc"
        out = self.folder / f"{self.name}-{way.replace(', ', '-').replace(' ', '-')}.{end}"
        out.unlink(missing_ok=True)
        before = os.times()
        done = subprocess.run([*map(str, command), str(out)], capture_output=True, text=True, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (MOST, MOST + 1)))
        seconds = sum(os.times()[2:4]) - sum(before[2:4])
        if seconds >= MOST: return f"no answer in {MOST} s"
        if done.returncode != 0 or not out.exists():
            return f"failed: {(done.stderr.strip().splitlines() or [f'exit code {done.returncode}'])[-1]}"
        found = Axes(self.lumen, out)
        _, held, found_mm, false = compare(self.true, found)
        return held, found_mm, math.nan if self.options else false, *radius_errors(self.true, found), seconds

    def results(self):
        for way, command in self.ways(): yield way, self.result(way, command)


def row(name, way, result):
    if isinstance(result, str): return f"| {name} | {way} | {result} | | | | | |"
    texts = [form % value for form, value in zip(("%.3f", "%.0f", "%.3f", "%+.2f", "%.2f", "%.0f"), result)]
    return f"| {name} | {way} | {' | '.join('-' if 'nan' in text else text for text in texts)} |"


def hold(data, lumen):
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        for name in INPUTS:
            one = Input(Path(data), Path(folder), lumen, name)
            results = {}
            for way, result in one.results():
                print(row(name, way, result), flush=True)
                results[way] = result
            own = next(result for way, result in results.items() if way.endswith("map") and way.startswith("lumen"))
            for way, result in results.items():
                if way in PEERS and not isinstance(result, str) and (result[0] > own[0] or (one.volume and result[2] < own[2])):
                    faults.append(f"{name}: {way} is better than lumen")
    sys.exit("\n".join(faults) or 0)


def main():
    if sys.argv[1] == "hold": hold(*sys.argv[2:])
    data, folder, lumen, *names = sys.argv[1:]
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["| input | by | found | mm found | false | radius, median | radius, 90 % | s |", "|---|---|--:|--:|--:|--:|--:|--:|"]
    for name in names or INPUTS:
        one = Input(Path(data), folder, lumen, name)
        for way, result in one.results():
            lines.append(row(name, way, result))
            print(lines[-1], flush=True)
    (folder / "peers.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__": main()
