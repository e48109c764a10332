#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plays the glTF of a case with a motion in three.js, and compares its vertices with the wall of the posed field.

check_motion.py LUMEN CASE_READER NODE NODE_MODULES [--print]

A bifurcation is tracked in a phantom, bent about its root and widened towards its tips, at three times. Plain and
meshopt-coded GLBs are played with three.js at times between these; the reader of the conformance set answers for the posed
field at each vertex. Blender imports the plain one, where it is installed: an armature, an action and the same vertices.
Exit status: 0 all hold, 1 not, 77 without node's packages."""
import json, math, pathlib, shutil, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
TIMES = (0.0, 0.25, 0.5, 0.875, 1.25)
BEND, GROWTH = 0.045, 0.012  # radians and shares of the radius per mm along the tree
MOST, USUAL = 0.03, 0.005    # distance of a vertex from the wall beyond that at rest, in radii: at most, and for 95 of 100
faults = []


def run(*command, **more):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=300, **more)
    if done.returncode: sys.exit(f"{' '.join(map(str, command))[:300]}: {done.returncode}: {done.stderr[-2000:]}")
    return done.stdout


def hold(condition, sentence):
    if not condition: faults.append(sentence)


def rotated(angle, axis, v):
    """Rodrigues' formula."""
    c, s = math.cos(angle), math.sin(angle)
    dot = sum(a * x for a, x in zip(axis, v))
    cross = [axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0]]
    return [c * x + s * y + (1 - c) * dot * a for x, y, a in zip(v, cross, axis)]


def with_motion(case):
    """The case, bent about its root at 0.5 s, bent the other way at 1 s, and back after 1.5 s."""
    tree, axis = case["tree"], [0.6, 0.8, 0]
    count, along = len(tree["centre"]), []
    for i, parent in enumerate(tree["parent"]):
        along.append(0 if parent < 0 else along[parent] + math.dist(tree["centre"][i], tree["centre"][parent]))
    motion = {"period": 1.5, "time": [0, 0.5, 1], "node": list(range(count)), "centre": [], "rotation": [], "factor": []}
    for share in (0, 1, -0.6):
        angle, places = [share * BEND * a for a in along], []
        for i, parent in enumerate(tree["parent"]):
            if parent < 0: places.append(tree["centre"][i])
            else:
                edge = [a - b for a, b in zip(tree["centre"][i], tree["centre"][parent])]
                places.append([a + b for a, b in zip(places[parent], rotated((angle[i] + angle[parent]) / 2, axis, edge))])
        motion["centre"].append(places)
        motion["rotation"].append([[math.sin(a / 2) * x for x in axis] + [math.cos(a / 2)] for a in angle])
        motion["factor"].append([1 + abs(share) * GROWTH * a for a in along])
    case.update(version="1.2", motion=motion)
    return case


def distances(reader, case, points, time):
    """First-order distance of points from the wall, in radii, unsigned, and the node that answers for each."""
    questions = [{"point": p, **({} if time is None else {"time": time})} for p in points]
    out = json.loads(run(reader, input=json.dumps({"file": str(case), "questions": questions}) + "\n"))
    level, found = out["case"]["models"]["isoLevel"], []
    for answer in out["answers"]:
        field = answer["blended"]
        radius = out["case"]["tree"]["radius"][answer["node"]]
        found.append(abs(level - field["value"]) / max(math.hypot(*field["gradient"]), 1e-9) / radius)
    return found


def lps(point):
    return [1000 * point[0], -1000 * point[2], 1000 * point[1]]


def check_frames(reader, case, played, name):
    rest = distances(reader, case, [lps(p) for p in played["frames"][0]], None)
    wall = [i for i, d in enumerate(rest) if d < 0.02]  # flat ends are cut through the lumen
    hold(len(wall) > 500, f"{name}: {len(wall)} of {len(rest)} vertices lie on the wall at rest")
    for time, frame in list(zip(TIMES, played["frames"]))[1:]:
        beyond = sorted(max(0, d - rest[i]) for i, d in zip(wall, distances(reader, case, [lps(frame[i]) for i in wall], time)))
        usual, most = beyond[int(0.95 * len(beyond))], beyond[-1]
        if "--print" in sys.argv: print(f"{name} at {time} s: {len(wall)} vertices, 95 % within {usual:.5f}, all within {most:.5f} radii")
        hold(usual <= USUAL and most <= MOST, f"{name} at {time} s: 95 % within {usual:.4f}, all within {most:.4f} radii")


def check_blender(glb, played, folder):
    if not shutil.which("blender"): return print("Blender is not here")
    run("blender", "-b", "--factory-startup", "-noaudio", "--python-exit-code", "3", "-P", HERE / "blender_motion.py", "--",
        glb, folder / "blender.json", TIMES[2])
    found = json.loads((folder / "blender.json").read_text())
    hold(found["armatures"] == 1 and found["actions"] == 1, f"Blender has {found['armatures']} armatures, {found['actions']} actions")
    wanted = sorted([p[0], -p[2], p[1]] for p in played["frames"][2])  # Blender's z is up
    worst = max((min(math.dist(a, b) for b in wanted) for a in found["vertices"][::97]), default=1)
    hold(len(found["vertices"]) > 500 and worst < 1e-4, f"Blender's {len(found['vertices'])} vertices are up to {1000 * worst} mm elsewhere")
    if "--print" in sys.argv: print(f"Blender: {len(found['vertices'])} vertices within {1000 * worst:.4f} mm of three's")


def main():
    lumen, reader, node, modules = sys.argv[1:5]
    if not pathlib.Path(modules, "three").is_dir():
        print(f"{modules} has no three: npm ci in viewer/page")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run(lumen, "phantom", "bifurcation", folder / "fork.nrrd", "--size", "64", "--seeds", folder / "fork.json")
        run(lumen, "convert", folder / "fork.nrrd", folder / "rest.lumen.json", "--seeds", folder / "fork.json", "--seeds-only")
        case = folder / "moving.lumen.json"
        case.write_text(json.dumps(with_motion(json.loads((folder / "rest.lumen.json").read_text()))))
        facts = json.loads(run(lumen, "info", case, "--json"))["motion"]
        if "--print" in sys.argv: print(f"strain {facts['strain']:.3f}, displacement {facts['displacement_mm']:.2f} mm")
        hold(0.05 < facts["strain"] < 0.25 and facts["displacement_mm"] > 0.5, f"the motion is another: {facts}")
        for coding in ("plain", "meshopt"):
            glb = folder / f"{coding}.glb"
            run(lumen, "convert", case, glb, *([] if coding == "plain" else ["--meshopt"]))
            played = json.loads(run(node, HERE / "play.mjs", glb, modules, *TIMES))
            hold(abs(played["duration"] - 1.5) < 1e-6, f"{coding}: the animation has {played['duration']} s")
            check_frames(reader, case, played, coding)
            if coding == "plain": check_blender(glb, played, folder)
        run(lumen, "convert", case, folder / "still.glb", "--no-skin")
        hold(b'"skins"' not in (folder / "still.glb").read_bytes(), "--no-skin leaves a skin")
    for fault in faults: print(fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
