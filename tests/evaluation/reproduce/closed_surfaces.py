#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether the closed surfaces of phantoms, patients and real vessels are what they are said to be.

  closed_surfaces.py PROOF DATA FOLDER LUMEN [NAME ...]

PROOF is the program lumen_surface_proof, LUMEN the program. Makes a case of every phantom kind, of ten synthetic patients
(`lumen phantom patient`, seeds 1 to 10, and one of 512 voxels), of the volumes and the arterial trees in DATA, converts it
with default options, and measures the file that was written. Where tetgen is installed it then fills the inside
(-pq), from the smallest on, for ten minutes at most each. Cases in WALLED get a wall, too. NAMEs choose some of the cases. Cases, surfaces, NAME.proof.json and NAME.tets.json
stay in FOLDER, and a case or result that is there is not made again; so does closed_surfaces.md, which is printed too.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

CLICKS = Path(__file__).resolve().parents[2] / "data"
KINDS = ["tube", "helix", "bifurcation", "kissing", "aneurysm", "stenosis", "dropout", "sac-lobes", "companion", "hairpin",
         "right-angle", "fading", "thick-slices", "willis"]
WALLED = ["willis", *(f"patient-{seed}" for seed in range(1, 11)), "3DRA", "aorta", "fistula"]
THICKNESS = "0.2r"
BINS = [(0, 3), (3, 6), (6, 9), (9, 11), (11, 15), (15, 21)]  # of the histogram, in tenths of the thickness
VOLUMES = [("3DRA", "aneurism-3dra.nrrd", "aneurism-3dra"), ("aorta", "aorta/aorta.mha", "aorta"), ("fistula", "avf/avf.nii", "avf")]
TETGEN_SECONDS = 600


def run(*words, limit=None, folder=None):
    """Standard output, seconds of wall and of processor; nothing where it failed or took too long."""
    begin, before = time.monotonic(), os.times()
    try:
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, timeout=limit, cwd=folder)
    except subprocess.TimeoutExpired:
        return None, time.monotonic() - begin, math.nan
    after = os.times()
    if done.returncode != 0 and limit is None:
        sys.exit(f"closed_surfaces.py: {' '.join(map(str, words))}\n{done.stderr}")
    processor = after.children_user + after.children_system - before.children_user - before.children_system
    return done.stdout if done.returncode == 0 else None, time.monotonic() - begin, processor


def phantom(lumen, folder, name, *options):
    volume, clicks = folder / f"{name}.nrrd", folder / f"{name}.seeds.json"
    run(lumen, "phantom", *options, volume, "--seeds", clicks, "--quiet")
    run(lumen, "convert", volume, folder / f"{name}.lumen", "--seeds", clicks, "--seeds-only", "--quiet")
    volume.unlink()


def subjects(data):
    """Pairs of a case's name and the function that makes its file."""
    for kind in KINDS:
        yield kind, lambda lumen, folder, kind=kind: phantom(lumen, folder, kind, kind)
    for seed in range(1, 11):
        yield f"patient-{seed}", lambda lumen, folder, seed=seed: phantom(lumen, folder, f"patient-{seed}", "patient", "--seed", seed)
    yield "patient-512", lambda lumen, folder: phantom(lumen, folder, "patient-512", "patient", "--size", 512)
    for name, file, stem in VOLUMES:
        if (data / file).exists():
            yield name, lambda lumen, folder, name=name, file=file, stem=stem: run(
                lumen, "convert", data / file, folder / f"{name}.lumen", "--seeds", CLICKS / f"{stem}.seeds.json", "--seeds-only", "--quiet")
    for tree in sorted((data / "arteries").glob("*.swc")):
        yield tree.stem, lambda lumen, folder, tree=tree: run(lumen, "convert", tree, folder / f"{tree.stem}.lumen", "--quiet")


