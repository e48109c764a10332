#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Processor time of a library made as tasks of a scheduler make it, beside a plain loop of `lumen convert` and `lumen library add`.

measure_overhead.py LUMEN [--patients 4] [--size 128]

Both make the same cases on one thread. The tasks (`library build --make-only --rows LINE`, one for each row) and the collection run here,
one after the other, so that neither waits for the other nor for a scheduler: their sum is all that lumen itself adds."""
import argparse, pathlib, resource, subprocess, tempfile


def cost(*calls):
    """Processor seconds of programs and all that they start."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    for call in calls:
        subprocess.run([str(w) for w in call], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lumen", type=pathlib.Path)
    parser.add_argument("--patients", type=int, default=4)
    parser.add_argument("--size", type=int, default=128)
    options = parser.parse_args()
    lumen = options.lumen.resolve()
    with tempfile.TemporaryDirectory(prefix="lumen-overhead-") as name:
        folder, one = pathlib.Path(name), ("--threads", "1")
        numbers = range(1, options.patients + 1)
        cost(*((lumen, "phantom", "patient", folder / f"{k}.nrrd", "--size", options.size, "--seed", k) for k in numbers))
        (folder / "list.csv").write_text("input,id,title,synthetic,licence\n" + "".join(f"{k}.nrrd,p{k},P{k},yes,CC0-1.0\n" for k in numbers))
        init = lambda library: (lumen, "library", "init", library, "--title", "L", "--licence", "CC0-1.0")
        build = lambda library, *more: (lumen, "library", "build", folder / "list.csv", folder / library, *more, *one)
        loop = [init(folder / "loop")]
        for k in numbers:
            loop.append((lumen, "convert", folder / f"{k}.nrrd", folder / f"{k}.lumen", *one))
            loop.append((lumen, "library", "add", folder / "loop", folder / f"{k}.lumen", "--id", f"p{k}", "--title", f"P{k}", "--synthetic", *one))
        plain = cost(*loop)
        tasks = cost(init(folder / "tasks"), *(build("tasks", "--make-only", "--rows", k + 1) for k in numbers))
        collect = cost(build("tasks", "--collect"))
        again = cost(build("tasks"))
        print(f"{options.patients} patients of {options.size}^3: plain loop {plain:.1f} s, tasks {tasks:.1f} s and collection {collect:.1f} s: "
              f"{100 * ((tasks + collect) / plain - 1):+.1f} %; a run that finds nothing to do {again:.2f} s (processor time)")


if __name__ == "__main__": main()
