# SPDX-License-Identifier: Apache-2.0
"""Runs a scene in SOFA without a display, and measures: times by SOFA's own timers, the instrument's depth in the wall by
libblob, from the recorded frames. Pictures of the instrument beside the points of the vessel's surface, in two projections."""
import os
import re
import subprocess
import time
from dataclasses import dataclass

import numpy as np

from lumen import blob

LEAK = 1.0  # mm: no contact is that deep; the wire has gone through the wall
# of SOFA's timers: finding contacts, and making constraints of them
COLLISION = ("CollisionDetection", "Build Constraint Matrix")
COLOURS = {"implicit": "#0072b2", "mesh 100k": "#d55e00", "mesh 24k": "#e69f00",
           "soft": "#009e73", "mesh": "#d55e00", "soft-stiff": "#cc79a7", "implicit-stiff": "#56b4e9",
           "vessel at rest": "#999999", "vessel": "#000000", "vessel, stiff wire": "#f0e442"}
NEAR = 12  # mm: how much of the vessel is drawn around the instrument


@dataclass
class Run:
    seconds: np.ndarray    # of each step
    collision: np.ndarray  # of it for contacts
    contacts: np.ndarray
    busy: float            # share of the time in which the process had a processor
    errors: list
    frames: list           # of each step, (n, 7), from where it comes out to the tip
    speeds: np.ndarray     # of the tip, mm/s


def timers(text):
    """Three lists with a value for each step: its total and that of COLLISION, in ms, and its rows of constraints."""
    total, part, rows = [], [], []
    for line in text.splitlines():
        words = line.split("\t")
        if "==== END" in line:
            continue
        name = line.rsplit(None, 1)[-1] if line.strip() else ""
        label = re.sub(r"^\.+", "", words[-1].strip())
        if name == "numConstraints" and len(line.split()) >= 7:
            rows[-1] = float(line.split()[3])
        elif label in COLLISION and len(words) > 8:
            part[-1] += float(words[7])
        elif label == "Simulation::animate" and len(words) > 8:
            total.append(float(words[7]))
            part.append(0.0)
            rows.append(0.0)
    return np.array(total), np.array(part), np.array(rows)


def read_frames(path):
    """The frames that are out at each step, and the tip's speeds. Frames that wait lie on the first one."""
    frames, speeds = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split(None, 1)
            if not words or words[0] not in ("X=", "V="):
                continue
            numbers = np.array(words[1].split(), float)
            if words[0] == "X=":
                x = numbers.reshape(-1, 7)
                out = np.flatnonzero(np.abs(x[:, :3] - x[0, :3]).max(1) > 1e-9)
                frames.append(x[max(0, out[0] - 1):] if len(out) else x[-1:])
            else:
                speeds.append(np.linalg.norm(numbers.reshape(-1, 6)[-1, :3]))
    return frames, np.array(speeds)


def run_scene(sofa, plugin, scene, record, steps, folder):
    """`sofa`: an installed SOFA; `plugin`: the folder of libLumenSofa.so."""
    libraries = [plugin, f"{sofa}/lib", *(f"{sofa}/plugins/{p}/lib" for p in ("BeamAdapter", "SofaImplicitField"))]
    environment = {**os.environ, "SOFA_PLUGIN_PATH": ":".join(libraries), "LD_LIBRARY_PATH": ":".join(libraries)}
    log = folder / (scene.stem + ".log")
    begin, before = time.monotonic(), os.times()
    with open(log, "w", encoding="utf-8") as out:
        subprocess.run([f"{sofa}/bin/runSofa", "-g", "batch", "-n", str(steps), "--computationTimeSampling", "1", "-c", "no",
                        str(scene)], stdout=out, stderr=subprocess.STDOUT, env=environment, check=False)
    after, wall = os.times(), time.monotonic() - begin
    busy = (after.children_user + after.children_system - before.children_user - before.children_system) / wall
    text = log.read_text(encoding="utf-8", errors="replace")
    total, part, rows = timers(text)
    frames, speeds = read_frames(record)
    errors = [line for line in text.splitlines() if line.startswith("[ERROR]")]
    return Run(total / 1000, part / 1000, rows / 3, min(1.0, busy), errors, frames, speeds)


