#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what each step of a cohort costs, on synthetic patients of several sizes.

measure_costs.py LUMEN OUT.jsonl [--sizes 128:20,160:20,192:12,256:8,384:1,512:1] [--first-seed 1]

A line of OUT for each patient: voxels, and for each step the processor time in s, the greatest memory in MB (both as
the system accounts the process), the bytes and files that it leaves. Patients that OUT has are passed over, so a run goes
on where it was ended. Every step runs on one thread."""
import argparse, json, os, pathlib, subprocess, tempfile


def run(lumen, *words):
    """(processor seconds, MB) of one run of lumen."""
    child = subprocess.Popen([lumen, *(str(w) for w in words), "--threads", "1", "--quiet"], stdin=subprocess.DEVNULL,
                             stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode: raise SystemExit(f"lumen {words[0]}: exit code {child.returncode}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def left(path):
    """(bytes, files) of a file or folder."""
    files = [path] if path.is_file() else [p for p in path.rglob("*") if p.is_file()]
    return sum(f.stat().st_size for f in files), len(files)


def patient(lumen, size, seed, folder):
    volume, tree, case = folder / "v.nrrd", folder / "tree.lumen", folder / "case.lumen"
    steps = {}

    def step(name, output, *words):
        seconds, megabytes = run(lumen, *words)
        size_of, files = left(output) if output else (0, 0)
        steps[name] = dict(seconds=round(seconds, 3), megabytes=round(megabytes, 1), bytes=size_of, files=files)

    step("phantom", volume, "phantom", "patient", volume, "--size", size, "--seed", seed)
    step("track", tree, "track", volume, tree)
    step("fit", case, "fit", tree, case)
    step("check", None, "check", volume, case)
    step("mesh", folder / "case.glb", "convert", case, folder / "case.glb")
    step("export", folder / "sofa", "export", "sofa", case, folder / "sofa")
    step("measure", folder / "measures.csv", "measure", case, "--out", folder / "measures.csv")
    step("report", folder / "report.html", "report", case, folder / "report.html", "--volume", volume)
    run(lumen, "library", "init", folder / "lib", "--title", "One", "--licence", "CC0-1.0")
    step("library", folder / "lib/data", "library", "add", folder / "lib", case, "--synthetic", "--id", "one", "--export", "sofa")
    return dict(size=size, seed=seed, voxels=size ** 3, steps=steps)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lumen", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--sizes", default="128:20,160:20,192:12,256:8,384:1,512:1")
    parser.add_argument("--first-seed", type=int, default=1)
    options = parser.parse_args()
    lumen = str(options.lumen.resolve())
    done = {(p["size"], p["seed"]) for p in map(json.loads, options.out.read_text().splitlines())} if options.out.exists() else set()
    for size, count in ((int(part) for part in group.split(":")) for group in options.sizes.split(",")):
        for seed in range(options.first_seed, options.first_seed + count):
            if (size, seed) in done: continue
            with tempfile.TemporaryDirectory(prefix="lumen-costs-") as folder:
                line = patient(lumen, size, seed, pathlib.Path(folder))
            with open(options.out, "a") as out: out.write(json.dumps(line) + "\n")


if __name__ == "__main__": main()