def volume_of_tets(nodes, elements):
    points, total = {}, 0.0
    with open(nodes) as lines:
        next(lines)
        for line in lines:
            if not line.startswith("#"):
                words = line.split()
                points[int(words[0])] = [float(word) for word in words[1:4]]
    with open(elements) as lines:
        count = int(next(lines).split()[0])
        for line in lines:
            if line.startswith("#"):
                continue
            a, b, c, d = (points[int(word)] for word in line.split()[1:5])
            u, v, w = ([x - y for x, y in zip(corner, d)] for corner in (a, b, c))
            total += abs(u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
                         + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6
    return count, total


def fill(lumen, folder, name, volume):
    """TetGen takes STL as text alone. The volume of its tetrahedra is that of the surface if it has filled all of it."""
    kept = folder / f"{name}.tets.json"
    if kept.exists():
        return json.loads(kept.read_text())
    if shutil.which("tetgen") is None:
        return None
    run(lumen, "convert", folder / f"{name}.lumen", folder / f"{name}.stl", "--stl-solids", "--quiet")
    out, seconds, _ = run("tetgen", "-pqQF", f"{name}.stl", limit=TETGEN_SECONDS, folder=folder)
    made = folder / f"{name}.1.ele"
    result = {"seconds": seconds, "tets": 0, "done": False, "in_time": seconds < TETGEN_SECONDS}
    if out is not None and made.exists():
        result["tets"], filled = volume_of_tets(folder / f"{name}.1.node", made)
        result["done"] = abs(filled / volume - 1) < 1e-3
        result["share"] = filled / volume
    for file in [*folder.glob(f"{name}.1.*"), folder / f"{name}.stl"]:
        file.unlink()
    kept.write_text(json.dumps(result) + "\n")
    return result


def prove(proof, lumen, folder, name, make):
    kept = folder / f"{name}.proof.json"
    if kept.exists():
        return json.loads(kept.read_text())
    case, surface = folder / f"{name}.lumen", folder / f"{name}.vtp"
    if not case.exists():
        make(lumen, folder)
    answer, wall, processor = run(lumen, "convert", case, surface, "--json")
    said = json.loads(answer)["surface"]
    facts = json.loads(run(proof, case, surface, said["gap_mm"])[0])
    result = {"wall": wall, "processor": processor, "said": said, "facts": facts}
    kept.write_text(json.dumps(result, indent=1) + "\n")
    return result


def solid(lumen, folder, name):
    """The solid wall, as lumen reports it, and the file, as `lumen info` judges it."""
    kept = folder / f"{name}.wall.json"
    if not kept.exists():
        file = folder / f"{name}.wall.vtp"
        answer, _, processor = run(lumen, "convert", folder / f"{name}.lumen", file, "--thickness", THICKNESS, "--json")
        result = {"processor": processor, "said": json.loads(answer)["surface"], "file": json.loads(run(lumen, "info", file, "--json")[0])}
        file.unlink()
        kept.write_text(json.dumps(result) + "\n")
    return json.loads(kept.read_text())


def wall_row(name, result):
    said, file = result["said"], result["file"]
    histogram, least = said["wall"]["histogram"], said["wall"]
    shares = [f"{100 * sum(histogram[low:high]) / sum(histogram):.2f}" for low, high in BINS]
    return [name, f"{file['triangles']:,}", f"{result['processor']:.1f}", "yes" if file["closed"] and file["manifold"] and file["oriented"] else "**no**",
            file["self_intersections"], f"{least['median_mm']:.3f}", f"{least['least_mm']:.3f} at {place(least['least_place'])}", *shares]


def table(head, rows):
    line = "| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n"
    return line + "".join("| " + " | ".join(str(cell) for cell in row) + " |\n" for row in rows) + "\n"


def is_right(facts):
    return (facts["closed"] and facts["manifold"] and facts["outward"] and facts["euler"] == facts["euler_of_trees"]
            and facts["intersections"] == 0 and facts["cgal_intersections"] == 0)


def filled(tets):
    if tets is None:
        return "-"
    if not tets["in_time"]:
        return f"not within {tets['seconds']:.0f} s"
    return f"{tets['tets']:,}, {tets['seconds']:.0f} s" if tets["done"] else f"no ({tets['tets']:,}, {tets['seconds']:.0f} s)"


def place(position):
    return "(" + ", ".join(f"{x:.1f}" for x in position) + ")"


def report(results):
    rows = []
    for name, r in results.items():
        f, said = r["facts"], r["said"]
        handles = sum(2 - euler for euler in f["euler"]) // 2
        loops = sum(2 - euler for euler in f["euler_of_trees"]) // 2
        rows.append([name, f"{f['triangles']:,}", f"{r['wall']:.1f}", f"{r['processor']:.1f}",
                     "yes" if f["closed"] and f["manifold"] and f["outward"] else "**no**",
                     f"{len(f['euler'])} of {len(f['euler_of_trees'])}", f"{handles} of {loops}",
                     f"{f['intersections']}, {f['cgal_intersections']}", f"{f['median_angle']:.1f}, {f['least_angle']:.1f}",
                     f"{f['vertex']['radii']:.1g}", f"{f['vertices_far']} of {f['vertices']:,}", f"{f['middle']['radii']:.2g}",
                     f"{f['field']['radii']:.2g}", f"{f['flat_ends']} of {f['ends']}", filled(r.get("tets"))])
    right = sum(is_right(r["facts"]) for r in results.values())
    text = "# Closed surfaces\n\n"
    text += ("`lumen convert CASE SURFACE.vtp` with default options, and what is in the file, by `lumen_surface_proof` "
             "(`tests/evaluation/reproduce/surface_facts.h`): closed, a manifold at edges and vertices, oriented outward, connected parts and "
             "their Euler characteristics by CGAL; trees and handles beside what the graph of the case says; pairs of triangles "
             "that intersect, as lumen and as CGAL find them; the median and the least of the triangles' least angles, in degrees. "
             "Distances are in radii of the vessel: of the farthest vertex of the wall from the field, with how many are over a "
             "thousandth; of the middles of triangles from it; and of the field, where twelve rays from each node meet it, from the "
             "surface. Flat ends are those whose vertices lie in one plane. TetGen (`tetgen -pq`) has filled a surface if its "
             "tetrahedra have its volume.\n\n")
    text += f"**{right} of {len(results)} surfaces are closed, oriented manifolds of the graph's topology without a self-intersection.**\n\n"
    text += table(["case", "triangles", "s", "processor s", "closed, manifold, outward", "parts of trees", "handles of loops",
                   "intersections: ours, CGAL's", "angles: median, least", "vertex to field", "farther than 0.001", "middle to field",
                   "field to surface", "flat ends", "tetrahedra"], rows)
    rows = [[name, what, f["branch"], f["node"], place(f["place"]), f"{f['radii']:.2g}"] for name, r in results.items()
            for what, f in (("a vertex", r["facts"]["vertex"]), ("the field", r["facts"]["field"]))
            if f["radii"] > (1e-3 if what == "a vertex" else 0.05)]
    if rows:
        text += "**Where surface and field part the most**\n\n" + table(["case", "farthest is", "branch", "node", "at, mm", "radii"], rows)
    rows = [wall_row(name, r["solid"]) for name, r in results.items() if "solid" in r]
    if rows:
        text += (f"**Walls**, `--thickness {THICKNESS}`: closed, a manifold, oriented, and pairs of triangles that intersect, by `lumen info` of the "
                 "file; thickness at the vertices of the lumens' side, in mm, and their shares by tenths of the thickness that was asked for, "
                 "in per cent.\n\n"
                 + table(["case", "triangles", "processor s", "closed, manifold, outward", "intersections", "median", "least",
                          *(f"{low / 10:g} to {high / 10:g}" if high < 21 else f"over {low / 10:g}" for low, high in BINS)], rows))
    rows = [[name, r["said"]["opened_edges"], len(r["said"]["cuts"]), len(r["said"]["overlaps"]), r["said"]["off_field"], r["said"]["rounded_ends"]]
            for name, r in results.items() if r["said"]["opened_edges"] or r["said"]["cuts"] or r["said"]["overlaps"] or r["said"]["off_field"] or r["said"]["rounded_ends"]]
    if rows:
        text += ("**Reports of lumen on them**\n\n"
                 + table(["case", "edges opened", "handles cut", "pairs of vessels kept apart", "vertices off the field", "round ends"], rows))
    return text


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    proof, data, folder, lumen, wanted = Path(sys.argv[1]).resolve(), Path(sys.argv[2]), Path(sys.argv[3]).resolve(), sys.argv[4], sys.argv[5:]
    folder.mkdir(parents=True, exist_ok=True)
    if not any((data / file).exists() for _, file, _ in VOLUMES):
        print(f"closed_surfaces.py: real vessels skipped, there is no {data}", file=sys.stderr)
    results = {}
    for name, make in subjects(data):
        if not wanted or name in wanted:
            results[name] = prove(proof, lumen, folder, name, make)
            print(f"{name}: {'right' if is_right(results[name]['facts']) else 'NOT RIGHT'}", file=sys.stderr, flush=True)
    for name, result in results.items():
        if name in WALLED:
            result["solid"] = solid(lumen, folder, name)
            print(f"wall of {name}", file=sys.stderr, flush=True)
    (folder / "closed_surfaces.md").write_text(report(results).rstrip() + "\n")
    for name, result in sorted(results.items(), key=lambda item: item[1]["facts"]["triangles"]):
        result["tets"] = fill(lumen, folder, name, result["facts"]["volume_mm3"])
    text = report(results).rstrip() + "\n"
    (folder / "closed_surfaces.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
