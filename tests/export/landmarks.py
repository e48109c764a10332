#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One case through every target of lumen export, and located again by the target's own loader.

landmarks.py BATCH_LUMEN [--only TARGET...]

The case is a synthetic fork (landmark.swc), asymmetric, so that no two axes and no two ends can be mistaken for one
another. Each folder is checked: lumen-export.json agrees with its schema and with the files; its ends, brought back by its
transform, are those of the surface; the places that the target's loader finds (loaders.py) are those of the case, by the
frame and unit that the target is known to have, to 1e-4 mm. Exit status: 0 all, 1 some not, 77 nothing could be read."""
import argparse, hashlib, json, pathlib, sys, tempfile
try:
    import numpy as np
    import vtkmodules.vtkIOXML
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)
HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "cli"))
import loaders
from batch import Batch
from loaders import farthest

TOLERANCE = 1e-4  # mm


def run(lumen, *words):
    done = lumen.run(words, "/")
    if done.returncode != 0: sys.exit(f"landmarks.py: {' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


class Reference:
    """The case in mm, LPS: its tree, and the surface with its ends for a wall of a certain thickness."""

    def __init__(self, lumen, folder):
        self.lumen, self.folder = lumen, folder
        self.case = folder / "landmark.lumen"
        run(lumen, "convert", HERE / "landmark.swc", self.case, "--quiet")
        rows = [line.split() for line in (HERE / "landmark.swc").read_text().splitlines() if line[0] != "#"]
        self.tree = np.array([[float(x) for x in row[2:5]] for row in rows])
        self.surfaces = {}

    def surface(self, options):
        """Vertices, triangles, group of each triangle, names of groups; by VTK's reader of lumen's .vtp."""
        key = tuple(options)
        if key not in self.surfaces:
            file = self.folder / f"reference{len(self.surfaces)}.vtp"
            run(self.lumen, "convert", self.case, file, "--quiet", *options)
            self.surfaces[key] = loaders.read_vtp(file)
        return self.surfaces[key]


def ends_of(surface):
    """The middle of the rim that each group but walls shares with the lumen's wall, by the lengths of its edges."""
    points, triangles, group, names = surface
    edges = {}
    for t, g in zip(triangles, group):
        for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0])): edges.setdefault((min(a, b), max(a, b)), []).append(g)
    sums = {}
    for (a, b), groups in edges.items():
        if 0 not in groups: continue
        for g in groups:
            if g == 0: continue
            length = np.linalg.norm(points[b] - points[a])
            total = sums.setdefault(names[g], [np.zeros(3), 0.0])
            total[0] += length * (points[a] + points[b]) / 2
            total[1] += length
    return {name: middle / length for name, (middle, length) in sums.items()}


class Faults(list):
    def expect(self, holds, sentence):
        if not holds: self.append(sentence)

    def near(self, distance, what):
        self.expect(distance <= TOLERANCE, f"{what}: found {distance:.3g} mm off, expected at most {TOLERANCE} mm")


def check_manifest(folder, target, reference_ends, faults):
    manifest = json.loads((folder / "lumen-export.json").read_text())
    faults.extend(loaders.schema_faults(manifest, HERE.parent.parent / "spec/schema/export.schema.json"))
    faults.expect(manifest["target"] == target, f"lumen-export.json says target {manifest['target']}")
    listed = {file["name"]: file for file in manifest["files"]}
    there = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()} - {"lumen-export.json"}
    faults.expect(set(listed) == there, f"lumen-export.json and the folder differ in {set(listed) ^ there}")
    for name, file in listed.items():
        data = (folder / name).read_bytes()
        faults.expect(file["sha256"] == hashlib.sha256(data).hexdigest(), f"{name}: another digest than is listed")
        faults.expect(file["bytes"] == len(data), f"{name}: another size than is listed")
    back = np.linalg.inv(np.array(manifest["transform"]))
    for end in manifest["ends"]:
        if end["name"] not in reference_ends:
            faults.append(f"lumen-export.json has an end {end['name']}, expected one of {sorted(reference_ends)}")
            continue
        place = back @ np.array([*end["position"], 1])
        faults.near(np.linalg.norm(place[:3] - reference_ends[end["name"]]), f"end {end['name']} of lumen-export.json")
    faults.expect({e["name"] for e in manifest["ends"]} == set(reference_ends), "lumen-export.json lacks an end")
    return manifest


def check_target(target, loader, reference, work):
    """The sentences of what is wrong, or None and why if the loader is not here."""
    folder = work / target
    run(reference.lumen, "export", target, reference.case, folder, "--quiet", *loader.options)
    surface = reference.surface(["--edge", "0.5r", *loader.surface])
    # an inlet and outlets named by the tree, where a target has no surface
    named = surface if loader.ends is None else reference.surface(["--edge", "0.5r", *loader.ends])
    ends = ends_of(named) if loader.has_surface else loaders.ends_of_tree(reference.tree)
    faults = Faults()
    check_manifest(folder, target, ends, faults)
    found, why = loader.read(folder)
    if found is None: return None, why
    if found.vertices is not None:
        faults.near(farthest(found.vertices, surface[0]), "a vertex")
        faults.near(farthest(surface[0], found.vertices), "a vertex of the surface that is not there")
    if found.centerline is not None:
        faults.near(farthest(found.centerline, reference.tree), "a point of the centerline")
        faults.near(farthest(reference.tree, found.centerline), "a node of the tree that is not there")
    for name, place in found.ends.items():
        if name in ends: faults.near(np.linalg.norm(place - ends[name]), f"end {name}")
        else: faults.append(f"end {name} is none of {sorted(ends)}")
    faults.expect(found.vertices is not None or found.centerline is not None or found.ends or found.samples, "nothing was located")
    faults.extend(found.faults)
    return faults, ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("lumen", type=pathlib.Path)
    parser.add_argument("--only", nargs="*", default=[])
    arguments = parser.parse_args()
    lumen = Batch(arguments.lumen.resolve())
    targets = [t["name"] for t in json.loads(run(lumen, "export", "--list", "--json"))["targets"]]
    lacking = sorted(set(targets) - set(loaders.LOADERS))
    if lacking: sys.exit(f"landmarks.py: no loader for {', '.join(lacking)}; expected one for each target")
    failed = read = 0
    with tempfile.TemporaryDirectory() as name:
        reference = Reference(lumen, pathlib.Path(name))
        # the reference is where landmark.swc has it: half a radius, or half a node, behind the last node
        for end, place in ends_of(reference.surface(["--edge", "0.5r"])).items():
            tip = loaders.ends_of_tree(reference.tree)[end]
            if np.linalg.norm(place - tip) > 1.5: sys.exit(f"landmarks.py: {end} at {place}, expected near {tip}")
        for target in arguments.only or targets:
            faults, why = check_target(target, loaders.LOADERS[target], reference, pathlib.Path(name))
            if faults is None:
                print(f"{target}: not read, {why}")
                continue
            read += 1
            failed += bool(faults)
            print(f"{target}: " + ("located" if not faults else "; ".join(faults[:5])))
    print(f"{read - failed} passed, {failed} failed")
    return 1 if failed else 0 if read else 77


if __name__ == "__main__":
    sys.exit(main())
