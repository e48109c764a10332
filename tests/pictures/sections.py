#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Sections of a volume at every fork and every end of a case, with the walls of one case or several.

  sections.py LUMEN VOLUME OUT.png CASE [CASE ...]

Places are those of the last CASE. At a fork the section holds both axes; at an end it holds the axis, and a second one
stands across. Each place has a tile for each case: its wall red, the axis' direction to the right, what is farther than
ten radii (at least 8 voxels) left out. Reads .nrrd, .mha and .nii volumes that are stored in one file.
"""
import gzip
import json
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.collections import LineCollection  # noqa: E402

TYPES = {"uchar": "u1", "unsigned char": "u1", "uint8": "u1", "uint8_t": "u1", "short": "<i2", "int16": "<i2", "int16_t": "<i2",
         "float": "<f4", "MET_FLOAT": "<f4", "MET_SHORT": "<i2", "MET_UCHAR": "u1"}
COLUMNS = 8


def voxels(path, size):
    """The volume's values as [i, j, k]."""
    data = path.read_bytes()
    if path.suffix == ".nrrd":
        head, _, body = data.partition(b"\n\n")
        fields = dict(line.split(": ", 1) for line in head.decode("latin1").splitlines() if ": " in line)
        kind = TYPES[fields["type"].strip()]
        if fields["encoding"].strip() in ("gzip", "gz"):
            body = gzip.decompress(body)
    elif path.suffix == ".mha":
        head, _, body = data.partition(b"ElementDataFile = LOCAL\n")
        fields = dict(line.split(" = ", 1) for line in head.decode("latin1").splitlines() if " = " in line)
        kind = TYPES[fields["ElementType"]]
        if fields.get("CompressedData") == "True":
            body = zlib.decompress(body)
    else:
        code, start = np.frombuffer(data[70:72], "<i2")[0], int(np.frombuffer(data[108:112], "<f4")[0])
        kind, body = {2: "u1", 4: "<i2", 16: "<f4"}[int(code)], data[start:]
    count = int(np.prod(size))
    return np.frombuffer(body, kind, count).reshape(size[::-1]).transpose(2, 1, 0).astype(np.float32)


class Volume:
    def __init__(self, lumen, path):
        info = json.loads(subprocess.run([lumen, "info", path, "--json"], check=True, capture_output=True).stdout)
        self.values = voxels(Path(path), info["size"])
        self.matrix = np.array(info["direction"]).reshape(3, 3) * np.array(info["spacing_mm"])
        self.origin = np.array(info["origin_mm"])
        self.voxel = float(np.prod(info["spacing_mm"])) ** (1 / 3)
        self.top = float(np.percentile(self.values[self.values > np.percentile(self.values, 90)], 90))

    def at(self, points):
        """Trilinear; zero outside."""
        x = (points - self.origin) @ np.linalg.inv(self.matrix).T
        low = np.floor(x).astype(int)
        f = x - low
        out = np.zeros(points.shape[:-1])
        for corner in np.ndindex(2, 2, 2):
            c = np.array(corner)
            i = low + c
            ok = ((i >= 0) & (i < self.values.shape)).all(-1)
            i = np.where(ok[..., None], i, 0)
            out += np.where(ok, self.values[i[..., 0], i[..., 1], i[..., 2]], 0) * np.where(c == 1, f, 1 - f).prod(-1)
        return out


PLY = {"float": "<f4", "double": "<f8", "int": "<i4", "uint": "<u4", "uchar": "u1", "ushort": "<u2", "short": "<i2"}


