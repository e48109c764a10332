#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Seconds of libblob's queries from Python beside those from C, in turns, so that a busy machine slows both; seconds of processor time.

    PYTHONPATH=build/release/packages/python measure.py build/release/tests/evaluation/bench/blob_calls [CASE]

Without a CASE, the phantom bifurcation is fitted. Points lie about the nodes, out to 1.2 radii. A time is that of the
fastest of many rounds of each. Prints a table in Markdown."""
import os, subprocess, sys, tempfile, time

import numpy as np

import lumen

TURNS = 12
# points of a call, calls in a round, rounds in a turn
SIZES = ((1, 20000, 3), (200, 2000, 3), (10000, 40, 3), (100000, 4, 3), (1000000, 1, 4))


def points_about(case, count):
    random = np.random.default_rng(1)
    node = random.integers(len(case.tree), size=count)
    away = random.normal(size=(count, 3))
    away *= (case.tree.radius[node] * random.uniform(0, 1.2, count) / np.linalg.norm(away, axis=1))[:, None]
    return case.tree.centre[node] + away


def fastest(call, repeats, rounds):
    seconds = []
    for _ in range(rounds):
        begin = time.thread_time()
        for _ in range(repeats):
            call()
        seconds.append((time.thread_time() - begin) / repeats)
    return min(seconds)


def main():
    program = sys.argv[1]
    if len(sys.argv) > 2:
        case = lumen.read(sys.argv[2])
    else:
        phantom = lumen.phantom("bifurcation")
        case = lumen.convert(phantom.volume, seeds=phantom.seeds, seeds_only=True)
    print("| points | C, us | Python, us | ratio | new answer, us | ratio | float32, us | ratio |")
    print("|--:|--:|--:|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "case.lumen")
        case.write(path)
        model = lumen.blob.Model(path)
        for count, repeats, rounds in SIZES:
            points = points_about(case, count)
            points.tofile(os.path.join(folder, "points"))
            single = points.astype(np.float32)
            cursor = model.cursor(points)
            out = model.query(points, cursor)
            query = model.query
            least = [np.inf] * 4
            for _ in range(TURNS):
                arguments = [program, path, os.path.join(folder, "points"), str(count), str(rounds), str(repeats)]
                in_c = min(map(float, subprocess.run(arguments, stdout=subprocess.PIPE, check=True).stdout.split()))
                now = (in_c, fastest(lambda: query(points, cursor, out=out), repeats, rounds),
                       fastest(lambda: query(points, cursor), repeats, rounds),
                       fastest(lambda: query(single, cursor), repeats, rounds))
                least = list(map(min, least, now))
            c, kept, new, floats = (1e6 * seconds for seconds in least)
            print(f"| {count} | {c:.2f} | {kept:.2f} | {kept / c:.2f} | {new:.2f} | {new / c:.2f} | {floats:.2f} | {floats / c:.2f} |",
                  flush=True)


if __name__ == "__main__":
    main()