def turned(quaternions):
    """The x-axis of frames (x, y, z, w)."""
    x, y, z, w = quaternions.T
    return np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)], axis=1)


def axis_points(frames, between=2):
    """Points of the beams' cubic splines, from the base to the tip, `between` within each beam."""
    p, d = frames[:, :3], turned(frames[:, 3:])
    if len(p) < 2:
        return p
    length = np.linalg.norm(np.diff(p, axis=0), axis=1)[:, None] / 3
    control = (p[:-1], p[:-1] + d[:-1] * length, p[1:] - d[1:] * length, p[1:])
    points = []
    for t in np.arange(between + 1) / (between + 1):
        weight = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t ** 3)
        points.append(sum(w * c for w, c in zip(weight, control)))
    return np.vstack([np.stack(points, axis=1).reshape(-1, 3), p[-1:]])


def distances(model, points, nodes):
    """mm, of points to the wall of the blended field of a lumen.blob.Model; the nodes of the points move."""
    cursor = blob.Cursor(len(nodes))
    cursor.node[:] = nodes
    distance = model.query(points, cursor).distance
    nodes[:] = cursor.node
    return distance


def depths(model, run, radius, first):
    """mm, of the instrument's surface beyond the wall of the blended field, for each step at its deepest point; and the nodes
    of the last step. Cursors follow the tree from the node `first` on: what a wire goes into elsewhere does not count as its
    vessel."""
    cursors, deepest = None, []
    for frames in run.frames:
        points = axis_points(frames)[1:]
        if len(points) == 0 or not np.isfinite(points).all():
            deepest.append(0.0 if len(points) == 0 else np.inf)
            continue
        if cursors is None:
            cursors = np.array([first], dtype=np.uint32)
        # counted from the tip; what has come out begins where the last one was
        new = len(points) - len(cursors)
        cursors = np.concatenate([np.full(max(0, new), cursors[0], dtype=np.uint32), cursors[max(0, -new):]])
        deepest.append(float((distances(model, points, cursors) + radius).max()))
    return np.array(deepest), cursors


def surface_points(path):
    with open(path, encoding="utf-8") as file:
        return np.array([line.split()[1:4] for line in file if line.startswith("v ")], float)


def near(points, wires):
    every = np.vstack(wires)
    inside = ((points > every.min(0) - NEAR) & (points < every.max(0) + NEAR)).all(1)
    points = points[inside]
    least = np.full(len(points), np.inf)
    for place in every[:: max(1, len(every) // 200)]:
        least = np.minimum(least, np.linalg.norm(points - place, axis=1))
    return points[least < NEAR]


def draw_wires(path, title, wires, surface):
    """`wires`: axis points (n, 3) by the wall's name, mm."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    points = near(surface, list(wires.values()))
    figure, axes = plt.subplots(1, 2, figsize=(11, 5.5))
    for axis, (i, j), names in zip(axes, ((0, 2), (1, 2)), (("x, mm (left)", "z, mm (head)"), ("y, mm (back)", "z, mm (head)"))):
        axis.scatter(points[:, i], points[:, j], s=1.5, c="#999999", linewidths=0)
        for name, wire in wires.items():
            axis.plot(wire[:, i], wire[:, j], color=COLOURS.get(name, "k"), linewidth=1.2, label=name)
            axis.plot(*wire[-1, [i, j]], "o", color=COLOURS.get(name, "k"), markersize=3)
        axis.set_aspect("equal")
        axis.set_xlabel(names[0])
        axis.set_ylabel(names[1])
    axes[0].legend(loc="best", fontsize=8)
    figure.suptitle(title)
    figure.tight_layout()
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)
