#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Chapter 5 of the thesis again: an instrument in a vessel in SOFA, on the implicit wall and on triangle meshes.

  sofa_chapter5.py SOFA PLUGIN LUMEN CASE FOLDER [NAME ...]

SOFA is an installed SOFA v25.06, PLUGIN the folder of libLumenSofa.so, LUMEN the program, CASE the 3DRA's case (as README.md
makes it), FOLDER what comes out: scenes, recorded frames, pictures, sofa_chapter5.md. NAMEs select from: guidewire (from the
carotid's root through the siphon), distal (from behind the aneurysm into the middle cerebral artery), coil (a wire with a spiral rest shape into the aneurysm), touching (a wire in an
anterior cerebral artery beside another). Each runs on the implicit wall (plugin, the thesis' local models) and on meshes of
the case's closed surface of about 100,000 and 24,000 triangles, in the same scene otherwise. The Python
package lumen measures: PYTHONPATH=BUILD/packages/python.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from lumen import blob
from sofa_run import LEAK, axis_points, depths, draw_wires, run_scene, surface_points
from sofa_scene import Instrument, Scene, Section, scene_text

MESHES = {"mesh 100k": ("--edge", "0.77r"), "mesh 24k": ("--edge", "0.8r", "--max-error", "0.25")}
# Nitinol's effective modulus of a wound or ground guidewire is a tenth to a third of the solid's 60 GPa; its tip's less
GUIDEWIRE = Instrument(0.18, 6.5e-6, [Section(400, 134, 2e7), Section(40, 16, 2e6, turn=40)])
# platinum, wound: half of its 21.5e-6 kg/mm^3
COIL = Instrument(0.15, 1e-5, [Section(2, 1, 1e6), Section(160, 80, 1e6, turn=20, pitch=1)])


class Case:
    def __init__(self, lumen, path, folder):
        text = folder / f"case-{os.getpid()}.lumen.json"
        subprocess.run([lumen, "convert", path, text, "--quiet"], check=True)
        tree = json.loads(text.read_text())["tree"]
        text.unlink()
        self.path = path
        self.centre = np.array(tree["centre"]).reshape(-1, 3)
        self.radius = np.array(tree["radius"])
        self.branch = np.array(tree["branch"])
        self.branches = {b["label"]: b for b in tree["branches"]}
        self.labels = [b["label"] for b in tree["branches"]]
        self.model = blob.Model(path)

    def nodes(self, label):
        b = self.branches[label]
        return range(b["firstNode"], b["firstNode"] + b["nodeCount"])


def guidewire(case):
    n = case.nodes("ica")
    return n[1], Scene(GUIDEWIRE, case.centre[n[1]], case.centre[n[3]] - case.centre[n[1]], 20.0, branch="ica"), 700


def distal(case):
    """From where the carotid has passed the aneurysm, 60 mm before the first branch of the middle cerebral artery."""
    n = case.nodes("ica")
    i = n[66]
    return i, Scene(GUIDEWIRE, case.centre[i], case.centre[i + 2] - case.centre[i], 20.0, branch="ica"), 500


def coil(case):
    n = case.nodes("aneurysm")
    inwards = case.centre[n[-1]] - case.centre[n[0]]
    start = case.centre[n[0]] - 4 * inwards / np.linalg.norm(inwards)
    return n[0], Scene(COIL, start, inwards, 20.0, branch="aneurysm"), 600


def touching(case):
    """Where the anterior arteries overlap most by the program's own message, from 40 mm before on."""
    n = np.array(case.nodes("aca-1"))
    at = np.argmin(np.linalg.norm(case.centre[n] - [87.5, 205.8, 130.7], axis=1))
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(case.centre[n], axis=0), axis=1))])
    i = int(np.searchsorted(way, way[at] - 40))
    return n[i], Scene(GUIDEWIRE, case.centre[n[i]], case.centre[n[i + 2]] - case.centre[n[i]], 20.0, branch="aca-1"), 400


PARTS = {"guidewire": guidewire, "distal": distal, "coil": coil, "touching": touching}


