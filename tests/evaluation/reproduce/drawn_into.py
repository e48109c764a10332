#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Arterial trees drawn into a real scan, and what lumen finds of them without a click.

  drawn_into.py DATA FOLDER LUMEN [TREE ...]

Draws each tree of DATA/arteries (TREE: names of files, without ending) into the head CT of DATA/prior, converts the volume with default
options, and compares. Volumes and cases stay in FOLDER, and so does drawn_into.md, which is printed too. The axis y of the trees runs from
the neck to the crown, which is z in the scan."""
import json
import subprocess
import sys
import time
from pathlib import Path

UPRIGHT = "90,0,0"


def run(*words):
    """The JSON answer and the seconds that it took."""
    begin = time.monotonic()
    done = subprocess.run([str(word) for word in words] + ["--json", "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode != 0: sys.exit(f"drawn_into.py: {' '.join(map(str, words))}\n{done.stderr}")
    return json.loads(done.stdout), time.monotonic() - begin


def row(lumen, scan, tree, folder):
    """A row of the table."""
    volume, truth, case = (folder / f"{tree.stem}{ending}" for ending in (".nrrd", ".truth.lumen", ".lumen"))
    made, _ = run(lumen, "phantom", "--tree", tree, "--into", scan, "--turn", UPRIGHT, volume, "--truth", truth)
    found, seconds = run(lumen, "convert", volume, case)
    score, _ = run(lumen, "compare", case, truth)
    false = score["false_mm"] / found["length_mm"] if found["length_mm"] else 0
    return (f"| {tree.stem} | {made['branches']} | {made['length_mm']:.0f} | {found['branches']} | {found['length_mm']:.0f} | "
            f"{score['overlap']:.2f} | {false:.2f} | {seconds:.0f} |")


def main():
    data, folder, lumen, *names = sys.argv[1:]
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    trees = [tree for tree in sorted(Path(data, "arteries").glob("*.swc")) if not names or tree.stem in names]
    lines = ["| tree | true branches | mm | found branches | mm | found | false | s |", "|---|---|---|---|---|---|---|---|"]
    lines += [row(lumen, Path(data, "prior/head-ct-native.nrrd"), tree, folder) for tree in trees]
    (folder / "drawn_into.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__": main()
