#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads what `lumen export steve` writes as stEVE reads it, and compares it with the case.

check_steve.py LUMEN

Paths as its class VMR takes them: two lines are passed over, every <pos> counts, ten times its number is mm. The
module vessels.py is run with stand-ins for stEVE's classes. Exit status: 0 all held, 1 something did not."""
import importlib.util, json, pathlib, subprocess, sys, tempfile, types
from xml.dom import minidom

failures = []


def expect(truth, what):
    if not truth:
        failures.append(what)
        print(what)


def lumen(program, folder, *arguments):
    done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0: sys.exit(f"lumen {' '.join(arguments)}: {done.stderr}")


def points_of(file):
    with open(file, encoding="utf-8") as text:
        next(text)
        next(text)
        tree = minidom.parse(text)
    return [[10 * float(p.attributes[a].value) for a in "xyz"] for p in tree.getElementsByTagName("pos")]


def far(a, b): return max(abs(x - y) for x, y in zip(a, b))


def branches_of(case):
    """Name, points and radii of each branch, its parent's point first, mm."""
    tree = case["tree"]
    numbers = lambda key: tree[key] if isinstance(tree[key][0], (int, float)) else [x for row in tree[key] for x in row]
    flat, radius = numbers("centre"), numbers("radius")
    centre = [flat[3 * i:3 * i + 3] for i in range(len(flat) // 3)]
    for branch in tree["branches"]:
        first = branch["firstNode"]
        nodes = list(range(first, first + branch["nodeCount"]))
        parent = branch.get("parentNode", -1)
        if parent is None: parent = -1
        points = ([centre[parent]] if parent >= 0 else []) + [centre[n] for n in nodes]
        radii = ([radius[first]] if parent >= 0 else []) + [radius[n] for n in nodes]
        yield branch["label"].lower(), points, radii


def vessel_tree(file):
    """Arguments that the module hands to stEVE."""
    handed = {}
    class FromMesh:
        def __init__(self, mesh, insertion_position, insertion_direction, branch_list=None, approx_branch_radii=None,
                     visu_mesh=None, scaling_xyz=None, rotation_yzx_deg=None, rotate_branches=True, rotate_ip=True):
            handed.update(locals())
    class BranchWithRadii:
        def __init__(self, name, coordinates, radii): self.name, self.coordinates, self.radii = name, coordinates, radii
    for name, content in (("eve", {}), ("eve.intervention", {}), ("eve.intervention.vesseltree", {"FromMesh": FromMesh}),
                          ("eve.intervention.vesseltree.util", {}),
                          ("eve.intervention.vesseltree.util.branch", {"BranchWithRadii": BranchWithRadii})):
        sys.modules[name] = types.ModuleType(name)
        vars(sys.modules[name]).update(content)
    spec = importlib.util.spec_from_file_location("vessels", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.make_vessel_tree()
    return handed


def signed_volume(obj):
    """Volume of a closed mesh, mm^3: positive if its triangles turn counter-clockwise seen from outside."""
    points, sum_ = [], 0.0
    for line in open(obj):
        words = line.split()
        if words[:1] == ["v"]: points.append([float(w) for w in words[1:4]])
        if words[:1] == ["f"]:
            a, b, c = (points[int(w.split("/")[0]) - 1] for w in words[1:4])
            sum_ += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return sum_, points


def check(program, folder):
    lumen(program, folder, "phantom", "bifurcation", "v.nrrd", "--size", "64", "--seeds", "s.json", "--quiet")
    lumen(program, folder, "convert", "v.nrrd", "c.lumen.json", "--seeds", "s.json", "--seeds-only", "--quiet")
    lumen(program, folder, "export", "steve", "c.lumen.json", "out", "--quiet")
    truth = list(branches_of(json.loads((folder / "c.lumen.json").read_text())))
    out = folder / "out"
    expect({p.stem for p in (out / "Paths").iterdir()} == {name for name, _, _ in truth}, "a path for each branch")
    for name, points, _ in truth:
        read = points_of(out / "Paths" / f"{name}.pth")
        expect(len(read) == len(points), f"{name}: {len(read)} points of {len(points)}")
        expect(max(map(far, read, points)) < 1e-4, f"{name}: the path's points are those of the branch, in cm")
    handed = vessel_tree(out / "vessels.py")
    expect(pathlib.Path(handed["mesh"]).is_file(), "the mesh lies beside the module")
    expect(handed["rotation_yzx_deg"] == [0.0, 0.0, 0.0] and handed["scaling_xyz"] is None, "neither turned nor scaled")
    expect(far(handed["insertion_position"], truth[0][1][0]) < 1e-4, "inserted at the root")
    along = [b - a for a, b in zip(*truth[0][1][:2])]
    expect(sum(x * y for x, y in zip(handed["insertion_direction"], along)) > 0, "into the vessels")
    expect(abs(sum(x * x for x in handed["insertion_direction"]) - 1) < 1e-5, "the direction is a unit vector")
    for branch, (name, points, radii) in zip(handed["branch_list"], truth):
        expect(branch.name == name and branch.coordinates.shape == (len(points), 3) and branch.radii.shape == (len(points),),
               f"{name}: coordinates (N, 3) and radii (N,)")
        expect(max(map(far, branch.coordinates.tolist(), points)) < 1e-4, f"{name}: its coordinates are in mm")
        expect(far(branch.radii.tolist(), radii) < 1e-4, f"{name}: its radii are in mm")
    volume, points = signed_volume(out / "vessel.obj")
    expect(volume < 0, "the mesh looks into the lumen")
    inside = [min(p[a] for p in points) < truth[0][1][0][a] < max(p[a] for p in points) for a in range(3)]
    expect(all(inside), "mesh and branches are in one unit and order of axes")


def main():
    with tempfile.TemporaryDirectory() as folder: check(str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(folder))
    return 1 if failures else 0


if __name__ == "__main__": sys.exit(main())