def mesh(lumen, case, folder):
    """Corners and triangles of a case's surface."""
    path = Path(folder) / "surface.ply"
    subprocess.run([lumen, "convert", case, path, "--quiet"], check=True)
    head, _, body = path.read_bytes().partition(b"end_header\n")
    elements = []  # count and type of a row; a list of corners has three
    for words in map(str.split, head.decode("latin1").splitlines()):
        if words[0] == "element":
            elements.append((int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            elements[-1][1].extend([("n", PLY[words[2]]), ("corner", PLY[words[3]], 3)])
        elif words[0] == "property":
            elements[-1][1].append((words[2], PLY[words[1]]))
    (count, vertex), (faces, face) = ((n, np.dtype(row)) for n, row in elements[:2])
    vertices = np.frombuffer(body, vertex, count)
    corners = np.stack([vertices[axis] for axis in "xyz"], 1).astype(float)
    return corners, np.frombuffer(body[count * vertex.itemsize:], face, faces)["corner"]


def tree(lumen, case, folder):
    path = Path(folder) / "case.lumen.json"
    subprocess.run([lumen, "convert", case, path, "--quiet"], check=True)
    return json.loads(path.read_text())["tree"]


def unit(v):
    return v / max(np.linalg.norm(v), 1e-9)


def across(u):
    return unit(np.cross(u, np.eye(3)[np.argmin(np.abs(u))]))


def places(t):
    """(title, place, right, up, radius) of every fork, then of every end."""
    centre, direction, radius = np.array(t["centre"]), np.array(t["direction"]), np.array(t["radius"])
    hung = set(b["parentNode"] for b in t["branches"])
    forks, ends = [], []
    for b in t["branches"]:
        first, last, parent = b["firstNode"], b["firstNode"] + b["nodeCount"] - 1, b["parentNode"]
        if parent >= 0:
            # the child's way is that to where it has left the parent
            clear = first
            while clear < last and np.linalg.norm(centre[clear] - centre[parent]) < 2 * radius[parent]:
                clear += 1
            u, w = unit(direction[parent]), centre[clear] - centre[parent]
            v = w - u * (u @ w)
            forks.append((f"{b['label']} leaves", centre[parent], u, unit(v) if np.linalg.norm(v) > 1e-3 else across(u),
                          radius[parent]))
        tips = [(last, 1)] if last not in hung else []
        if parent < 0:
            tips.append((first, -1))
        for node, sign in tips:
            u = unit(sign * direction[node])
            v = across(u)
            name = f"{b['label']} {'end' if sign > 0 else 'begin'} ({b.get('stopReason', '')})" if sign > 0 else f"{b['label']} begins"
            ends.append((name, centre[node], u, v, radius[node]))
            ends.append(("the same, turned", centre[node], u, np.cross(u, v), radius[node]))
    return forks + ends


def cut(corners, triangles, place, right, up, half):
    """Segments, in the plane's coordinates, where it meets the surface."""
    local = (corners - place) @ np.array([right, up, np.cross(right, up)]).T
    near = (np.abs(local) < 1.5 * half).all(1)
    t = local[triangles[near[triangles].any(1)]]
    side = t[:, :, 2] >= 0
    t, side = t[side.any(1) & ~side.all(1)], side[side.any(1) & ~side.all(1)]
    segments = []
    for triangle, s in zip(t, side):
        ends = []
        for a, b in ((0, 1), (1, 2), (2, 0)):
            if s[a] != s[b]:
                f = triangle[a][2] / (triangle[a][2] - triangle[b][2])
                ends.append(triangle[a][:2] + f * (triangle[b][:2] - triangle[a][:2]))
        segments.append(ends)
    return segments


def draw(volume, meshes, spots, out):
    tiles = len(spots) * len(meshes)
    rows = -(-tiles // COLUMNS)
    figure, axes = plt.subplots(rows, COLUMNS, figsize=(2.2 * COLUMNS, 2.35 * rows), squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    tile = iter(axes.flat)
    for title, place, right, up, radius in spots:
        half = max(5 * radius, 8 * volume.voxel)
        grid = np.linspace(-half, half, 96)
        points = place + grid[None, :, None] * right + grid[:, None, None] * up
        image = volume.at(points)
        for k, (corners, triangles) in enumerate(meshes):
            axis = next(tile)
            axis.imshow(image, cmap="gray", origin="lower", vmin=0, vmax=volume.top, extent=(-half, half, -half, half))
            axis.add_collection(LineCollection(cut(corners, triangles, place, right, up, half), colors="red", linewidths=0.9))
            axis.set_xlim(-half, half)
            axis.set_ylim(-half, half)
            where = ", ".join(f"{x:.0f}" for x in place)
            axis.set_title(f"{title}\n({where}) r {radius:.1f}" if k == 0 else f"case {k + 1}", fontsize=6.5)
    plt.subplots_adjust(left=0.005, right=0.995, top=1 - 0.3 / (2.35 * rows), bottom=0.005, wspace=0.03, hspace=0.2)
    figure.savefig(out, dpi=80)


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    lumen, path, out, cases = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
    volume = Volume(lumen, path)
    with tempfile.TemporaryDirectory() as folder:
        meshes = [mesh(lumen, case, folder) for case in cases]
        spots = places(tree(lumen, cases[-1], folder))
    draw(volume, meshes, spots, out)


if __name__ == "__main__":
    main()
