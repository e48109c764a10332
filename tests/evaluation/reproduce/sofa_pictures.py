# SPDX-License-Identifier: Apache-2.0
"""Pictures of instruments in a vessel from recorded frames, beside the points of its surface, in two projections."""
import numpy as np

COLOURS = {"implicit": "#0072b2", "mesh 100k": "#d55e00", "mesh 24k": "#e69f00",
           "soft": "#009e73", "mesh": "#d55e00", "soft-stiff": "#cc79a7", "implicit-stiff": "#56b4e9",
           "vessel at rest": "#999999", "vessel": "#000000", "vessel, stiff wire": "#f0e442"}
NEAR = 12  # mm: how much of the vessel is drawn around the instrument


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


def draw(path, title, wires, surface):
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
