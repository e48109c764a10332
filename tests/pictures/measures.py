#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/measures.png: the definitions of docs/measures.md on shapes with closed forms.

measures.py [FILE]    writes the picture, or into FILE

Every line is computed from the formula that it shows: the window's weights, the circle of curvature, rays and tangents
of a section, the beginnings and vectors of a fork's arms, a healthy calibre, and a neck plane."""
import argparse, io, math, pathlib

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

INK, GREY, LIGHT, WALL, BLUE, GREEN = "#222222", "#888888", "#d8d8d8", "#b2182b", "#4477aa", "#228833"
plt.rcParams.update({"font.size": 8, "axes.titlesize": 9, "axes.titlelocation": "left",
                     "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": GREY, "text.color": INK,
                     "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK})


def arrow(axes, start, end, colour=INK, style="-|>", width=1.1):
    axes.annotate("", end, start, arrowprops={"arrowstyle": style, "color": colour, "lw": width, "shrinkA": 0, "shrinkB": 0})


def label(axes, place, text, colour=INK, **more):
    axes.text(*place, text, color=colour, ha=more.pop("ha", "center"), va=more.pop("va", "center"), **more)


def bare(axes, title):
    axes.set_title(title)
    axes.set_aspect("equal")
    axes.axis("off")


def unit(v): return np.asarray(v) / np.linalg.norm(v)


def curve(axes):
    """A sine as axis: nodes, the weights of the window, and the circle of curvature at a place."""
    bare(axes, "The curve of the axis")
    radius, place = 0.45, 4.7
    x = np.linspace(0, 9.4, 400)
    f = lambda t: 1.1 * np.sin(t)
    normal = np.stack([-1.1 * np.cos(x), np.ones_like(x)], -1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    line = np.stack([x, f(x)], -1)
    for side in (-1, 1): axes.plot(*(line + side * radius * normal).T, color=WALL, lw=1)
    nodes = np.arange(0.2, 9.4, 0.3)
    # weights over the chord's length from the place, h = 6 r
    weight = np.clip(1 - ((nodes - place) / (6 * radius)) ** 2, 0, None) ** 2
    axes.scatter(nodes, f(nodes), s=3 + 24 * weight, color=BLUE, zorder=3, lw=0)
    slope, bend = 1.1 * math.cos(place), -1.1 * math.sin(place)
    k = bend / (1 + slope ** 2) ** 1.5
    tangent, inward = unit([1, slope]), unit([-slope, 1])
    here = np.array([place, f(place)])
    centre = here + inward / k
    axes.add_patch(plt.Circle(centre, abs(1 / k), fill=False, color=GREEN, lw=0.9, ls="--"))
    arrow(axes, here, here + 1.3 * tangent)
    axes.plot(*np.stack([here, centre]).T, color=GREEN, lw=0.9)
    label(axes, here + 1.3 * tangent + [0.2, 0.12], "T", ha="left")
    label(axes, centre + [0.14, 0.25], "1/k", GREEN, ha="left")
    axes.plot([place - 6 * radius, place + 6 * radius], [-2.15, -2.15], color=BLUE, lw=1)
    label(axes, (place, -2.6), "window: 6 r to either side, weights as dots", BLUE)


def section(axes):
    """An ellipse that is cut by rays from a place beside its middle, with Feret's diameters."""
    bare(axes, "Cross-section")
    a, b, turn, place = 1.8, 1.15, 0.5, np.array([0.3, 0.12])
    angle = np.linspace(0, 2 * math.pi, 200)
    rotate = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    ring = rotate @ np.array([a * np.cos(angle), b * np.sin(angle)])
    axes.fill(*ring, facecolor="#fbeeee", edgecolor=WALL, lw=1.1)
    axes.plot(*place, ".", color=INK)
    inverse = rotate @ np.diag([a ** -2, b ** -2]) @ rotate.T
    for i in range(48):
        d = np.array([math.cos(2 * math.pi * i / 48), math.sin(2 * math.pi * i / 48)])
        # the positive root of |place + rho d| on the ellipse
        p, q, r = d @ inverse @ d, d @ inverse @ place, place @ inverse @ place - 1
        rho = (-q + math.sqrt(q * q - p * r)) / p
        axes.plot(*np.stack([place, place + rho * d]).T, color=BLUE if i == 5 else LIGHT, lw=1.1 if i == 5 else 0.5, zorder=1)
        if i == 5: label(axes, place + 0.62 * rho * d + [0.02, 0.2], r"$\rho(a)$", BLUE)
    for half, axis, name, gap in ((a, rotate[:, 0], "largest", 1.75), (b, rotate[:, 1], "smallest", 2.35)):
        across = rotate[:, 1] if half == a else rotate[:, 0]
        for side in (-1, 1):
            foot = side * half * axis
            axes.plot(*np.stack([foot - 0.25 * across, foot - gap * across]).T, color=GREEN, lw=0.7)
        arrow(axes, -half * axis - (gap - 0.12) * across, half * axis - (gap - 0.12) * across, GREEN, "<|-|>", 0.9)
        label(axes, -(gap + 0.18) * across, name + " diameter", GREEN,
              rotation=math.degrees(math.atan2(axis[1], axis[0])) if half == a else math.degrees(turn) - 90, rotation_mode="anchor")
    label(axes, (0, 2.3), r"$A=\frac{1}{2}\int\rho^2\,da$,  $P=\int\sqrt{\rho^2+\rho'^2}\,da$")
    axes.set_xlim(-3.1, 2.6); axes.set_ylim(-2.9, 2.6)


def fork(axes):
    """Three tubes that meet: where each leaves the others, spheres, vectors and angles."""
    bare(axes, "Fork")
    arms = [(np.array([0.0, -1.0]), 1.0), (unit([math.sin(math.radians(-30)), math.cos(math.radians(30))]), 0.9),
            (unit([math.sin(math.radians(50)), math.cos(math.radians(50))]), 0.65)]
    angle = np.linspace(0, 2 * math.pi, 100)
    for d, r in arms:
        n = np.array([-d[1], d[0]])
        for side in (-1, 1):
            at = np.linspace(0, 5, 400)[:, None] * d + side * r * n
            # hidden within another tube
            free = np.all([(np.abs(at @ np.array([-e[1], e[0]])) > q) | (at @ e < 0) for e, q in arms if e is not d], axis=0)
            axes.plot(*np.where(free[:, None], at, np.nan).T, color=WALL, lw=1.1)
        axes.plot(*np.stack([0 * d, 5 * d]).T, color=LIGHT, lw=0.8, zorder=0)
    begins = []
    for d, r in arms:
        # beginning: the axis leaves the tubes of all others, at r' / sin of the angle between them
        far = max(q / math.sqrt(1 - max(0.0, float(d @ e)) ** 2) if float(d @ e) > 0 else q for e, q in arms if e is not d)
        begins.append(far * d)
        axes.plot(*(far * d), ".", color=INK, ms=5)
        axes.add_patch(plt.Circle(far * d + r * d, r, fill=False, color=GREY, lw=0.6, ls=":"))
    parent, larger, smaller = arms
    arrow(axes, begins[0] + parent[1] * parent[0], begins[0], BLUE)
    for (d, r), p in zip(arms[1:], begins[1:]): arrow(axes, p, p + r * d, BLUE)
    axes.plot([0, 0], [0, 4.6], color=GREY, lw=0.7, ls="--")
    for d, text, reach in ((larger[0], "larger take-off", 4.3), (smaller[0], "smaller take-off", 3.9)):
        end = math.atan2(d[0], d[1])
        arc = np.linspace(0, end, 60)
        axes.plot(reach * np.sin(arc), reach * np.cos(arc), color=GREEN, lw=0.9)
        middle = end / 2
        label(axes, ((reach + 0.35) * math.sin(middle), (reach + 0.35) * math.cos(middle)), text, GREEN,
              rotation=-math.degrees(middle), rotation_mode="anchor")
    label(axes, (0.2, -3.6), "parent", ha="left")
    axes.plot(*np.stack([begins[0], begins[1], begins[2], begins[0]]).T, color=GREY, lw=0.6)
    axes.set_ylim(-4.6, 5.0)


def narrowing(axes):
    """Calibres with a lesion, and the robust local line of section 6."""
    axes.set_title("Narrowing")
    s = np.arange(0, 60, 0.75)
    rng = np.random.default_rng(1)
    calibre = (4.2 - 0.02 * s) * (1 - 0.55 * np.exp(-(((s - 33) / 2.6) ** 2))) + 0.03 * rng.standard_normal(s.size)
    weights, healthy = np.ones_like(s), calibre.copy()
    for _ in range(8):
        for i, t in enumerate(s):
            w = weights * np.clip(1 - (np.abs(s - t) / 40) ** 3, 0, None) ** 3
            healthy[i] = np.polyval(np.polyfit(s - t, calibre, 1, w=np.sqrt(w)), 0)
        rest = calibre - healthy
        weights = np.clip(1 - (rest / (6 * np.median(np.abs(rest)))) ** 2, 0, None) ** 2
    axes.plot(s, calibre, color=WALL, lw=1.1)
    axes.plot(s, healthy, color=BLUE, lw=1.1)
    lesion = np.flatnonzero(calibre < 0.9 * healthy)
    axes.plot(s[lesion], np.full(lesion.size, 1.15), color=GREEN, lw=1.4)
    label(axes, (s[lesion][0] - 1, 1.15), "length", GREEN, ha="right")
    worst = int(np.argmin(calibre / healthy))
    arrow(axes, (s[worst], 0.0), (s[worst], calibre[worst]), INK, "<|-|>", 0.8)
    arrow(axes, (s[worst] + 6, 0.0), (s[worst] + 6, healthy[worst]), BLUE, "<|-|>", 0.8)
    label(axes, (s[worst] + 1, 0.6), "D", ha="left")
    label(axes, (s[worst] + 7, 2.2), "H, healthy", BLUE, ha="left")
    label(axes, (1, 0.4), f"NASCET = 1 - D/H = {100 * (1 - calibre[worst] / healthy[worst]):.0f} %", ha="left")
    axes.set_xlim(0, 60); axes.set_ylim(0, 4.8)
    axes.set_xlabel("along the vessel, mm"); axes.set_ylabel("calibre, mm")


def aneurysm(axes):
    """A ball on a tube, cut at the plane in which the two meet."""
    bare(axes, "Aneurysm")
    tube, ball, neck = 1.5, 3.0, 2.0  # radii, mm; the neck's is half of its diameter
    low = tube  # the plane that touches the vessel
    centre = low + math.sqrt(ball ** 2 - neck ** 2)
    angle = np.linspace(0, 2 * math.pi, 300)
    dome = np.array([ball * np.sin(angle), centre - ball * np.cos(angle)])
    axes.plot(*np.where(dome[1] >= low, dome, np.nan), color=WALL, lw=1.1)
    for x in ([-6, -neck], [neck, 6]): axes.plot(x, [tube, tube], color=WALL, lw=1.1)
    axes.plot([-6, 6], [-tube, -tube], color=WALL, lw=1.1)
    axes.plot([-neck - 0.9, neck + 0.9], [low, low], color=BLUE, lw=1)
    label(axes, (neck + 1.0, low + 0.35), "neck plane", BLUE, ha="left")
    arrow(axes, (-neck, low - 0.45), (neck, low - 0.45), INK, "<|-|>", 0.8)
    label(axes, (-1.0, low - 0.9), "$D_n$")
    top = centre + ball
    arrow(axes, (0, low), (0, top), GREEN, "<|-|>", 0.8)
    label(axes, (0.25, low + 0.62 * (top - low)), "H, reach", GREEN, ha="left")
    arrow(axes, (-ball, centre), (ball, centre), GREEN, "<|-|>", 0.8)
    label(axes, (-ball / 2, centre + 0.35), "W", GREEN)
    arrow(axes, (-5.6, 0), (-3.6, 0), BLUE)
    label(axes, (-4.6, -0.5), "inflow", BLUE)
    axes.plot([-3.6, 0], [0, 0], color=GREY, lw=0.6, ls="--")
    axes.plot([0, 0], [0, low], color=GREY, lw=0.6, ls="--")
    arc = np.linspace(0, math.pi / 2, 40)
    axes.plot(0.8 * np.cos(arc), 0.8 * np.sin(arc), color=GREY, lw=0.8)
    axes.plot([0, 1.1], [0, 0], color=GREY, lw=0.6, ls="--")
    label(axes, (1.15, 0.35), "inflow angle", GREY, ha="left")
    axes.set_ylim(-2.2, top + 0.5)


def path(axes):
    """A path with its chord, smallest inscribed sphere and catheter."""
    bare(axes, "Vessel and path")
    t = np.linspace(0, 1, 300)
    line = np.stack([9 * t, 1.6 * np.sin(2.2 * math.pi * t) * (0.4 + 0.6 * t)], -1)
    step = np.gradient(line, axis=0)
    normal = np.stack([-step[:, 1], step[:, 0]], -1) / np.linalg.norm(step, axis=1)[:, None]
    radius = 0.55 - 0.22 * np.exp(-(((t - 0.55) / 0.07) ** 2)) - 0.12 * t
    for side in (-1, 1): axes.plot(*(line + side * radius[:, None] * normal).T, color=WALL, lw=1.1)
    axes.plot(*line.T, color=INK, lw=0.8)
    axes.plot(*line[[0, -1]].T, color=BLUE, lw=0.9, ls="--")
    least = int(np.argmin(radius))
    axes.add_patch(plt.Circle(line[least], radius[least], fill=False, color=GREEN, lw=1))
    label(axes, line[least] + [0.4, 2.6], "smallest radius r:\ncatheter of 6 r French", GREEN, ha="left")
    axes.plot(*np.stack([line[least] + [0.35, 2.1], line[least] + radius[least] * unit([0.35, 2.1])]).T, color=GREEN, lw=0.7)
    length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
    chord = float(np.linalg.norm(line[-1] - line[0]))
    label(axes, line[60] + [0, 0.95], "L")
    label(axes, line[0] + 0.3 * (line[-1] - line[0]) + [0, -0.95], "C", BLUE)
    label(axes, (4.5, -2.9), f"tortuosity = L/C - 1 = {length / chord - 1:.2f}")
    axes.set_ylim(-3.2, 3.2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", metavar="FILE", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2] / "docs/measures.png")
    out = parser.parse_args().out
    figure, places = plt.subplots(2, 3, figsize=(10, 6.2))
    for draw, axes in zip((curve, section, path, fork, narrowing, aneurysm), places.flat): draw(axes)
    figure.tight_layout(w_pad=1.5)
    image = io.BytesIO()
    figure.savefig(image, dpi=130)
    Image.open(image).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(out, optimize=True)


if __name__ == "__main__":
    main()
