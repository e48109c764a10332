#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Trees that lumen finds without a click, beside the truth of synthetic volumes and beside real volumes.

  without_clicks.py DATA FOLDER LUMEN [NAME ...]

Phantoms, with clutter and without, ten patients, the arterial trees of DATA drawn in voxels of 0.3 mm, and its volumes; NAMEs choose some. Each is
converted with default options. Volumes are deleted again; cases stay in FOLDER, and so does without_clicks.md, which is printed too.
"""
import heapq
import json
import math
import os
import subprocess
import sys
import time
from collections import defaultdict
from pathlib import Path

from forks import Found, right_forks, tree_of

PHANTOMS = ["tube", "helix", "bifurcation", "kissing", "aneurysm", "stenosis", "dropout", "sac-lobes", "companion", "hairpin",
            "right-angle", "fading", "thick-slices", "willis"]
CLUTTERED = [("bifurcation", ["bifurcation"]), ("kissing", ["kissing"]), ("willis", ["willis"]), ("patient-1", ["patient", "--seed", 1])]
CLUTTER = ["bone", "vein", "streaks", "stent", "void", "bone,vein,streaks,stent,void"]
VOLUMES = [("3DRA", "aneurism-3dra.nrrd"), ("aorta", "aorta/aorta.mha"), ("fistula", "avf/avf.nii"),
           ("carotid, speed of blood", "more/carotid-pcmr.nrrd")]
apart = math.dist


def run(*words):
    """The JSON answer, seconds of wall and of processor."""
    begin, before = time.monotonic(), os.times()
    done = subprocess.run([str(word) for word in words] + ["--json", "--quiet"], capture_output=True, text=True, check=False)
    after = os.times()
    if done.returncode != 0: sys.exit(f"without_clicks.py: {' '.join(map(str, words))}\n{done.stderr}")
    processor = after.children_user + after.children_system - before.children_user - before.children_system
    return json.loads(done.stdout), time.monotonic() - begin, processor


def synthetic(lumen, folder, name, options):
    """A row of the table of synthetic volumes."""
    volume, truth, case = folder / f"{name}.nrrd", folder / f"{name}.truth.lumen", folder / f"{name}.lumen"
    made, _, _ = run(lumen, "phantom", *options, volume, "--truth", truth)
    found, wall, processor = run(lumen, "convert", volume, case)
    volume.unlink()
    score, _, _ = run(lumen, "compare", case, truth)
    reach = found["reachable"]
    forks, right = right_forks(lumen, case, truth)
    distance = score["wall_distance_mm"] or {"p90": float("nan")}
    return (f"| {name} | {made['branches']} | {found['branches']} | {100 * score['overlap']:.1f} % | "
            f"{100 * score['false_mm'] / made['length_mm']:.2f} % | {100 * reach['length_mm'] / reach['of_mm']:.1f} % | "
            f"{right} of {forks} | "
            f"{score['radius_bias_mm'] / made['voxel_size_mm']:+.3f} | {distance['p90'] / made['voxel_size_mm']:.2f} | "
            f"{wall:.1f} | {processor:.1f} |")


def communicating(tree, link):
    """The branch of which a link joins the last node to another, its middle and the other node."""
    for node, other in (link, link[::-1]):
        branch = tree["branches"][tree["branch"][node]]
        if node == branch["firstNode"] + branch["nodeCount"] - 1: return branch, branch["firstNode"] + branch["nodeCount"] // 2, other
    sys.exit(f"without_clicks.py: the link {link} joins no last node")


def inlets_and_links(lumen, case, truth):
    """A line on roots of the truth at which a found tree begins, and on vessels of true links that lead from end to end in the found one:
    from the parent to the vessel's middle, and from there to the other end, by edges and links, each within its length and four radii."""
    found, true = tree_of(lumen, case), tree_of(lumen, truth)
    roots = [i for i, parent in enumerate(found["parent"]) if parent < 0]
    true_roots = [i for i, parent in enumerate(true["parent"]) if parent < 0]
    inlets = sum(any(apart(true["centre"][r], found["centre"][f]) < 2 * true["radius"][r] for f in roots) for r in true_roots)
    near, places = defaultdict(list), Found(found)
    for i, j in [(i, parent) for i, parent in enumerate(found["parent"]) if parent >= 0] + found.get("links", []):
        length = apart(found["centre"][i], found["centre"][j])
        near[i].append((j, length))
        near[j].append((i, length))
    whole = 0
    for link in true["links"]:
        branch, middle, other = communicating(true, link)
        ends = [places.at(true["centre"][node], true["radius"][node]) for node in (branch["parentNode"], middle, other)]
        nodes = range(branch["firstNode"], branch["firstNode"] + branch["nodeCount"] - 1)
        limit = sum(apart(true["centre"][n], true["centre"][n + 1]) for n in nodes) + 4 * true["radius"][branch["parentNode"]]
        whole += None not in ends and connected(near, ends[0], ends[1], limit) and connected(near, ends[1], ends[2], limit)
    return (f"Circle of Willis: {inlets} of {len(true_roots)} inlets are roots, of {len(roots)} trees that are found; {whole} of "
            f"{len(true['links'])} communicating arteries lead from end to end; {len(found.get('links', []))} links are found.")


