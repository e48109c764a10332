#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""lumen's measures of curves beside the sums over points that TubeTK's tortuosity filter takes.

compare_curves.py LUMEN SWC... [--least MM] [--filter PROGRAM]

Reads each SWC file with lumen, measures it, and takes from the nodes of each vessel and from lumen's own stations:
the distance metric (length / chord), the inflection count metric and the sum of angles metric, by the sums of
Bullitt and others (2003) as TubeTK has them, written anew from the definitions. Needs numpy. Prints a table of the
vessels that are longer than MM (default 20), and medians of the ratios.

PROGRAM is TubeTK's filter itself, built beside: it takes its smoothing scale as argument, tubes on standard input, each
as a number of points and their coordinates, and prints for each its path length, distance metric, inflection count
metric, and sums of angles and of torsion for each mm. TubeTK's sum of angles leaves torsion out, so it stands beside
lumen's turning. It runs on the nodes with its own scale (5 points), and on lumen's stations without smoothing."""
import argparse, json, pathlib, subprocess, tempfile
import numpy as np


def unit(v):
    n = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.divide(v, n, out=np.zeros_like(v), where=n > 1e-6)


def angle(a, b):
    return np.arccos(np.clip(np.sum(unit(a) * unit(b), axis=-1), -1, 1))


def sums(points, counts=None):
    """Distance metric, inflection count metric, and sum of angles in radians for each cm.

    `counts`: the points at which a direction of bending counts; all without it."""
    if counts is None: counts = np.ones(len(points), bool)
    step = np.diff(points, axis=0)
    length = np.linalg.norm(step, axis=1).sum()
    distance = length / np.linalg.norm(points[-1] - points[0])
    # normals by central differences; one that turns by more than 60 degrees is an inflection
    v, a = points[2:] - points[:-2], step[1:] - step[:-1]
    bent = (np.linalg.norm(a, axis=1) > 1e-6) & counts[1:-1]
    n = unit(np.cross(v, np.cross(v, a)))[bent]
    inflections = int(np.sum(np.sum(np.diff(n, axis=0) ** 2, axis=1) > 1 + 1e-6))
    in_plane = angle(step[:-2], step[1:-1])
    first, second = np.cross(step[:-2], step[1:-1]), np.cross(step[1:-1], step[2:])
    flat = (np.linalg.norm(first, axis=1) <= 1e-6) | (np.linalg.norm(second, axis=1) <= 1e-6) | ~counts[1:-2]
    torsion = np.where(flat, 0, angle(first, second))
    return distance, (inflections + 1) * distance, 10 * np.hypot(in_plane, torsion).sum() / length


def measured(lumen, *arguments):
    return json.loads(subprocess.run([lumen, *arguments, "--json", "--quiet"], check=True, capture_output=True).stdout)


def filtered(program, scale, points):
    """Distance metric, inflection count metric, and angles in the plane in radians for each cm, of the program."""
    text = f"{len(points)}\n" + "\n".join(" ".join(f"{c:.9g}" for c in p) for p in points)
    line = subprocess.run([program, str(scale)], input=text, check=True, capture_output=True, text=True).stdout.split()
    return float(line[1]), float(line[2]), 10 * float(line[3])


def rows_of(lumen, swc, folder, program):
    case = folder / "case.lumen.json"
    subprocess.run([lumen, "convert", swc, case, "--quiet"], check=True, capture_output=True)
    tree = json.loads(case.read_text())["tree"]
    centre = np.reshape(np.array(tree["centre"], float), (-1, 3))
    answer = measured(lumen, "measure", str(case))["cases"][0]
    stations = {}
    for s in answer["stations"]: stations.setdefault(s["vessel"], []).append((s["place_mm"], s["torsion_per_mm"]["value"] is not None))
    for branch, ours in zip(tree["branches"], answer["vessels"]):
        if ours["length_mm"]["value"] is None or ours["sum_of_angles_rad_per_cm"]["value"] is None: continue
        nodes = centre[branch["firstNode"]:branch["firstNode"] + branch["nodeCount"]]
        nodes = nodes[np.r_[True, np.linalg.norm(np.diff(nodes, axis=0), axis=1) > 0]]
        if len(nodes) < 4: continue
        places, bends = zip(*stations[branch["label"]])
        places, bends = np.array(places), np.array(bends)
        if program:
            yield branch["label"], ours, filtered(program, 0, places), filtered(program, 5, nodes), filtered(program, 0, nodes)
        else:
            yield branch["label"], ours, sums(places, bends), sums(places), sums(nodes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lumen")
    parser.add_argument("swc", nargs="+")
    parser.add_argument("--least", type=float, default=20)
    parser.add_argument("--filter")
    options = parser.parse_args()
    kinds = ("the filter on its stations | on the nodes, smoothed | on the nodes as they are" if options.filter else
             "sums over its stations where it has a torsion | over all of them | over the nodes")
    for swc in options.swc:
        print(f"\n{pathlib.Path(swc).name}: lumen | {kinds}")
        print(f"{'vessel':>10} {'mm':>6} | " + " | ".join(4 * [f"{'L/C':>6} {'ICM':>6} {'SOAM':>6}"]))
        ratios = []
        with tempfile.TemporaryDirectory() as folder:
            for label, ours, *others in rows_of(options.lumen, swc, pathlib.Path(folder), options.filter):
                length = ours["length_mm"]["value"]
                if length < options.least: continue
                own = (ours["tortuosity"]["value"] + 1, ours["inflection_count_metric"]["value"],
                       np.radians(ours["turning_deg_per_cm"]["value"]) if options.filter else ours["sum_of_angles_rad_per_cm"]["value"])
                ratios.append(np.divide(others, own))
                print(f"{label[:10]:>10} {length:6.1f} | " + " | ".join(f"{a:6.3f} {b:6.2f} {c:6.2f}" for a, b, c in (own, *others)))
        middle = np.median(ratios, axis=0)
        print("median ratio to lumen: " + " | ".join(" ".join(f"{r:.3f}" for r in row) for row in middle))


if __name__ == "__main__":
    main()
