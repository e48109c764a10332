#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of ../lumen.md with the fields of the reference reader.

make.py [FOLDER]    writes PNG files beside itself, or into FOLDER"""
import argparse, io, math, pathlib, sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "reference"))
from lumen_reader import Case, kernel  # noqa: E402

LEVEL, PARAMETER = 0.1, 0.2
INK, GREY, WALL = "#222222", "#888888", "#b2182b"
COLOURS = ["#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377", "#997700", "#4477aa"]
plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False,
                     "axes.edgecolor": GREY, "axes.labelcolor": INK, "text.color": INK, "xtick.color": INK, "ytick.color": INK})


def width_for(radius, offsets):
    """The width of blobs on an axis whose sum is the iso-level at a radius."""
    def excess(w): return sum(w * kernel("cauchy", PARAMETER, (radius ** 2 + o * o) / w ** 2)[0] for o in offsets) - LEVEL
    low, high = 1e-3, 10.0
    for _ in range(60): low, high = (low, (low + high) / 2) if excess((low + high) / 2) > 0 else ((low + high) / 2, high)
    return high


def blobs_of(path):
    """Centres and widths of a chain of blobs along a vessel, four for each node, and a few beyond its ends."""
    centres, radii = np.array([c for c, _ in path], float), np.array([r for _, r in path])
    at = np.arange(-2, 4 * len(path) - 1) / 4
    inner = np.clip(at, 0, len(path) - 1)
    first, last = centres[1] - centres[0], centres[-1] - centres[-2]
    points = np.transpose([np.interp(inner, range(len(path)), c) for c in centres.T])
    points += np.outer(np.minimum(at, 0), first) + np.outer(np.maximum(at - len(path) + 1, 0), last)
    spacing = np.linalg.norm(np.gradient(points, axis=0), axis=1)
    widths = [width_for(r, step * np.arange(-6, 7)) for r, step in zip(np.interp(inner, range(len(path)), radii), spacing)]
    return at, points, widths


def vessels(*paths):
    """A case of vessels, each a list of (centre, radius). A node's model is the blobs of the vessel near it."""
    tree, models = {"centre": [], "radius": [], "parent": []}, {
        "kernel": "cauchy", "kernelParameter": PARAMETER, "isoLevel": LEVEL, "offset": [0], "centre": [], "width": []}
    for path in paths:
        at, points, widths = blobs_of(path)
        for i, (centre, radius) in enumerate(path):
            tree["parent"].append(len(tree["centre"]) - 1 if i else -1)
            tree["centre"].append(list(centre))
            tree["radius"].append(radius)
            near = np.flatnonzero(abs(at - i) <= 1.5)
            models["centre"] += [list(points[j]) for j in near]
            models["width"] += [widths[j] for j in near]
            models["offset"].append(len(models["width"]))
    return Case({"tree": tree, "models": models})


def node_of(case, p): return case.answer({"point": p})["node"]


def grid(low, high, step):
    return [np.arange(a, b + step / 2, step) for a, b in zip(low, high)]


def wall(axes, case, x, y, start=None, point=lambda x, y: [x, y, 0.0], **style):
    """The curve f = T of the blended field in a plane; with `start`, as it is followed from there."""
    def value(p): return case.blended(node_of(case, p) if start is None else case.follow(start, p), p)[0]
    f = [[value(point(a, b)) for a in x] for b in y]
    axes.contour(x, y, f, levels=[LEVEL], **{"colors": WALL, "linewidths": 1.6, **style})


def cells(axes, case, x, y, colours):
    """Tints the power cells: where the least power of all others exceeds a node's own."""
    power = np.array([[[case.power(i, [a, b, 0.0]) for a in x] for b in y] for i in range(case.count)])
    for i in range(case.count):
        lead = np.delete(power, i, 0).min(0) - power[i]
        axes.contourf(x, y, lead, levels=[0, 1e9], colors=[colours[i % len(colours)]], alpha=0.16)


def bare(axes):
    axes.set_aspect("equal")
    axes.axis("off")


def saved(figure, folder, name):
    image = io.BytesIO()
    figure.savefig(image, dpi=150, facecolor="white")
    Image.open(image).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(folder / f"{name}.png", optimize=True)
    plt.close(figure)


# the figures -----------------------------------------------------------------------------------------------------------


def power_cells(folder):
    path = [([0, 0, 0], 1.0), ([1.3, 0.05, 0], 1.0), ([2.5, 0.15, 0], 0.85), ([3.6, 0.35, 0], 0.6), ([4.6, 0.65, 0], 0.5), ([5.5, 1.05, 0], 0.5)]
    case = vessels(path)
    figure, axes = plt.subplots(figsize=(7.4, 3.1), layout="constrained")
    low, high = (-1.75, -1.4), (6.45, 1.9)
    x, y = grid(low, high, 0.05)
    cells(axes, case, x, y, COLOURS)
    wall(axes, case, x, y)
    for i, (centre, radius) in enumerate(path):
        axes.add_patch(plt.Circle(centre[:2], radius, fill=False, color=GREY, lw=0.9, ls=(0, (4, 2))))
        axes.plot(*centre[:2], "o", color=INK, ms=3.5)
        axes.annotate(f"$O_{i}$", centre[:2], (4, 4), textcoords="offset points")
    for (a, r), (b, s) in zip(path, path[1:]):
        a, b = np.array(a[:2]), np.array(b[:2])
        way = b - a
        middle = a + way * (1 + (r * r - s * s) / way.dot(way)) / 2
        axes.axline(middle, middle + [-way[1], way[0]], color=INK, lw=1.1)
    axes.plot(*np.transpose([c[:2] for c, _ in path]), color=INK, lw=0.6)
    line = {"arrowstyle": "-", "lw": 0.6}
    axes.annotate("radical plane\nof 3 and 4", (4.55, -0.8), (4.7, -0.8), arrowprops=line, va="center")
    axes.annotate("surface of the case", (-0.5, 0.83), (-1.5, 1.5), arrowprops=line, color=WALL, va="center")
    axes.annotate("ball of node 1", (0.72, 0.86), (0.72, 1.5), arrowprops=line, va="center", color="#555555")
    axes.text(2.77, -1.0, "power cell\nof node 2", ha="center", va="center")
    bare(axes)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    saved(figure, folder, "power-cells")