def connected(near, first, last, limit):
    """Whether edges lead from one node to another within a length, mm."""
    best, heap = {first: 0}, [(0, first)]
    while heap:
        length, node = heapq.heappop(heap)
        if node == last: return True
        for other, step in near[node]:
            if length + step <= limit and length + step < best.get(other, math.inf):
                best[other] = length + step
                heapq.heappush(heap, (length + step, other))
    return False


def cluttered(lumen, folder, name, options):
    """Rows of the table of clutter: the clean phantom, each kind alone, and all together."""
    rows, clean = [], None
    for kinds in ["", *CLUTTER]:
        volume, truth, case = (folder / f"clutter{end}" for end in (".nrrd", ".truth.lumen", ".lumen"))
        made, _, _ = run(lumen, "phantom", *options, volume, "--truth", truth, *(["--clutter", kinds] if kinds else []))
        done = subprocess.run([str(lumen), "track", str(volume), str(case), "--json", "--quiet"], capture_output=True, text=True, check=False)
        kind = "none" if not kinds else "all" if "," in kinds else kinds
        if done.returncode != 0:
            rows.append(f"| {name} | {kind} | - | 0 % | {-clean[0]:.1f} | 0 | {-clean[1]:.1f} | nothing is found |")
            continue
        score, _, _ = run(lumen, "compare", case, truth)
        forks, right = right_forks(lumen, case, truth)
        figures = (made["length_mm"] - score["missed_mm"], score["false_mm"])
        clean = clean or figures
        rows.append(f"| {name} | {kind} | {json.loads(done.stdout)['branches']} | {100 * figures[0] / made['length_mm']:.1f} % | {figures[0] - clean[0]:+.1f} | "
                    f"{figures[1]:.1f} | {figures[1] - clean[1]:+.1f} | {right} of {forks} |")
    return rows


def real(lumen, folder, name, file):
    """A row of the table of real volumes."""
    case = folder / f"{name.split(',')[0]}.lumen"
    found, wall, processor = run(lumen, "convert", file, case)
    check, _, _ = run(lumen, "check", file, case)
    walls = check["wall"]
    return (f"| {name} | {found['branches']} | {found['length_mm']:.0f} | {100 * check['coverage_share']:.1f} % | "
            f"{walls['offset_voxels']['p90_absolute']:.2f} | {100 * walls['beyond_voxel_share']:.1f} % | {wall:.1f} | {processor:.1f} |")


def main():
    data, folder, lumen, names = Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3]).resolve(), set(sys.argv[4:])
    folder.mkdir(parents=True, exist_ok=True)
    wanted = lambda name: not names or name in names
    lines = ["# Trees without a click", "", "`lumen convert VOLUME CASE`, default options. Bias of the radius and the wall's distance",
             "(90 %) in voxels; times in seconds, of the wall clock and of the processor. *Right forks* are those of forks.py.", "", "## Synthetic volumes", "",
             "| volume | true branches | found | length covered | false | reachable | right forks | bias | wall, 90 % | wall clock | processor |",
             "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
    designs = [(name, [name]) for name in PHANTOMS]
    designs += [(f"patient-{seed}", ["patient", "--seed", seed]) for seed in range(1, 11)]
    designs += [(tree.stem, ["--tree", tree, "--voxel", 0.3]) for tree in sorted((data / "arteries").glob("*.swc"))]
    for name, options in designs:
        if wanted(name): lines.append(synthetic(lumen, folder, name, options))
    if wanted("willis"):
        lines += ["", inlets_and_links(lumen, folder / "willis.lumen", folder / "willis.truth.lumen")]
    lines += ["", "## Clutter", "", "`lumen phantom --clutter`, then `lumen track` with default options. *Length covered* is the true length less what is missed, whatever else is found; *change* that against the clean phantom, mm.", "",
              "| volume | clutter | found | length covered | change | false, mm | change | right forks |",
              "|---|---|--:|--:|--:|--:|--:|--:|"]
    for name, options in CLUTTERED:
        if not names or f"clutter-{name}" in names: lines += cluttered(lumen, folder, name, options)
    lines += ["", "## Real volumes", "",
              "*Held* is the share of the vessels that are connected to the case in the volume, by `lumen check`.", "",
              "| volume | vessels | mm | held | wall, 90 % | beyond a voxel | wall clock | processor |",
              "|---|--:|--:|--:|--:|--:|--:|--:|"]
    for name, file in VOLUMES:
        if wanted(name) and (data / file).exists(): lines.append(real(lumen, folder, name, data / file))
    text = "\n".join(lines) + "\n"
    (folder / "without_clicks.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
