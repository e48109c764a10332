#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times of lumen.torch on a CUDA device beside libblob-cuda alone, and their distances beside libblob's.

    PYTHONPATH=build/release/packages/python cuda.py CASE [POINTS]

Points lie about nodes in runs of 100, as those of a wire, at 0.5 to 1.2 radii. Times are medians of 20 calls after 3, by events of
CUDA. Needs torch."""
import statistics, sys

import numpy as np
import torch

import lumen.torch
from lumen import _cuda, blob

LOOKED_AT = 100_000  # points whose distances are compared


def points_about(path, count):
    tree = lumen.read(path).tree
    centre, radius = tree.centre, tree.radius
    random = np.random.default_rng(1)
    runs = (count + 99) // 100
    node = np.repeat(random.integers(len(radius), size=runs), 100)[:count]
    node = np.minimum(node + np.tile(np.arange(100), runs)[:count] // 10, len(radius) - 1)
    away = random.normal(size=(count, 3)).astype(np.float32)
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    return (centre[node] + radius[node, None] * random.uniform(0.5, 1.2, (count, 1)) * away).astype(np.float32)


def show(what, milliseconds, count):
    print(f"{what:60s} {milliseconds:9.3f} ms  {count / milliseconds / 1e6:8.3f} 10^9 points/s", flush=True)


def median(function):
    times = []
    for _ in range(23):
        start, end = (torch.cuda.Event(enable_timing=True) for _ in range(2))
        start.record()
        function()
        end.record()
        torch.cuda.synchronize()
        times.append(start.elapsed_time(end))
    return statistics.median(times[3:])


def time_torch(model, points, cursor):
    count = len(points)
    answer = torch.empty((count, 4), device="cuda")
    vessels = _cuda.vessels(model, 0)
    for name, flags in (("LOCAL", blob.LOCAL), ("BLENDED", blob.BLENDED), ("DISTANCE_EXACT", blob.DISTANCE_EXACT)):
        show(f"libblob-cuda, {name}", median(lambda flags=flags: vessels.query(
            count, points.data_ptr(), cursor.data_ptr(), answer.data_ptr(), flags, torch.cuda.current_stream().cuda_stream)), count)
    leaf = points.clone().requires_grad_()

    def backward():
        leaf.grad = None
        lumen.torch.distance(model, leaf, cursor).sum().backward()

    show("lumen.torch", median(lambda: lumen.torch.distance(model, leaf, cursor)), count)
    show("lumen.torch and backward()", median(backward), count)
    show("lumen.torch, points that are located", median(lambda: lumen.torch.distance(model, points)), count)


def compare(model, points, host):
    found = lumen.torch.distance(model, points[:LOOKED_AT]).cpu().numpy()
    wanted = model.query(host[:LOOKED_AT].astype(np.float64), None, blob.DISTANCE_EXACT).distance
    error = np.abs(found - wanted)
    print(f"{len(found)} distances: {100 * np.mean(error < 1e-5):.3f} % within 1e-5 mm of libblob's, "
          f"{np.count_nonzero((found < 0) != (wanted < 0))} on another side")


def main():
    path, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 6_553_600
    model, host = blob.Model(path), points_about(path, count)
    print(f"{path}, {count} points, {torch.cuda.get_device_name()}")
    points = torch.tensor(host, device="cuda")
    cursor = torch.full((count,), -1, dtype=torch.int32, device="cuda")
    lumen.torch.distance(model, points, cursor)
    time_torch(model, points, cursor)
    compare(model, points, host)


if __name__ == "__main__":
    main()