def shares(case, p):
    """The weights of all nodes at a point, divided by their sum."""
    u = np.array([case.weight(k, p)[0] for k in range(case.count)])
    return u / u.sum()


def weights(folder):
    bend, radius = 1.0, 0.72
    arc = [[bend * math.sin(a), -bend * math.cos(a), 0] for a in np.radians([0, 30, 60, 90])]
    path = [(c, radius) for c in ([-1.1, -bend, 0], [-0.55, -bend, 0], *arc, [bend, 0.55, 0], [bend, 1.1, 0])]
    case, shown = vessels(path), range(1, len(path) - 1)
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(7.4, 2.9), layout="constrained", width_ratios=(1.15, 1, 1))
    x, y = grid((-0.8, -1.95), (1.95, 0.8), 0.05)
    cells(left, case, x, y, COLOURS)
    wall(left, case, x, y)
    s = np.linspace(-0.7, math.pi / 2 * bend + 0.7, 149)
    for axes, r, name in ((middle, bend, "on the centerline"), (right, 0.37, "beside the inner wall")):
        points = beside(s, r, bend)
        share = np.array([shares(case, p) for p in points])
        for i in shown:
            axes.fill_between(s, share[:, i], color=COLOURS[i], alpha=0.16, lw=0)
            axes.plot(s, np.where(share[:, i] > 0, share[:, i], np.nan), color=COLOURS[i], lw=1.4)
            axes.text(s[share[:, i] > 0.9 * share[:, i].max()].mean(), 1.03, f"{i}", ha="center", color=COLOURS[i])
        left.plot(*np.transpose([p[:2] for p in points]), color=INK, lw=1, ls="-" if r == bend else (0, (2, 1.5)))
        axes.set(xlabel="along the centerline, mm", ylim=(0, 1.12), xlim=(s[0], s[-1]), yticks=(0, 0.5, 1))
        axes.set_title(name, fontsize=9)
    middle.set_ylabel("share of the weight")
    right.set_yticklabels([])
    for i in shown:
        c = np.array(path[i][0][:2])
        left.plot(*c, "o", color=COLOURS[i], ms=5, mec=INK, mew=0.5)
        left.text(*(c + 0.2 * np.maximum(c * [1, -1], 0) * [1, -1]), f"{i}", ha="center", va="center")
    bare(left)
    left.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    saved(figure, folder, "weights")


def beside(s, r, bend):
    """Points at r from the centre of a quarter turn of radius `bend`, and beside the straight vessel before and behind it."""
    turn = np.clip(s / bend, 0, math.pi / 2)
    return [[r * math.sin(t) + min(a, 0), -r * math.cos(t) + max(a - math.pi / 2 * bend, 0), 0.0] for a, t in zip(s, turn)]


def touching_vessels(folder):
    one = [([0, 0, z], 1.0) for z in (-1.2, 0, 1.2)]
    two = [([1.72, 0, z], 0.78) for z in (-1.0, 0, 1.0)]
    case = vessels(one, two)
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.4, 2.9), layout="constrained", width_ratios=(1, 1.25))
    x, y = grid((-1.3, -1.2), (2.8, 1.2), 0.04)
    for start, colour in ((1, COLOURS[0]), (4, COLOURS[1])):
        wall(left, case, x, y, start, colors=colour)
    left.axhline(0, color=INK, lw=0.8, ls=(0, (2, 1.5)))
    left.text(0, 0.45, "one", color=COLOURS[0], ha="center")
    left.text(1.72, 0.35, "two", color=COLOURS[1], ha="center")
    bare(left)
    s = np.linspace(-1.3, 2.8, 206)
    for start, colour, name in ((1, COLOURS[0], "followed in one"), (4, COLOURS[1], "followed in two")):
        f = np.array([case.blended(case.follow(start, [a, 0.0, 0.0]), [a, 0.0, 0.0])[0] for a in s])
        right.plot(s, f / LEVEL, color=colour, lw=1.5, label=name)
        right.fill_between(s, 1, f / LEVEL, where=f > LEVEL, color=colour, alpha=0.16, lw=0)
    right.axhline(1, color=INK, lw=0.8)
    right.text(2.8, 1.12, "T", ha="right")
    right.set(xlabel="along the line, mm", ylabel="f / T", xlim=(-1.3, 2.8), ylim=(0, None))
    right.legend(frameon=False)
    saved(figure, folder, "touching-vessels")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, nargs="?", default=HERE)
    for draw in (power_cells, weights, touching_vessels): draw(parser.parse_args().folder)
