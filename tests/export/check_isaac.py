#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads what `lumen export isaac` writes with NumPy and with the USD loader of three.js, and compares it with the case.

check_isaac.py LUMEN [--modules NODE_MODULES]

NODE_MODULES has three; without it, or without node, the stage is not loaded. Exit status: 0 all held, 1 something did not,
77 the arrays held and the stage was not loaded."""
import argparse, json, math, pathlib, shutil, subprocess, sys, tempfile
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
KEYS = ["shape_zyx", "spacing_zyx_mm", "origin_xyz_mm", "hu_range", "mu_range", "source"]
failures = []


def expect(truth, what):
    if not truth:
        failures.append(what)
        print(what)


def lumen(program, folder, *arguments):
    done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0: sys.exit(f"lumen {' '.join(arguments)}: {done.stderr}")


def rows(values, width): return np.array(values, dtype=float).reshape(-1, width)


def load(folder, name, dtype, shape):
    """An array that must have this type and shape, in C order."""
    array = np.load(folder / name, allow_pickle=False)
    expect(array.dtype == np.dtype(dtype), f"{name}: {array.dtype}, expected {dtype}")
    expect(array.shape == tuple(shape), f"{name}: {array.shape}, expected {shape}")
    expect(array.flags.c_contiguous, f"{name}: not in C order")
    return array


def check_graph(folder, tree):
    centre, radius, parent = rows(tree["centre"], 3), np.ravel(tree["radius"]), np.ravel(tree["parent"])
    nodes = len(radius)
    points = load(folder, "centerline_points_mm.npy", "<f4", (nodes, 3))
    expect(np.abs(points - centre).max() < 1e-4, "points are not the nodes' centres")
    radii = load(folder, "centerline_radii_mm.npy", "<f4", (nodes,))
    expect(np.abs(radii - radius).max() < 1e-4, "radii are not the nodes'")
    expected = [[p, n] for n, p in enumerate(parent) if p >= 0]
    edges = load(folder, "centerline_edges.npy", "<i8", (len(expected), 2))
    expect(edges.tolist() == expected, "edges are not the tree's")
    return points, radii


def check_volumes(folder, points, radii):
    about = json.loads((folder / "metadata.json").read_text())
    expect(list(about) == KEYS, f"metadata.json: {list(about)}")
    expect("synthetic" in about["source"], "metadata.json does not state that the volume is synthetic")
    mask = load(folder, "vessel_mask.npy", "|u1", about["shape_zyx"])
    mu = load(folder, "mu_volume.npy", "<f4", about["shape_zyx"])
    low, high = about["mu_range"]
    expect(math.isclose(low, 0.02 * 1040 / 4000) and math.isclose(high, 0.02 * 1350 / 4000), f"mu_range {low} {high}")
    expect(abs(mu.min() - low) < 1e-6 and abs(mu.max() - high) < 1e-6, "mu_volume is beyond its range")
    expect(np.array_equal(mu > 0.5 * (low + high), mask == 1), "mask and attenuation disagree")
    expect(set(np.unique(mask)) == {0, 1}, "the mask has other values than 0 and 1")
    spacing, origin = np.array(about["spacing_zyx_mm"]), np.array(about["origin_xyz_mm"])
    index = np.rint((points - origin)[:, ::-1] / spacing).astype(int)  # z, y, x
    expect((mask[tuple(index.T)] == 1).mean() > 0.99, "nodes are not in the mask")
    wrong = np.rint((points - origin) / spacing[::-1]).astype(int)  # x, y, z taken for z, y, x
    inside = ((wrong >= 0) & (wrong < mask.shape)).all(axis=1)
    expect((mask[tuple(wrong[inside].T)] == 1).sum() < 0.5 * len(points), "the case is alike along z and x: it proves nothing")
    check_radii(mask, spacing, origin, points, radii)


def check_radii(mask, spacing, origin, points, radii):
    """Every voxel of the mask is near the tree, by about a radius, to half the diagonal of a voxel."""
    voxels = np.argwhere(mask == 1)[:: max(1, int(mask.sum()) // 5000)]
    places = voxels[:, ::-1] * spacing[::-1] + origin
    gap = (np.linalg.norm(places[:, None] - points[None], axis=2) - radii[None]).min(axis=1)
    expect(np.quantile(gap, 0.99) < 0.5 * np.linalg.norm(spacing) + 0.3 * radii.max(), f"the mask is not around the tree: {gap.max()}")


def in_folder(manifest, lps): return (np.array(manifest["transform"]) @ [*lps, 1])[:3]


def in_world(manifest, position, meters):
    """A position of the folder's frame where three, in which y is up, has it, in metres."""
    x, y, z = np.array(position) * meters
    return np.array([x, y, z] if manifest["axes"] == "LSA" else [x, z, -y])


