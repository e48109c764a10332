#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A guidewire through the siphon of the 3DRA in SOFA, with a vessel that gives way, beside walls that do not.

  sofa_soft.py SOFA PLUGIN LUMEN DATA FOLDER [NAME ...]

SOFA is an installed SOFA v25.06, PLUGIN the folder of libLumenSofa.so, LUMEN the program, DATA the folder of
aneurism-3dra.nrrd, FOLDER what comes out: case, scenes, recorded frames, a picture, sofa_soft.md. A voxel is taken as
0.5 mm, which gives the internal carotid artery its published width (Krejza et al., Carotid artery diameter in men and
women, Stroke 37, 2006: 4.7 and 5.1 mm). NAMEs select from: soft (the vessel gives way), implicit (the same wall at rest),
mesh (about 100,000 triangles at rest), and soft-stiff and implicit-stiff, with a shaft of solid nitinol. The Python package lumen measures walls at
rest (PYTHONPATH=BUILD/packages/python), and libblob itself the vessel that moves (LUMEN_BLOB_LIBRARY, BUILD/libblob/libblob.so): depths
are those of the wall where it is at each step, on all of the wire, by a pose of its own, not by the plugin.
"""
import ctypes
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from lumen import read
from sofa_chapter5 import GUIDEWIRE, Case
from sofa_run import axis_points, depths, draw_wires, run_scene, surface_points
from sofa_scene import Instrument, Scene, Section, SoftVessel, quaternion, scene_text

VOXEL = 0.5      # mm
SPACING = 3.0    # mm, of the vessel's frames
STEPS = 450      # of 0.2 mm
MARGIN = 20.0    # mm of soft vessel beyond the wire's way
NAMES = ("soft", "implicit", "mesh", "soft-stiff", "implicit-stiff")
# nitinol's 60 GPa in the whole section; plain and stiff wires have 9.5 to 158 GPa (docs/sofa.md)
STIFF = Instrument(0.18, 6.5e-6, [Section(400, 134, 6e7), GUIDEWIRE.sections[1]])
CLICKS = Path(__file__).resolve().parents[2] / "data" / "aneurism-3dra.seeds.json"
CHORD = 6.0      # mm, over which directions are taken for the turns of a vessel


# blob_sample
SAMPLE = np.dtype([("value", "f8"), ("gradient", "f8", 3), ("distance", "f8"), ("normal", "f8", 3), ("node", "u4"), ("state", "u4")])
lib = ctypes.CDLL(os.environ["LUMEN_BLOB_LIBRARY"])
lib.blob_model_open.argtypes = [ctypes.c_char_p, ctypes.c_void_p, ctypes.POINTER(ctypes.c_void_p)]
lib.blob_query_many.argtypes = [ctypes.c_void_p, ctypes.c_uint32, ctypes.c_size_t] + 3 * [ctypes.c_void_p]
lib.blob_query_many.restype = None
lib.blob_pose_create.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.POINTER(ctypes.c_void_p)]
lib.blob_pose_model.argtypes, lib.blob_pose_model.restype = [ctypes.c_void_p], ctypes.c_void_p
lib.blob_pose_set.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]


def rotated(q, v):
    """Vectors turned by quaternions (x, y, z, w)."""
    u = q[:, :3]
    t = 2 * np.cross(u, v)
    return v + q[:, 3:] * t + np.cross(u, t)


def product(a, b):
    """Quaternions a b."""
    return np.concatenate([a[:, 3:] * b[:, :3] + b[:, 3:] * a[:, :3] + np.cross(a[:, :3], b[:, :3]),
                           a[:, 3:] * b[:, 3:] - (a[:, :3] * b[:, :3]).sum(1, keepdims=True)], axis=1)


class Posed:
    """A case's model in the pose of frames that carry nodes of one chain, as BlobPose has it: nodes between two frames
    follow both, by the lengths along the tree, all others the nearest one. Its models last as long as the process."""

    def __init__(self, case, nodes, rest):
        model, self.pose, self.frames0 = ctypes.c_void_p(), ctypes.c_void_p(), rest
        if lib.blob_model_open(case.path.encode(), None, model) != 0 or lib.blob_pose_create(model, None, self.pose) != 0:
            raise RuntimeError("no pose")
        self.model = lib.blob_pose_model(self.pose)
        tree = read(case.path).tree
        self.centre, parent = tree.centre.astype(float), tree.parent
        count = len(parent)
        own = np.full(count, -1)
        own[nodes] = np.arange(len(nodes))
        above, below, up, down = own.copy(), own.copy(), np.zeros(count), np.zeros(count)
        length = np.linalg.norm(self.centre - self.centre[np.maximum(parent, 0)], axis=1)
        for i in range(count):
            if own[i] < 0 <= parent[i]:
                above[i], up[i] = above[parent[i]], up[parent[i]] + length[i]
        for i in reversed(range(count)):
            if parent[i] >= 0 and below[i] >= 0 and below[parent[i]] < 0:
                below[parent[i]], down[parent[i]] = below[i], down[i] + length[i]
        first = np.where(above >= 0, above, below)
        second = np.where((above >= 0) & (below >= 0), below, first)
        self.moved = np.flatnonzero(first >= 0).astype(np.uint32)
        self.first, self.second = first[self.moved], second[self.moved]
        whole = up[self.moved] + down[self.moved]
        self.share = np.where(self.first != self.second, up[self.moved] / np.where(whole > 0, whole, 1), 0)[:, None]

    def distances(self, points, nodes):
        """mm, of points to the wall of the blended field; the nodes of the points move."""
        points, samples = np.ascontiguousarray(points, float), np.empty(len(points), SAMPLE)
        lib.blob_query_many(self.model, 0, len(points), points.ctypes.data, nodes.ctypes.data, samples.ctypes.data)
        return samples["distance"]

    def set(self, frames):
        """`frames`: (n, 7), as SOFA records them."""
        back = self.frames0[:, 3:] * [-1, -1, -1, 1]
        turn = product(frames[:, 3:], back)
        ends = []
        for which in (self.first, self.second):
            ends.append((frames[which, :3] + rotated(turn[which], self.centre[self.moved] - self.frames0[which, :3]), turn[which]))
        sign = np.sign((ends[0][1] * ends[1][1]).sum(1, keepdims=True))
        rotation = (1 - self.share) * ends[0][1] + self.share * sign * ends[1][1]
        rows = np.concatenate([(1 - self.share) * ends[0][0] + self.share * ends[1][0], rotation, np.ones((len(rotation), 1))], axis=1)
        rows = np.ascontiguousarray(rows)
        if lib.blob_pose_set(self.pose, len(rows), self.moved.ctypes.data, rows.ctypes.data, None) != 0:
            raise RuntimeError("the frames are no pose")


def scaled_case(lumen, data, folder):
    """The 3DRA at VOXEL mm by its clicks, which are in voxels."""
    path = folder / "3dra.lumen"
    if not path.exists():
        clicks = json.loads(CLICKS.read_text())
        for branch in clicks["branches"]:
            branch["points"] = [
                [VOXEL * c for c in p] if isinstance(p, list) else
                {**p, "position": [VOXEL * c for c in p["position"]], **({"radius": VOXEL * p["radius"]} if "radius" in p else {})}
                for p in branch["points"]]
        (folder / "clicks.json").write_text(json.dumps(clicks))
        subprocess.run([lumen, "convert", data / "aneurism-3dra.nrrd", path, "--spacing", str(VOXEL), "--seeds", folder / "clicks.json",
                        "--seeds-only", "--quiet"], check=True)
    return path


def frames_along(case, nodes, length):
    """Nodes of a branch SPACING or more apart, over the first `length` mm of it; what comes behind rides along."""
    chosen, at, total = [nodes[0]], 0.0, 0.0
    for before, node in zip(nodes, nodes[1:]):
        edge = np.linalg.norm(case.centre[node] - case.centre[before])
        at, total = at + edge, total + edge
        if at >= SPACING and total <= length:
            chosen.append(node)
            at = 0.0
    return np.array(chosen)


def turns(line, until):
    """Degrees that a line turns by in all over its first `until` mm, between chords of CHORD mm."""
    way = np.insert(np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1)), 0, 0)
    at = np.arange(0, min(until, way[-1]), CHORD)
    points = np.stack([np.interp(at, way, line[:, k]) for k in range(3)], axis=1)
    chords = np.diff(points, axis=0)
    chords /= np.linalg.norm(chords, axis=1)[:, None]
    return float(np.degrees(np.arccos(np.clip((chords[1:] * chords[:-1]).sum(1), -1, 1))).sum())


def posed_depths(model, run, vessel, radius, first):
    """As depths(), with the wall where it is at each step."""
    cursors, deepest = None, []
    for frames, pose in zip(run.frames, vessel):
        points = axis_points(frames)[1:]
        if len(points) == 0:
            deepest.append(0.0)
            continue
        model.set(pose)
        if cursors is None:
            cursors = np.array([first], dtype=np.uint32)
        new = len(points) - len(cursors)
        cursors = np.concatenate([np.full(max(0, new), cursors[0], dtype=np.uint32), cursors[max(0, -new):]])
        deepest.append(float((model.distances(points, cursors) + radius).max()))
    return np.array(deepest), cursors


def read_vessel(path):
    rows = [line.split(None, 1)[1] for line in Path(path).read_text(encoding="utf-8").splitlines() if line.strip().startswith("X=")]
    return [np.array(row.split(), float).reshape(-1, 7) for row in rows]


def abscissa(case, node):
    """mm along the tree, from its root to a node."""
    tree, total = case.parent, 0.0
    while tree[node] >= 0:
        total += np.linalg.norm(case.centre[node] - case.centre[tree[node]])
        node = tree[node]
    return total


def measure(case, scene, first, run, rest):
    m = {"steps": len(run.seconds), "rate": 1 / (run.seconds.mean() * run.busy), "collision": 1e3 * run.collision.mean() * run.busy,
         "step": 1e3 * run.seconds.mean() * run.busy, "contacts": float(np.median(run.contacts)), "errors": run.errors}
    if scene.soft:
        vessel = read_vessel(scene.soft.record + ".txt" if Path(scene.soft.record + ".txt").exists() else scene.soft.record)
        deep, cursors = posed_depths(Posed(case, scene.soft.nodes, rest), run, vessel, scene.instrument.radius, first)
        reach = abscissa(case, int(cursors[-1])) - abscissa(case, first)
        last, begin = vessel[-1], rest
        m.update(moved=float(np.linalg.norm(last[:, :3] - begin[:, :3], axis=1).max()), turns=turns(last[:, :3], reach),
                 turns_rest=turns(begin[:, :3], reach), vessel=last[:, :3].tolist())
    else:
        deep, cursors = depths(case.model, run, scene.instrument.radius, first)
        reach = abscissa(case, int(cursors[-1])) - abscissa(case, first)
    m.update(deepest=float(deep.max()), deep=float(np.percentile(deep, 99)), outside=float((deep > 0.1).mean()), reach=reach,
             tip=case.labels[case.branch[int(cursors[-1])]])
    return m


HEAD = ("| wall | steps/s | step, ms | of it collision | contacts, median | deepest mm (99 %) | steps deeper than 0.1 mm | "
        "tip reaches, mm along the vessel | tip in | vessel moves, mm | its turns to there, degrees, at rest and at the end |\n" + "|" + "---|" * 11)


def row(name, m):
    soft = f"{m['moved']:.2f} | {m['turns_rest']:.0f}, {m['turns']:.0f}" if "moved" in m else "- | -"
    return (f"| {name} | {m['rate']:.0f} | {m['step']:.2f} | {m['collision']:.2f} | {m['contacts']:.0f} | {m['deepest']:.3f} ({m['deep']:.3f}) | "
            f"{100 * m['outside']:.1f} % | {m['reach']:.1f} | {m['tip']} | {soft} |")


def report(folder):
    lines = ["# A vessel that gives way, in SOFA", "",
             f"By `tests/evaluation/reproduce/sofa_soft.py`: the 3DRA at {VOXEL} mm a voxel, a guidewire of 0.36 mm (20 GPa, `stiff` 60 GPa; "
             f"its tip of 40 mm 2 GPa, resting in a circle of 40 mm), pushed {STEPS * 0.2:.0f} mm from the carotid's root. Steps a second by wall times of steps and the",
             "share of a processor that the process had. Depth: of the wire's surface beyond the blended wall where it is then.", "", HEAD]
    results = {}
    for name in NAMES:
        file = folder / f"siphon-{name}.json"
        if file.exists():
            results[name] = json.loads(file.read_text())
            lines.append(row(name, results[name]))
    if "soft" in results and "mesh" in results:
        lines += ["", f"The soft vessel runs {results['soft']['rate'] / results['mesh']['rate']:.1f} times the steps a second of the mesh at rest."]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) < 6:
        sys.exit(__doc__)
    sofa, plugin, lumen, data, folder = (Path(a).resolve() for a in sys.argv[1:6])
    folder.mkdir(parents=True, exist_ok=True)
    path = scaled_case(lumen, data, folder)
    case = Case(str(lumen), str(path), folder)
    case.parent = read(path).tree.parent
    nodes = list(case.nodes("ica"))
    first = nodes[1]
    chosen = frames_along(case, nodes, STEPS * 0.2 + MARGIN)
    centres = case.centre[chosen]
    rest = np.array([(*p, *quaternion(d)) for p, d in zip(centres, np.gradient(centres, axis=0))])
    mesh = folder / "mesh.obj"
    if not mesh.exists():
        subprocess.run([lumen, "convert", path, mesh, "--edge", "0.77r", "--quiet"], check=True)
    for name in sys.argv[6:] or NAMES:
        scene = Scene(STIFF if name.endswith("stiff") else GUIDEWIRE, case.centre[first], case.centre[nodes[3]] - case.centre[first], 20.0, branch="ica")
        scene.case, scene.mesh = ("", str(mesh)) if name == "mesh" else (str(path), "")
        scene.record = str(folder / f"siphon-{name}.state")
        if name.startswith("soft"):
            scene.soft = SoftVessel(list(chosen), centres, case.radius[chosen], str(folder / f"vessel-{name}.state"))
        file = folder / f"siphon-{name}.scn"
        file.write_text(scene_text(scene))
        run = run_scene(str(sofa), str(plugin), file, scene.record, STEPS, folder)
        m = measure(case, scene, first, run, rest)
        m["wire"] = axis_points(run.frames[-1], 5).tolist()
        print(row(name, m), *m["errors"][:3], sep="\n", flush=True)
        (folder / f"siphon-{name}.json").write_text(json.dumps(m, default=float))
        (folder / "sofa_soft.md").write_text(report(folder))
    results = {f.stem.removeprefix("siphon-"): json.loads(f.read_text()) for f in folder.glob("siphon-*.json")}
    wires = {name: np.array(m["wire"]) for name, m in results.items()}
    if "soft" in results:
        wires["vessel at rest"], wires["vessel"] = centres, np.array(results["soft"]["vessel"])
    if "soft-stiff" in results:
        wires["vessel, stiff wire"] = np.array(results["soft-stiff"]["vessel"])
    draw_wires(folder / "siphon.png", "siphon", wires, surface_points(mesh))


if __name__ == "__main__":
    main()
