#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Where the edge of a real volume lies, VMTK's surface of it, and lumen's wall.

aorta_walls.py FOLDER [CASE_MESH.ply]

FOLDER holds aorta.mha and aorta-surface.stl of the VMTK test data. Along the normals of VMTK's surface it looks for
the volume's edge, where the intensity is halfway between lumen and background, and where it falls most steeply; of a
mesh that lumen made of its case (lumen convert aorta.lumen aorta.ply) it takes the distance from the same points. All
in mm, positive outside of VMTK's surface, as medians by the width of the vessel. Below that, an edge that a Gaussian has
blurred, beside a lumen that darkens evenly towards its wall, fitted to the median profile. Needs numpy and scipy."""
import pathlib, struct, sys

import numpy as np
from scipy import ndimage, optimize, special
from scipy.spatial import cKDTree

STEP, REACH = 0.1, 4.0  # mm along the normal, to both sides
LEVEL_REACH = 2.6       # mm from the edge within which its levels are looked for: two and a half voxels
WIDTHS = ((0, 5, "iliacs"), (5, 99, "aorta"))  # radius, mm


def volume(path):
    raw = path.read_bytes()
    header, start = {}, 0
    while True:
        end = raw.index(b"\n", start)
        key, _, value = raw[start:end].decode().partition("=")
        header[key.strip()], start = value.strip(), end + 1
        if key.strip() == "ElementDataFile": break
    numbers = lambda key: np.array([float(v) for v in header[key].split()])
    size = [int(v) for v in header["DimSize"].split()]
    kind = {"MET_FLOAT": "<f4", "MET_SHORT": "<i2", "MET_USHORT": "<u2"}[header["ElementType"]]
    if header.get("CompressedData") == "True":
        import zlib
        raw, start = zlib.decompress(raw[start:]), 0
    voxels = np.frombuffer(raw, kind, int(np.prod(size)), start).reshape(size[::-1]).astype(float)
    direction = numbers("TransformMatrix").reshape(3, 3).T  # its columns are the axes
    return voxels, numbers("Offset"), numbers("ElementSpacing"), direction


def stl(path):
    raw = path.read_bytes()
    count = struct.unpack_from("<I", raw, 80)[0]
    facets = np.frombuffer(raw, np.dtype([("f", "<f4", (4, 3)), ("a", "<u2")]), count, 84)["f"].astype(float)
    return facets[:, 1:]


def ply(path):
    raw = path.read_bytes()
    end = raw.index(b"end_header\n") + len(b"end_header\n")
    kinds = {"float": "f4", "float32": "f4", "double": "f8", "uchar": "u1", "uint8": "u1", "int": "i4", "uint": "u4", "ushort": "u2"}
    fields, count, of = [], 0, ""
    for line in raw[:end].decode().splitlines():
        words = line.split()
        if words[0] == "element": of, count = words[1], int(words[2]) if words[1] == "vertex" else count
        if words[0] == "property" and of == "vertex": fields.append((words[2], "<" + kinds[words[1]]))
    vertices = np.frombuffer(raw, np.dtype(fields), count, end)
    return np.stack([vertices[a] for a in "xyz"], 1).astype(float)


def half_maximum(profile, at):
    """mm to the place halfway between the levels beside the steepest fall near the surface; and to that fall."""
    fall = np.convolve(profile, np.r_[np.full(5, -1.0), np.full(5, 1.0)] / 5, "same")  # of means over half a mm
    fall[np.abs(at) > 2.5] = -np.inf
    i = int(np.argmax(fall))
    near = lambda low, high: profile[(at >= low) & (at <= high)]
    inside, outside = near(at[i] - LEVEL_REACH, at[i]), near(at[i], at[i] + LEVEL_REACH)
    if len(inside) < 3 or len(outside) < 3: return None
    level = 0.5 * (inside.max() + outside.min())
    if inside.max() - outside.min() < 150: return None  # a tenth of the aorta's contrast: no edge
    crossings = [k for k in range(len(at) - 1) if profile[k] >= level > profile[k + 1]]
    if not crossings: return None
    k = min(crossings, key=lambda k: abs(k - i))
    return at[k] + STEP * (profile[k] - level) / (profile[k] - profile[k + 1]), at[i]


def blurred_edge(profile, at):
    """mm to the edge, its blur (standard deviation, mm) and the slope of the lumen (intensity to a mm)."""
    near = np.abs(at) < 3
    shape = lambda x, a, b, edge, blur, slope: (b + (a - b) * 0.5 * special.erfc((x - edge) / (2 ** 0.5 * blur))
                                                + slope * np.minimum(x - edge, 0))
    found, _ = optimize.curve_fit(shape, at[near], profile[near], [profile[0], profile[-1], 0, 1, 0])
    return found[2:]


def main():
    if len(sys.argv) < 2: sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    voxels, origin, spacing, direction = volume(folder / "aorta.mha")
    triangles = stl(folder / "aorta-surface.stl") * [-1, -1, 1]  # its x and y are negated against the image's
    middles = triangles.mean(1)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-30
    at = np.arange(-REACH, REACH + STEP / 2, STEP)
    coefficients = ndimage.spline_filter(voxels, 3)

    def profile(point, normal):
        index = (direction.T @ (point + at[:, None] * normal - origin).T).T / spacing
        return ndimage.map_coordinates(coefficients, index.T[::-1], order=3, prefilter=False, mode="nearest")

    inward = sum(np.sign(np.subtract(*np.interp([-2, 2], at, profile(m, n)))) for m, n in list(zip(middles, normals))[::50])
    if inward < 0: normals = -normals  # whichever way the facets turn, it is brighter inside
    others, ours = cKDTree(middles), None
    if len(sys.argv) > 2:
        vertices = ply(pathlib.Path(sys.argv[2]))
        ours = cKDTree(vertices)
    rows, profiles = [], []
    for m, n in list(zip(middles, normals))[::3]:
        seen = profile(m, n)
        found = half_maximum(seen, at)
        if found is None: continue
        # the radius: half of the way through the lumen
        steps = m - np.arange(1, 14, 0.25)[:, None] * n
        facing = np.array([normals[k] @ n < -0.5 and d < 1 for d, k in zip(*others.query(steps))])
        if not facing.any(): continue
        radius = 0.5 * np.arange(1, 14, 0.25)[np.argmax(facing)]
        wall = np.nan
        if ours is not None:
            near = vertices[ours.query_ball_point(m, 3)]
            if len(near):
                along, across = (near - m) @ n, np.linalg.norm(np.cross(near - m, n), axis=1)
                close = across < 0.7
                if close.any(): wall = along[close][np.argmin(np.abs(along[close]))]
        rows.append((radius, *found, wall))
        profiles.append(seen)
    table, profiles = np.array(rows), np.array(profiles)
    print(f"{'':18}{'points':>7}{'half maximum':>14}{'steepest':>10}{'lumen wall':>12}{'wall - half':>13}   mm outside of VMTK's surface (medians)")
    for low, high, name in WIDTHS + ((0, 99, "all"),):
        part = table[(table[:, 0] >= low) & (table[:, 0] < high)]
        if not len(part): continue
        print(f"{name:18}{len(part):7}{np.median(part[:, 1]):14.3f}{np.median(part[:, 2]):10.3f}"
              f"{np.nanmedian(part[:, 3]) if ours is not None else np.nan:12.3f}"
              f"{np.nanmedian(part[:, 3] - part[:, 1]) if ours is not None else np.nan:13.3f}")
    for low, high, name in WIDTHS:
        part = (table[:, 0] >= low) & (table[:, 0] < high)
        edge, blur, slope = blurred_edge(np.median(profiles[part], 0), at)
        print(f"{name:18} blurred edge at {edge:.3f} mm, blur {blur:.2f} mm, lumen {slope:+.0f} to a mm outwards")


if __name__ == "__main__":
    main()
