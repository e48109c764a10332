#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Steps per second of lumen.gym with random actions: gym_steps.py CASE, PYTHONPATH the built package's folder.

Prints environments, nodes that are in, steps a second by the clock, and microseconds of processor time a step."""
import sys
import time

import numpy as np

import lumen.gym


def main():
    random = np.random.default_rng(0)
    for inserted, counts in (((5, 5), (1, 64, 4096)), ((90, 97), (1, 64))):
        for count in counts:
            task = {"format": "lumen-task", "version": 1, "cases": [lumen.read(sys.argv[1])],
                    "randomise": {"friction": [0, 0.1], "rotation": [0, 360], "inserted": list(inserted)}}
            many = lumen.gym.VesselVectorEnv(task, count)
            many.reset(seed=1)
            steps = max(8, 4000 // count)
            actions = random.uniform([-0.7, -1], [1, 1], (steps, count, 2))
            clock, processor, nodes = time.perf_counter(), time.process_time(), 0.0
            for action in actions:
                many.step(action)
                nodes += many.fleet.wires.free.mean() / steps
            clock, processor = time.perf_counter() - clock, time.process_time() - processor
            print(f"{count:5} {nodes:6.1f} {count * steps / clock:9.0f} {1e6 * processor / count / steps:8.1f}", flush=True)


if __name__ == "__main__":
    main()
