#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws NAME.svg from every NAME.plot.json of a folder; the same data give the same bytes.

    tests/evaluation/reproduce/plots.py FOLDER

Needs Matplotlib 3.6 or newer.
"""
import argparse
import json
import math
import pathlib

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402: after the choice of the back end

COLOURS = ["#1b6ca8", "#c44536", "#2a9d4a", "#8a5ab5", "#b8860b", "#444444"]
STYLE = {
    "svg.hashsalt": "lumen",  # names of clip paths are random otherwise
    "svg.fonttype": "none",   # text stays text
    "font.family": "sans-serif",
    "font.size": 10,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": matplotlib.cycler(color=COLOURS),
    "lines.linewidth": 1.4,
}


def drawable(points, logarithmic):
    """The points that an axis can show."""
    return [(x, y) for x, y in points
            if x is not None and y is not None and math.isfinite(y) and (y > 0 or not logarithmic)]


def draw(plot, file):
    with matplotlib.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(7.2, 4.2), layout="constrained")
        figure.get_layout_engine().set(w_pad=0.1, h_pad=0.1)  # inches
        least = 0
        for curve in plot["curves"]:
            points = drawable(curve["points"], plot["logarithmic"])
            least = min([least] + [y for _, y in points])
            axes.plot([x for x, _ in points], [y for _, y in points], label=curve["name"],
                      linestyle=(0, (5, 4)) if curve["dashed"] else "-")
        if plot["logarithmic"]:
            axes.set_yscale("log")
        else:
            axes.set_ylim(bottom=least)
        if plot.get("logarithmic_x"):
            axes.set_xscale("log")
        axes.set_title(plot["title"], weight="bold")
        axes.set_xlabel(plot["x"])
        axes.set_ylabel(plot["y"])
        axes.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
        figure.savefig(file, metadata={"Date": None, "Creator": None})
        plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    for data in sorted(folder.glob("*.plot.json")):
        draw(json.loads(data.read_text(encoding="utf-8")),
             folder / data.name.replace(".plot.json", ".svg"))


if __name__ == "__main__":
    main()
