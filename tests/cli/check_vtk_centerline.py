#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens a centerline that lumen writes with VTK, and checks the arrays that VMTK's tools look for.

check_vtk_centerline.py LUMEN"""
import pathlib, subprocess, sys, tempfile

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

RADIUS = 1.5


def swc(path):
    """A trunk of 21 nodes along z that forks into two vessels of 10 nodes."""
    rows = [(i + 1, 0, 0, i, i if i else -1) for i in range(21)]
    for side in (1, -1):
        first = len(rows) + 1
        rows += [(first + i, side * (i + 1), 0, 20 + i, first + i - 1 if i else 21) for i in range(10)]
    path.write_text("".join(f"{n} 0 {x} {y} {z} {RADIUS} {parent}\n" for n, x, y, z, parent in rows))


def check(wrong, what):
    if wrong: sys.exit(f"check_vtk_centerline.py: {what}: {wrong}")


def main():
    lumen = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        swc(folder / "a.swc")
        for line in (("a.swc", "a.lumen"), ("a.lumen", "a.centerline.vtp")):
            subprocess.run([lumen, "convert", *(folder / f for f in line)], check=True, stdout=subprocess.DEVNULL)
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(folder / "a.centerline.vtp"))
        reader.Update()
        data = reader.GetOutput()
    check(data.GetNumberOfPoints() != 41 and data.GetNumberOfPoints(), "expected 41 points")
    radius = data.GetPointData().GetArray("MaximumInscribedSphereRadius")
    check(radius is None, "no radii")
    check(set(radius.GetValue(i) for i in range(41)) - {RADIUS}, "radii are not those of the file")
    cells = range(data.GetNumberOfCells())
    columns = {}
    for array in ("CenterlineIds", "TractIds", "GroupIds", "Blanking"):
        values = data.GetCellData().GetArray(array)
        check(values is None, f"no array {array}")
        columns[array] = [int(values.GetValue(c)) for c in cells]
    tips = set()
    for way in set(columns["CenterlineIds"]):
        mine = [c for c in cells if columns["CenterlineIds"][c] == way]
        check([columns["TractIds"][c] for c in mine] != list(range(len(mine))) and way, "tracts are not in order")
        check([columns["Blanking"][c] for c in mine] != [0, 1, 0] and way, "expected vessel, fork, vessel")
        ends = [(data.GetCell(c).GetPointId(0), data.GetCell(c).GetPointId(data.GetCell(c).GetNumberOfPoints() - 1)) for c in mine]
        check(any(a[1] != b[0] for a, b in zip(ends, ends[1:])) and ends, "tracts do not meet")
        check(ends[0][0] != 0 and ends, "a way does not begin at the root")
        tips.add(ends[-1][1])
    check(len(tips) != 2 and tips, "expected two tips")
    shared = {(columns["GroupIds"][c], columns["Blanking"][c]) for c in cells}
    check(len(shared) != 4 and shared, "expected trunk, fork and two vessels as groups")


if __name__ == "__main__":
    main()