def measure(case, part, scene, first, run):
    deep, cursors = depths(case.model, run, scene.instrument.radius, first)
    moving = run.seconds[len(run.seconds) // 20:]
    leaks = np.flatnonzero(deep > LEAK)
    held = deep[:leaks[0]] if len(leaks) else deep
    points = axis_points(run.frames[-1])[1:]
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    where = [case.labels[b] for b in case.branch[np.minimum(cursors, len(case.branch) - 1)]]
    in_sac = sum(l for l, w in zip(lengths, where[1:]) if w == "aneurysm")
    tip = scene.instrument.sections[-1]
    mass = scene.instrument.density * np.pi * scene.instrument.radius ** 2 * tip.length / tip.beams
    energy = 1e3 * 0.5 * mass * (run.speeds / 1000) ** 2 * 1e6  # nJ: kg mm^2/s^2 is a microjoule
    return {
        "part": part, "steps": len(run.seconds), "median": 1e3 * np.median(run.seconds),
        "slow": 1e3 * np.percentile(run.seconds, 99), "mean": 1e3 * run.seconds.mean() * run.busy,
        "collision": 1e3 * np.median(run.collision), "collision mean": 1e3 * run.collision.mean() * run.busy,
        "rate": 1 / (moving.mean() * run.busy), "contacts": np.median(run.contacts), "most": run.contacts.max(),
        "deep": np.percentile(held, 99) if len(held) else np.inf, "deepest": held.max() if len(held) else np.inf,
        "share": (deep > 0.1).mean(), "leak": int(leaks[0]) if len(leaks) else None, "energy": np.median(energy),
        "energy most": np.percentile(energy, 99), "tip": where[-1], "sac": in_sac, "out": lengths.sum(),
        "errors": run.errors,
    }


HEAD = ("| wall | steps | step ms, median | 99 % | collision ms, median | step ms, processor mean | of it collision | steps/s | "
        "contacts, median (most) | depth mm, 99 % (greatest) | deeper than 0.1 mm | tip nJ, median (99 %) | out mm | tip in | leaves |\n"
        "|" + "---|" * 15)


def row(name, m):
    leak = "no" if m["leak"] is None else f"at step {m['leak']}"
    extra = f", {m['sac']:.0f} in the sac" if m["part"] == "coil" else ""
    return (f"| {name} | {m['steps']} | {m['median']:.2f} | {m['slow']:.1f} | {m['collision']:.3f} | {m['mean']:.2f} | "
            f"{m['collision mean']:.3f} | {m['rate']:.0f} | {m['contacts']:.0f} ({m['most']:.0f}) | {m['deep']:.3f} "
            f"({m['deepest']:.3f}) | {100 * m['share']:.1f} % | {m['energy']:.2g} ({m['energy most']:.2g}) | {m['out']:.0f}{extra} | "
            f"{m['tip']} | {leak} |")


THESIS = """## Beside the thesis

Table 5.3 of the thesis, its collision detection per step (a processor of 2013): capsule, mesh of 12,000 triangles 4.89 ms,
local models 0.0232 ms; spiral, 45,000 triangles 5.58 ms, local models 0.0219 ms; silicon phantom, 100,000 triangles 16.23 ms
with 80 contacts, local models 0.133 ms with 82. So 122 times faster on the phantom.

Table 5.2 (distance of the tip from the wall while it slides) has no numbers in the text that is at hand; its finding is that
the tip oscillates on the mesh and slides on the local models. Depth and the tip's energy above stand for it.
"""


def report(results, sizes):
    lines = ["# Chapter 5 in SOFA", "",
             "By `tests/evaluation/reproduce/sofa_chapter5.py`. Collision: finding contacts and making constraints of them. Processor means are",
             "wall times by the share of a processor that the process had. Depth: of the instrument's surface beyond the",
             "blended field's wall at its deepest point, until it leaves (1 mm), at frames and between them.", ""]
    for part, runs in results.items():
        lines += [f"## {part}", "", HEAD, *(row(f"{name}{sizes.get(name, '')}", m) for name, m in runs.items()), ""]
        base = runs.get("implicit")
        for name, m in runs.items():
            if base and name != "implicit":
                lines += [f"Implicit beside {name}: collision {m['collision mean'] / base['collision mean']:.0f} times faster, "
                          f"whole step {m['mean'] / base['mean']:.1f} times.", ""]
    return "\n".join(lines) + "\n" + THESIS


def gathered(folder, walls):
    """Measurements of this run and of earlier ones, by part and wall."""
    results = {}
    for part in PARTS:
        for name in walls:
            file = folder / f"{part}-{name.replace(' ', '-')}.json"
            if file.exists():
                results.setdefault(part, {})[name] = json.loads(file.read_text())
    return results


def main():
    if len(sys.argv) < 6:
        sys.exit(__doc__)
    sofa, plugin, lumen, case_path, folder = (str(Path(a).resolve()) for a in sys.argv[1:6])
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    case = Case(lumen, case_path, folder)
    walls, sizes = {"implicit": {"case": case_path}}, {}
    for name, options in MESHES.items():
        mesh = folder / (name.replace(" ", "-") + ".obj")
        if not mesh.exists():
            subprocess.run([lumen, "convert", case_path, mesh, *options, "--quiet"], check=True)
        with open(mesh, encoding="utf-8") as file:
            sizes[name] = f" ({sum(line.startswith('f ') for line in file)} triangles)"
        walls[name] = {"mesh": str(mesh)}
    surface = None
    if MESHES:
        surface = surface_points(folder / (next(iter(MESHES)).replace(" ", "-") + ".obj"))
    for part in sys.argv[6:] or PARTS:
        first, scene, steps = PARTS[part](case)
        wires = {}
        for name, wall in walls.items():
            stem = f"{part}-{name.replace(' ', '-')}"
            scene.case, scene.mesh = wall.get("case", ""), wall.get("mesh", "")
            scene.record = str(folder / (stem + ".state"))
            (folder / (stem + ".scn")).write_text(scene_text(scene))
            run = run_scene(sofa, plugin, folder / (stem + ".scn"), scene.record, steps, folder)
            m = measure(case, part, scene, first, run)
            print(part, row(name, m), *m["errors"][:3], sep="\n", flush=True)
            (folder / (stem + ".json")).write_text(json.dumps(m, default=float))
            (folder / "sofa_chapter5.md").write_text(report(gathered(folder, walls), sizes))
            if np.isfinite(run.frames[-1]).all():
                wires[name] = axis_points(run.frames[-1], 5)
            if surface is not None and wires:
                draw_wires(folder / f"{part}.png", part, wires, surface)


if __name__ == "__main__":
    main()
