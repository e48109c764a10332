#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pictures of measures, as SVG, to look at.

draw_measures.py LUMEN CASE OUT

Writes OUT-profiles.svg, with curvature, radius and area along the three longest vessels and the intervals behind
them, and OUT-forks.svg, with the vectors of every fork over the wall points, seen from the front. Needs numpy."""
import json, pathlib, subprocess, sys, tempfile
import numpy as np

WIDTH, HEIGHT, LEFT = 900, 150, 70


def svg(width, height, body):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">'
            f'<rect width="100%" height="100%" fill="white"/>{body}</svg>\n')


def path(points, style):
    return '<path d="M' + "L".join(f"{x:.1f} {y:.1f}" for x, y in points) + f'" {style}/>'


def panel(top, title, along, values, plus):
    """One curve with its interval; gaps where it is not defined."""
    known = np.isfinite(values)
    if not known.any(): return ""
    most = 1.1 * np.nanpercentile(values, 99.5)
    x = lambda s: LEFT + (WIDTH - LEFT - 20) * s / along[-1]
    y = lambda v: top + HEIGHT - 25 - (HEIGHT - 45) * np.clip(v / most, 0, 1)
    body = f'<text x="{LEFT}" y="{top + 12}">{title}</text><text x="4" y="{top + 24}">{most:.3g}</text><text x="4" y="{top + HEIGHT - 25}">0</text>'
    body += path([(LEFT, top + HEIGHT - 25), (WIDTH - 20, top + HEIGHT - 25)], 'stroke="black" fill="none"')
    body += f'<text x="{WIDTH - 70}" y="{top + HEIGHT - 10}">{along[-1]:.0f} mm</text>'
    first = 0
    while first < len(values):
        if not known[first]: first += 1; continue
        last = first
        while last + 1 < len(values) and known[last + 1]: last += 1
        part = slice(first, last + 1)
        s, v, p = along[part], values[part], np.nan_to_num(plus[part])
        outline = list(zip(x(s), y(v + p))) + list(zip(x(s), y(np.maximum(v - p, 0))))[::-1]
        body += path(outline, 'fill="#cfdfef" stroke="none"') + path(list(zip(x(s), y(v))), 'stroke="#a01818" stroke-width="1.3" fill="none"')
        first = last + 1
    return body


def profiles(measures, out):
    lengths = {v["vessel"]: v["length_mm"]["value"] or 0 for v in measures["vessels"]}
    body, top = "", 0
    for vessel in sorted(lengths, key=lengths.get, reverse=True)[:3]:
        rows = [s for s in measures["stations"] if s["vessel"] == vessel]
        column = lambda name, part: np.array([np.nan if s[name][part] is None else s[name][part] for s in rows], float)
        for name in ("curvature_per_mm", "inscribed_radius_mm", "area_mm2"):
            body += panel(top, f"{vessel}: {name}", column("along_mm", "value"), column(name, "value"), column(name, "plus_minus"))
            top += HEIGHT
    out.write_text(svg(WIDTH, top, body))


def forks(measures, case, out):
    points = np.reshape(np.array(case["points"]["position"], float), (-1, 3))
    points = points[::max(1, len(points) // 40000)]
    low, high = points.min(axis=0), points.max(axis=0)
    scale = 1000 / max(high[0] - low[0], high[2] - low[2])
    flat = lambda p: ((p[0] - low[0]) * scale + 20, (high[2] - p[2]) * scale + 20)
    body = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="0.7" fill="#b9b9b9"/>' for x, y in map(flat, points))
    colours = {"parent_vector_mm": "#1850a0", "larger_vector_mm": "#a01818", "smaller_vector_mm": "#d08000"}
    for fork in measures["forks"]:
        place = np.array(fork["place_mm"])
        for key, colour in colours.items():
            if fork[key] is None: continue
            vector = np.array(fork[key]) * (-3 if key == "parent_vector_mm" else 3)
            body += path([flat(place), flat(place + vector)], f'stroke="{colour}" stroke-width="2" fill="none"')
        if fork["angle_deg"]["value"] is not None:
            x, y = flat(place)
            body += f'<text x="{x + 4:.0f}" y="{y - 4:.0f}" font-size="9">{fork["angle_deg"]["value"]:.0f}</text>'
    out.write_text(svg(int((high[0] - low[0]) * scale + 40), int((high[2] - low[2]) * scale + 40), body))


def main():
    lumen, source, out = sys.argv[1:]
    measures = json.loads(subprocess.run([lumen, "measure", source, "--json", "--quiet"], check=True, capture_output=True).stdout)["cases"][0]
    with tempfile.TemporaryDirectory() as folder:
        case = pathlib.Path(folder) / "case.lumen.json"
        subprocess.run([lumen, "convert", source, case, "--quiet"], check=True, capture_output=True)
        forks(measures, json.loads(case.read_text()), pathlib.Path(out + "-forks.svg"))
    profiles(measures, pathlib.Path(out + "-profiles.svg"))


if __name__ == "__main__":
    main()
