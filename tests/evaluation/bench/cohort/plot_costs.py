#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The curve of measure_costs.py, and what it says of a cohort.

plot_costs.py OUT.png COSTS.jsonl... [--volumes 10000] [--size 512]

Draws processor time, memory and disk of every patient over the voxels of its volume, with the line that least squares of the
logarithms of time, and least squares of memory, draw through them, and prints the sums for that many volumes of that size."""
import argparse, json, pathlib

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

STEPS = ("track", "fit", "check", "mesh", "export", "report", "measure", "library")
MAKES = ("track", "fit", "library")  # what lumen library build runs


def read(files):
    return [json.loads(line) for file in files for line in file.read_text().splitlines()]


def seconds(patient, steps): return sum(patient["steps"][s]["seconds"] for s in steps)


def memory(patient, steps): return max(patient["steps"][s]["megabytes"] for s in steps)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("costs", type=pathlib.Path, nargs="+")
    parser.add_argument("--volumes", type=int, default=10000)
    parser.add_argument("--size", type=int, default=512)
    options = parser.parse_args()
    patients = read(options.costs)
    voxels = np.array([p["voxels"] for p in patients], float)
    at = float(options.size) ** 3
    grid = np.geomspace(voxels.min(), max(voxels.max(), at), 50)
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4))
    print(f"{len(patients)} patients, edges of " + ", ".join(f"{s}: {sum(p['size'] == s for p in patients)}" for s in sorted({p["size"] for p in patients})))
    for steps, name, colour in ((STEPS, "all steps", "tab:red"), (MAKES, "lumen library build", "tab:blue")):
        times = np.array([seconds(p, steps) for p in patients])
        power, offset = np.polyfit(np.log(voxels), np.log(times), 1)
        left.loglog(voxels, times, ".", color=colour, alpha=0.6)
        left.loglog(grid, np.exp(offset) * grid ** power, "-", color=colour, label=f"{name}: voxels$^{{{power:.2f}}}$")
        found = np.exp(offset) * at ** power
        large = [t for t, v in zip(times, voxels) if v == at]
        print(f"{name}: {found:.0f} s of a core at {options.size}^3 by the line, measured there {', '.join(f'{t:.0f}' for t in large) or '-'}; "
              f"{options.volumes} volumes: {found * options.volumes / 3600:.0f} core hours by the line, "
              f"{max(large, default=found) * options.volumes / 3600:.0f} by the slowest measured")
        sizes = np.array([memory(p, steps) for p in patients])
        slope, base = np.polyfit(voxels, sizes, 1)
        right.loglog(voxels, sizes, ".", color=colour, alpha=0.6)
        right.loglog(grid, base + slope * grid, "-", color=colour, label=f"{name}: {base:.0f} MB + {slope * 1e6:.1f} bytes/voxel")
        print(f"{name}: {base:.0f} MB and {slope * 1e6:.1f} bytes a voxel: {base + slope * at:.0f} MB at {options.size}^3")
    left.set(xlabel="voxels", ylabel="processor time of one core, s")
    right.set(xlabel="voxels", ylabel="greatest memory of a step, MB")
    for axes in (left, right):
        axes.grid(True, which="both", alpha=0.25)
        axes.legend()
    for size in sorted({p["size"] for p in patients}):
        some = [p["steps"]["library"] for p in patients if p["size"] == size]
        print(f"{size}^3: a case in a library takes {np.mean([s['bytes'] for s in some]) / 1e6:.1f} MB in {np.mean([s['files'] for s in some]):.0f} files")
    figure.tight_layout()
    figure.savefig(options.out, dpi=110)


if __name__ == "__main__": main()
