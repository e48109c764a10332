#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The necks of a case's aneurysms, as `lumen measure` finds them.

  necks.py LUMEN CASE OUT.png

One row for each aneurysm that has a neck: two views at right angles, in both of which the neck plane is a line (red).
The dome is blue and what else is near grey, with light from the viewer; the line from the neck's centroid to the tip
is black. Needs numpy."""
import json
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np

TILE = 420  # pixels


def mesh(lumen, case, folder):
    """Corners and triangles of the blended surface."""
    out = Path(folder) / "surface.obj"
    subprocess.run([lumen, "convert", case, out, "--quiet"], check=True)
    corners, triangles = [], []
    for line in out.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]: corners.append([float(w) for w in words[1:4]])
        if words[:1] == ["f"]: triangles.append([int(w.split("/")[0]) - 1 for w in words[1:4]])
    return np.array(corners), np.array(triangles)


def beyond(corners, triangles, plane, tip):
    """Which corners lie beyond the plane, connected with the tip."""
    normal, centre = plane
    above = (corners - centre) @ normal > 0
    inside = triangles[above[triangles].all(axis=1)]
    label = np.arange(len(corners))
    while True:
        least = label[inside].min(axis=1)
        before = label.copy()
        for k in range(3): np.minimum.at(label, inside[:, k], least)
        if (label == before).all(): break
    nearest = np.argmin(np.where(above, ((corners - tip) ** 2).sum(axis=1), np.inf))
    return above & (label == label[nearest])


def tile(corners, triangles, dome, sac, right):
    """A view in which the neck's normal points upwards."""
    normal, centre, tip = (np.array(sac[k]) for k in ("normal", "place_mm", "tip_place_mm"))
    out = np.cross(right, normal)
    scale = TILE / (2.6 * max(sac["reach_mm"]["value"], sac["width_mm"]["value"]))
    middle = 0.5 * (centre + tip)
    flat = lambda p: np.stack([(p - middle) @ right * scale + TILE / 2, TILE / 2 - (p - middle) @ normal * scale], -1)
    image, depth = np.full((TILE, TILE, 3), 255.0), np.full((TILE, TILE), -np.inf)
    places, far = flat(corners), (corners - middle) @ out
    for t in triangles:
        low, high = places[t].min(axis=0), places[t].max(axis=0)
        if (high < 0).any() or (low > TILE - 1).any(): continue
        face = np.cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]])
        light = face @ out / (np.linalg.norm(face) or 1)
        if light <= 0: continue
        x, y = np.meshgrid(np.arange(max(0, int(low[0])), min(TILE, int(high[0]) + 2)),
                           np.arange(max(0, int(low[1])), min(TILE, int(high[1]) + 2)))
        a, b, c = places[t]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area == 0: continue
        u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
        v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
        z = far[t[0]] + u * (far[t[1]] - far[t[0]]) + v * (far[t[2]] - far[t[0]])
        hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (z > depth[y, x])
        colour = np.array([90, 140, 230]) if dome[t].all() else np.array([190, 190, 190])
        image[y[hit], x[hit]] = colour * (0.35 + 0.65 * light)
        depth[y[hit], x[hit]] = z[hit]
    half = 0.5 * sac["neck_diameter_mm"]["value"]
    line(image, flat(centre - 1.6 * half * right), flat(centre + 1.6 * half * right), (230, 30, 30))
    line(image, flat(centre), flat(tip), (0, 0, 0))
    return image


def line(image, a, b, colour):
    for t in np.linspace(0, 1, 4 * TILE):
        x, y = (a + t * (b - a)).round().astype(int)
        if 0 <= x < TILE - 1 and 0 <= y < TILE - 1: image[y:y + 2, x:x + 2] = colour


def write_png(image, path):
    height, width, _ = image.shape
    rows = b"".join(b"\0" + row.tobytes() for row in image.astype(np.uint8))
    chunk = lambda kind, data: (struct.pack(">I", len(data)) + kind + data
                                + struct.pack(">I", zlib.crc32(kind + data)))
    Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                           + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def main():
    lumen, case, out = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "measures.json"
        subprocess.run([lumen, "measure", case, "--out", answer, "--quiet"], check=True, stdout=subprocess.DEVNULL)
        sacs = [s for s in json.loads(answer.read_text())["cases"][0]["sacs"] if s["normal"]]
        if not sacs: sys.exit(f"necks.py: {case} has no aneurysm with a neck")
        corners, triangles = mesh(lumen, case, folder)
    rows = []
    for sac in sacs:
        normal = np.array(sac["normal"])
        dome = beyond(corners, triangles, (normal, np.array(sac["place_mm"])), np.array(sac["tip_place_mm"]))
        first = np.cross(normal, [0, 0, 1] if abs(normal[2]) < 0.9 else [1, 0, 0])
        first /= np.linalg.norm(first)
        rows.append(np.hstack([tile(corners, triangles, dome, sac, r) for r in (first, np.cross(normal, first))]))
        print(sac["aneurysm"], sac["position"], {k: v["value"] for k, v in sac.items() if isinstance(v, dict)})
    write_png(np.vstack(rows), out)


if __name__ == "__main__":
    main()
