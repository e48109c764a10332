# SPDX-License-Identifier: Apache-2.0
"""Cases for the tests of exports for flow solvers, and what these tests share."""
import json, math, pathlib, subprocess, sys

failures = []


def expect(truth, what):
    if not truth:
        failures.append(what)
        print("FAILED:", what)


def near(found, expected, share, what):
    expect(abs(found - expected) <= share * abs(expected), f"{what}: {found:.8g}, expected {expected:.8g} to {100 * share:g} %")


def lumen(program, folder, *arguments, code=0):
    """Runs lumen; a run that ends otherwise than with `code` ends the test."""
    done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode != code: sys.exit(f"lumen {' '.join(arguments)}: {done.returncode}, {done.stderr}")
    return done


def skip(why):
    print("skipped:", why)
    sys.exit(77)


def branch(label, points, radii, parent=-1, kind="vessel"):
    """A branch for write_case(): points in mm; one radius for all, or one each; the node that it hangs on."""
    radii = [radii] * len(points) if isinstance(radii, (int, float)) else radii
    return {"label": label, "points": points, "radii": radii, "parent": parent, "kind": kind}


def line(a, b, count):
    return [[p + (q - p) * k / (count - 1) for p, q in zip(a, b)] for k in range(count)]


def write_case(file, branches, links=()):
    """A case of these branches, without models, as JSON."""
    tree = {"branches": [], "centre": [], "direction": [], "radius": [], "height": [], "parent": [], "branch": []}
    for index, one in enumerate(branches):
        first, points = len(tree["centre"]), one["points"]
        tree["branches"].append({"label": one["label"], "kind": one["kind"], "parentNode": one["parent"], "firstNode": first,
                                 "nodeCount": len(points), "stopReason": "unknown"})
        for k, point in enumerate(points):
            a, b = points[max(0, k - 1)], points[min(len(points) - 1, k + 1)]
            chord = [q - p for p, q in zip(a, b)] if len(points) > 1 else [0, 0, 1]
            length = math.sqrt(sum(w * w for w in chord))
            tree["centre"].append(point)
            tree["direction"].append([w / length for w in chord])
            tree["radius"].append(one["radii"][k])
            tree["height"].append(1.0)
            tree["parent"].append(one["parent"] if k == 0 else first + k - 1)
            tree["branch"].append(index)
    if links: tree["links"] = [list(link) for link in links]
    case = {"format": "lumen", "version": "1.1", "minimumReader": "1.0",
            "metadata": {"coordinateSystem": "LPS", "units": "mm", "steps": []}, "tree": tree}
    pathlib.Path(file).write_text(json.dumps(case))


def tube():
    """100 mm long, radius 2 mm."""
    return [branch("tube", line([0, 0, 0], [0, 0, 100], 101), 2.0)]


def landmarks():
    """A tree in which every axis can be told from the others; branches leave on the way, at the end, and four at one node."""
    return [branch("trunk", line([3, 5, 7], [3, 5, 47], 41), 3.0),
            branch("left", line([6, 5, 27], [46, 5, 27], 41), 1.5, parent=20),
            branch("back", line([3, 6, 47], [3, 66, 57], 61), 2.0, parent=40),
            branch("up", line([2, 5, 47], [-8, 5, 67], 21), [2.0 - 0.03 * k for k in range(21)], parent=40),
            branch("twig", line([3, 4, 47], [3, -16, 47], 21), 1.0, parent=40)]


def looped():
    """A trunk that parts and comes together again, as an island does, and goes on in two vessels."""
    return ([branch("trunk", line([0, 0, 0], [0, 0, 20], 21), 2.0),
             branch("west", line([-2, 0, 21], [-2, 0, 40], 20), 1.2, parent=20),
             branch("east", line([2, 0, 21], [2, 0, 40], 20), 1.2, parent=20),
             branch("onward", line([-1, 0, 42], [0, 0, 60], 19), 1.8, parent=40),
             branch("side", line([5, 0, 50], [15, 0, 50], 11), 1.0, parent=71)],
            [(60, 61)])


def forest(count=10):
    """Trees side by side; the last one has an aneurysm on it."""
    trees = [branch(f"tree{k}", line([10 * k, 0, 0], [10 * k, 0, 30], 31), 1 + 0.1 * k) for k in range(count)]
    return trees + [branch("sac", line([10 * count - 10, 4, 15], [10 * count - 10, 8, 15], 5), 3.0, parent=31 * (count - 1) + 15, kind="aneurysm")]
