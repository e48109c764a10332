#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs what `lumen export mujoco` and `lumen export cathsim` write in the official engine (npm: @mujoco/mujoco), and
asks libblob whether the guidewire stays in the lumen. Exits with 77, saying so, without node, the engine or the Python package lumen.

    check_mujoco.py --lumen LUMEN [--quick] [--case CASE.lumen --speed M/S]

Without --case: synthetic phantoms, and it fails if
- the engine refuses a folder, or its sites are not at the ends that lumen-export.json names,
- the guidewire does not advance by 0.8 of what was asked in 5 s, or its axis leaves the lumen by more than 0.05 mm,
- a coordinate is not finite, a speed is above 5 (m/s, rad/s), or a link has more than 4 contacts,
- it stays although the walls are convex hulls: so nothing above would be said by walls that are not there,
- the guidewire leaves a tube that bends and straightens by keyframes, or is not touched by it.
In `kissing`, two bent vessels that touch, the wire is not held to the lumen: it often snaps out (results.md).
--quick runs the first phantom alone, for 3 s. With --case: prints the figures of that case.
"""
import argparse
import importlib.util
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
RADIUS = 0.18  # mm, of the guidewire
SECONDS = 5  # with --quick 3
SUNK = 0.05  # mm: contacts are soft, so that the engine finds them; a wire's axis may be so far out of the lumen


def skip(reason):
    print("skipped: " + reason)
    sys.exit(77)


class Bench:
    def __init__(self, arguments, folder):
        self.lumen, self.folder, self.failures = arguments.lumen, folder, 0
        from lumen import blob
        self.open = blob.Model

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *arguments):
        subprocess.run([self.lumen, *arguments, "--quiet"], check=True)

    def phantom(self, name):
        """The phantom's true tubes, which stay as they are whatever the tracker does."""
        volume, truth, line, case = (self.path(name + end) for end in (".nrrd", "-truth.lumen", ".swc", ".lumen"))
        self.run("phantom", name, volume, "--truth", truth)
        self.run("convert", truth, line)
        self.run("convert", line, case)
        return case

    def export(self, target, case, name):
        folder = self.path(name)
        self.run("export", target, case, folder)
        with open(os.path.join(folder, "lumen-export.json"), encoding="utf-8") as file:
            return folder, json.load(file)

    def simulate(self, scene, speed, period=0):
        answer = scene + ".json"
        done = subprocess.run(["node", os.path.join(HERE, "simulate.mjs"), scene, str(SECONDS), str(speed), answer, str(period)],
                              stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            return None, done.stderr.strip()
        with open(answer, encoding="utf-8") as file:
            return json.load(file), ""

    def expect(self, holds, what):
        print(("ok    " if holds else "FAILED ") + what)
        self.failures += not holds


def deepest(model, answer, inlet):
    """Greatest distance to the wall of the wire's axis past the inlet, mm, of any record and of the last one, and the
    distance of the farthest point from the lumen; below 0 is in the lumen."""
    import numpy as np
    worst, cursor = [], None
    origin, out = np.array(inlet["position"]) * 1e3, np.array(inlet["direction"])
    for record in answer["records"]:
        points = np.array(record["points"]) * 1e3
        if not np.isfinite(points).all():
            return float("nan"), float("nan")
        if cursor is None:
            cursor = model.cursor(points)
        distance = model.query(points, cursor).distance
        # the introducer ends at the first node, half a millimetre or more behind the inlet
        inside = (points - origin) @ out < 0
        worst.append(float(distance[inside].max()) if inside.any() else float("inf"))
    return max(worst), worst[-1]


def figures(bench, name, case, scene, inlet, speed):
    answer, why = bench.simulate(scene, speed)
    if answer is None:
        print(f"FAILED {name}: the engine reports: {why}")
        bench.failures += 1
        return None
    greatest, last = deepest(bench.open(case), answer, inlet)
    answer.update(deepest=greatest, last=last, inserted=answer["records"][-1]["inserted"] * 1e3)
    print(f"      {name}: inserted {answer['inserted']:.1f} mm, axis at most {greatest:.3f} mm and last {last:.3f} mm "
          f"from the wall (0.18 mm: touching is -0.18), {answer['contacts']} contacts, speed {answer['speed']:.2f}, "
          f"{answer['restarts']} restarts, {answer['stepsPerSecond']:.0f} steps/s, {answer['counts']['geoms']} geoms")
    return answer


def expect_stay(bench, name, answer, speed):
    if answer is None:
        return
    bench.expect(answer["inserted"] > 0.8 * speed * SECONDS * 1e3, name + ": the guidewire advances")
    bench.expect(answer["deepest"] < SUNK, f"{name}: its axis stays within {SUNK} mm of the lumen")
    expect_bounded(bench, name, answer)


def expect_bounded(bench, name, answer):
    links = len(answer["records"][0]["points"]) / 3
    bench.expect(answer["restarts"] == 0 and answer["speed"] < 5, name + ": nothing explodes")
    bench.expect(answer["contacts"] <= 4 * links, name + ": contacts are bounded")


def rewritten(folder, scene, name, change):
    with open(os.path.join(folder, scene), encoding="utf-8") as file:
        text = change(file.read())
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def without_plugin(text):
    """scene.xml as scene-joints.xml is, but for the stiffness of joints."""
    text = re.sub(r" *<extension>.*?</extension>\n", "", text, flags=re.S)
    return re.sub(r" *<plugin plugin.*?</plugin>\n", "", text, flags=re.S)


def check_scenes(bench, folder):
    with open(os.path.join(folder, "scene.xml"), encoding="utf-8") as file:
        plugin = without_plugin(file.read())
    with open(os.path.join(folder, "scene-joints.xml"), encoding="utf-8") as file:
        joints = re.sub(r' stiffness="[^"]*"', "", file.read())
    bench.expect(plugin == joints, "scene.xml differs from scene-joints.xml in what makes the wire stiff only")


def check_sites(bench, name, answer, manifest):
    if answer is None:
        return
    ends, sites = manifest["ends"], answer["sites"]
    # the cable has sites of its own behind them
    apart = max(max(abs(p - q) for p, q in zip(end["position"], sites[3 * k:])) for k, end in enumerate(ends))
    bench.expect(apart < 1e-7, f"{name}: the sites are at the {len(ends)} ends")


def check_phantom(bench, phantom, speed, stays=True):
    case = bench.phantom(phantom)
    folder, manifest = bench.export("mujoco", case, phantom + "-mujoco")
    scene = os.path.join(folder, "scene-joints.xml")
    answer = figures(bench, phantom, case, scene, manifest["ends"][0], speed)
    if stays: expect_stay(bench, phantom, answer, speed)
    elif answer is not None: expect_bounded(bench, phantom, answer)
    check_sites(bench, phantom, answer, manifest)
    check_scenes(bench, folder)
    return case, folder, manifest


def check_hulls(bench, case, folder, manifest, speed):
    hulls = rewritten(folder, "scene-joints.xml", "scene-hulls.xml", lambda text: text.replace('type="sdf"', 'type="mesh"'))
    answer = figures(bench, "convex hulls", case, hulls, manifest["ends"][0], speed)
    bench.expect(answer is not None and not (answer["deepest"] < SUNK and answer["inserted"] > 0.8 * speed * SECONDS * 1e3),
                 "convex hulls throw the guidewire out, or do not let it in")


def check_cathsim(bench, case, folder, manifest, speed):
    """CathSim's phantom with the guidewire of the scene for MuJoCo in it."""
    phantom, _ = bench.export("cathsim", case, "cathsim")
    assets = os.path.join(phantom, "phantom_assets")
    with open(os.path.join(assets, "vessel.xml"), encoding="utf-8") as file:
        vessel = file.read()
    alone = bench.simulate(os.path.join(assets, "vessel.xml"), 0)
    bench.expect(alone[0] is not None, "cathsim: the engine loads the phantom " + alone[1])
    part = lambda tag: re.search(rf"<{tag}>(.*?)</{tag}>", vessel, flags=re.S).group(1)
    with open(os.path.join(folder, "scene-joints.xml"), encoding="utf-8") as file:
        scene = file.read()
    scene = re.sub(r" *<geom name=\"wall_.*?\n", "", scene)
    scene = re.sub(r"<asset>.*?</asset>", lambda _: "<asset>" + part("asset") + "</asset>", scene, flags=re.S)
    body = re.sub(r" *<site .*?\n", "", part("worldbody")).replace('<geom name="hull', '<geom class="wall" name="hull')
    scene = scene.replace("<worldbody>", "<worldbody>" + body, 1)
    with open(os.path.join(assets, "with-wire.xml"), "w", encoding="utf-8") as file:
        file.write(scene)
    answer = figures(bench, "cathsim", case, os.path.join(assets, "with-wire.xml"), manifest["ends"][0], speed)
    if answer is not None:
        bench.expect(answer["inserted"] > 0.8 * speed * SECONDS * 1e3, "cathsim: the guidewire advances")
        bench.expect(answer["deepest"] < SUNK, f"cathsim: its axis stays within {SUNK} mm of the lumen")


def bending_tube(bench):
    """A tube of 40 mm and a radius of 1.5 mm, whose end goes 12 mm aside and back in 2.5 s."""
    count, radius, aside, period = 41, 1.5, 12.0, 2.5
    line, still, moving = bench.path("straight.swc"), bench.path("straight.lumen.json"), bench.path("bending.lumen")
    with open(line, "w", encoding="utf-8") as file:
        for x in range(count): file.write(f"{x + 1} 0 {x} 0 0 {radius} {x if x else -1}\n")
    bench.run("convert", line, still)
    with open(still, encoding="utf-8") as file: case = json.load(file)
    end = count - 1
    half = [math.atan(2 * aside * x / end**2) / 2 for x in range(count)]
    case["version"] = "1.2"
    case["motion"] = {
        "period": period, "time": [0, period / 2], "node": list(range(count)), "factor": [[1] * count] * 2,
        "centre": [[[x, 0, 0] for x in range(count)], [[x, aside * (x / end)**2, 0] for x in range(count)]],
        "rotation": [[[0, 0, 0, 1]] * count, [[0, 0, math.sin(a), math.cos(a)] for a in half]]}
    with open(still, "w", encoding="utf-8") as file: json.dump(case, file)
    bench.run("convert", still, moving)
    return moving, radius, period


def check_moving(bench, speed):
    case, radius, period = bending_tube(bench)
    folder, manifest = bench.export("mujoco", case, "bending-mujoco")
    answer, why = bench.simulate(os.path.join(folder, "scene-joints.xml"), speed, period)
    bench.expect(answer is not None, "bending tube: the engine loads it " + why)
    if answer is None: return
    worst, now = [], bench.path("now.lumen")
    for record in answer["records"][4::5]:
        bench.run("convert", case, now, "--time", repr(record["time"]))
        worst.append(deepest(bench.open(now), {"records": [record]}, manifest["ends"][0])[0])
    off = float(re.search(r"up to ([0-9.]+) radii off", " ".join(manifest["losses"])).group(1)) * radius
    inserted = answer["records"][-1]["inserted"] * 1e3
    print(f"      bending tube: {answer['counts']['moving']} bodies, inserted {inserted:.1f} mm, axis at most {max(worst):.3f} mm "
          f"from the wall, whose bodies are up to {off:.3f} mm off, {answer['contacts']} contacts, speed {answer['speed']:.2f}")
    bench.expect(answer["counts"]["moving"] > 2 and answer["counts"]["keys"] == 3, "bending tube: keyframes place its bodies")
    bench.expect(answer["contacts"] > 0, "bending tube: it takes the guidewire along")
    bench.expect(inserted > 0.8 * speed * SECONDS * 1e3, "bending tube: the guidewire advances")
    bench.expect(max(worst) < SUNK + off, f"bending tube: its axis stays within {SUNK} mm of the lumen, and what the bodies are off")
    bench.expect(answer["restarts"] == 0 and answer["speed"] < 5, "bending tube: nothing explodes")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--lumen", required=True)
    parser.add_argument("--case")
    parser.add_argument("--speed", type=float, default=0.004)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--keep", help="a folder for what is written")
    arguments = parser.parse_args()
    if shutil.which("node") is None:
        skip("node is not here (apt install nodejs npm)")
    if not os.path.isdir(os.path.join(HERE, "node_modules", "@mujoco", "mujoco")):
        skip("the engine is not here (npm ci in tests/mujoco)")
    if importlib.util.find_spec("lumen") is None:
        skip("the Python package lumen is not here; PYTHONPATH has its folder, BUILD/packages/python")
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(arguments, arguments.keep or scratch)
        if arguments.quick:
            global SECONDS
            SECONDS = 3
            check_phantom(bench, "bifurcation", arguments.speed)
        elif arguments.case:
            folder, manifest = bench.export("mujoco", arguments.case, "case-mujoco")
            figures(bench, os.path.basename(arguments.case), arguments.case, os.path.join(folder, "scene-joints.xml"),
                    manifest["ends"][0], arguments.speed)
        else:
            case, folder, manifest = check_phantom(bench, "bifurcation", arguments.speed)
            check_hulls(bench, case, folder, manifest, arguments.speed)
            check_cathsim(bench, case, folder, manifest, arguments.speed)
            check_phantom(bench, "kissing", arguments.speed, stays=False)
            check_moving(bench, arguments.speed)
        sys.exit(bench.failures > 0)


if __name__ == "__main__":
    main()