def check_stage(folder, modules, points, radii):
    manifest = json.loads((folder / "lumen-export.json").read_text())
    meters = {"m": 1, "mm": 0.001}[manifest["unit"]]
    done = subprocess.run(["node", HERE / "load_usda.mjs", folder / "vessel.usda", modules], capture_output=True, text=True)
    if done.returncode != 0: sys.exit(f"load_usda.mjs: {done.stderr}")
    stage = json.loads(done.stdout)
    expect(math.isclose(stage["metersPerUnit"], meters), f"metersPerUnit {stage['metersPerUnit']}")
    expect(stage["upAxis"] == ("Y" if manifest["axes"] == "LSA" else "Z"), f"upAxis {stage['upAxis']}")
    expect(stage["apiSchemas"] == ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI", "PhysxSDFMeshCollisionAPI"], stage["apiSchemas"])
    expect(stage["approximation"] == "none", stage["approximation"])
    wall = rows(stage["wall"], 3)
    expect(len(manifest["ends"]) == len(stage["ends"]) > 2, "not all ends are there")
    for end in manifest["ends"]:
        name = end["name"].replace("-", "_")
        expected = in_world(manifest, end["position"], meters)
        found = np.array(stage["ends"][name])
        expect(np.abs(found - expected).max() < 1e-7, f"{name}: {found} for {expected}")  # 1e-4 mm
        rim = np.abs(np.linalg.norm(wall - expected, axis=1) - end["radius"] * meters).min()
        expect(rim < 0.1 * end["radius"] * meters, f"{name}: the wall has no rim at its radius")
    # a node's wall is about its radius away: the mesh is where the tree is
    for k in range(0, len(points), 5):
        gap = np.linalg.norm(wall - in_world(manifest, in_folder(manifest, points[k]), meters), axis=1).min() * 1000
        expect(0.5 * radii[k] < gap < 1.5 * radii[k], f"node {k}: the wall is {gap} mm away, its radius is {radii[k]}")
    curve = rows(stage["centerline"]["points"], 3)  # as in the file
    expect(np.abs(curve[0] - in_folder(manifest, points[0])).max() * meters < 1e-7, "the centerline does not begin at the root")
    expect(len(curve) == sum(stage["centerline"]["counts"]) == len(stage["centerline"]["widths"]), "curves and their points disagree")
    expect(abs(stage["centerline"]["widths"][0] * meters * 1000 - 2 * radii[0]) < 1e-4, "widths are not diameters")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lumen")
    parser.add_argument("--modules", default=str(HERE.parent.parent / "viewer/page/node_modules"))
    options = parser.parse_args()
    can_load = shutil.which("node") and (pathlib.Path(options.modules) / "three").is_dir()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        lumen(options.lumen, folder, "phantom", "bifurcation", "fork.nrrd", "--size", "64", "--seeds", "seeds.json", "--quiet")
        lumen(options.lumen, folder, "convert", "fork.nrrd", "fork.lumen", "--seeds", "seeds.json", "--seeds-only", "--quiet")
        lumen(options.lumen, folder, "convert", "fork.lumen", "fork.lumen.json", "--quiet")
        tree = json.loads((folder / "fork.lumen.json").read_text())["tree"]
        for out, arguments in (("metres", []), ("up", ["--up", "y", "--unit", "mm"])):
            lumen(options.lumen, folder, "export", "isaac", "fork.lumen", out, "--quiet", *arguments)
            points, radii = check_graph(folder / out, tree)
            check_volumes(folder / out, points, radii)
            if can_load: check_stage(folder / out, options.modules, points, radii)
    if failures: return 1
    if not can_load: print("node or three (npm ci in viewer/page) is missing: vessel.usda was not loaded")
    return 0 if can_load else 77


sys.exit(main())
