#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens the volume meshes that lumen makes with VTK, and runs their polyMesh in OpenFOAM.

check_volume_mesh.py LUMEN [--flow] [CASE...]

Cells of a tube, of a fork and of two vessels that touch, and of CASEs, have positive volumes by VTK, fill the surface, and have named ends. checkMesh
passes. With --flow, simpleFoam's pressure along a straight tube falls as Poiseuille's law states, to 1 %. Exit status: 0 all held, 1 something did
not, 77 lumen-netgen or Python's VTK is not there."""
import json, math, os, pathlib, re, shutil, subprocess, sys, tempfile
from flow_cases import *

try:
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLPolyDataReader
    from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter, vtkMeshQuality
    from vtkmodules.util.numpy_support import vtk_to_numpy
    import numpy
except ImportError: numpy = None

VISCOSITY = 4e-3  # Pa s
WEDGE, TETRA, TRIANGLE, QUAD = 13, 10, 5, 9


def grid_of(file):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def corners_by_type(grid):
    """The corners of all cells of each type, and the numbers of these cells."""
    types = vtk_to_numpy(grid.GetCellTypesArray())
    offsets, connectivity = (vtk_to_numpy(a) for a in (grid.GetCells().GetOffsetsArray(), grid.GetCells().GetConnectivityArray()))
    found = {}
    for kind, size in ((WEDGE, 6), (TETRA, 4), (TRIANGLE, 3), (QUAD, 4)):
        cells = numpy.flatnonzero(types == kind)
        found[kind] = connectivity[offsets[cells][:, None] + numpy.arange(size)], cells
    return found


def check_grid(name, file, answer):
    """Volumes, faces and names in the VTU."""
    grid = grid_of(file)
    place, cells = vtk_to_numpy(grid.GetPoints().GetData()), corners_by_type(grid)
    face = vtk_to_numpy(grid.GetCellData().GetArray("ModelFaceID"))
    facts = answer["volume_mesh"]
    expect(len(cells[WEDGE][0]) == facts["prisms"] and len(cells[TETRA][0]) == facts["tetrahedra"], f"{name}: cells are as the answer states")
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volume = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
    inside = numpy.concatenate([cells[WEDGE][1], cells[TETRA][1]])
    expect((volume[inside] > 0).all(), f"{name}: volumes by VTK are positive, the least is {volume[inside].min()}")
    # VTK cuts the bent side of a prism along another diagonal than that of its neighbour
    near(volume[inside].sum(), facts["surface_volume_mm3"], 1e-3, f"{name}: the cells fill the surface, mm^3")
    names = [grid.GetFieldData().GetAbstractArray("GroupNames").GetValue(k) for k in range(grid.GetFieldData().GetAbstractArray("GroupNames").GetNumberOfValues())]
    boundary = numpy.concatenate([cells[TRIANGLE][1], cells[QUAD][1]])
    expect((face[inside] == 0).all() and (face[boundary] > 0).all() and set(face[boundary]) == set(range(1, len(names) + 1)), f"{name}: each face of the boundary has the number of a name")
    # each triangle lies between two cells, or is one of the boundary
    t, w = cells[TETRA][0], cells[WEDGE][0]
    threes = numpy.sort(numpy.concatenate([t[:, c] for c in ([0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3])] + [w[:, c] for c in ([0, 1, 2], [3, 4, 5])] + [cells[TRIANGLE][0]]), axis=1)
    expect((numpy.unique(threes, axis=0, return_counts=True)[1] == 2).all(), f"{name}: triangles lie between two cells")
    if len(w):
        fours = numpy.sort(numpy.concatenate([w[:, c] for c in ([0, 1, 3, 4], [1, 2, 4, 5], [0, 2, 3, 5])] + [cells[QUAD][0]]), axis=1)
        expect((numpy.unique(fours, axis=0, return_counts=True)[1] == 2).all(), f"{name}: quadrilaterals lie between two cells")
    print(f"{name}: {facts['prisms']} prisms, {facts['tetrahedra']} tetrahedra, least quality {facts['least_quality']:.3f}, layers full at {100 * facts['full_layers']:.1f} % of the wall, least {100 * facts['least_layers']:.1f} %")
    return names


def run(folder, *words):
    env = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
    return subprocess.run(["nice", *words], cwd=folder, capture_output=True, text=True, env=env)


def check_foam(name, folder, names):
    """OpenFOAM's own check of the polyMesh."""
    done = run(folder, "checkMesh")
    (folder / "log.check").write_text(done.stdout)
    expect("Mesh OK." in done.stdout, f"{name}: checkMesh: {done.stdout[-3000:]}")
    found = re.findall(r"^    (\w\S*)\n    \{", (folder / "constant" / "polyMesh" / "boundary").read_text(), re.M)
    expect(len(found) == len(names), f"{name}: patches {found} are {names}")
    for fact in ("Max non-orthogonality|non-orthogonality Max", "Max skewness", "Max aspect ratio"):
        print(f"{name}:", *re.findall(rf".*(?:{fact}).*", done.stdout))


def check_case(name, program, folder, case, *options):
    done = lumen(program, folder, "convert", case, f"{name}.vtu", "--json", "--quiet", *options)
    names = check_grid(name, folder / f"{name}.vtu", json.loads(done.stdout))
    if not shutil.which("checkMesh"): return
    lumen(program, folder, "export", "openfoam", case, name, "--cells", "prisms", "--quiet", *options)
    check_foam(name, folder / name, names)


def tube_file(file, length, radius):
    rows = [f"{k + 1} 2 0 0 {z} {radius} {k if k else -1}" for k, z in enumerate(numpy.arange(0, length + 0.5, 1.0))]
    file.write_text("\n".join(rows) + "\n")


def check_flow(program, folder):
    """The fall of pressure along a straight tube, from its wall, beside Poiseuille's."""
    flow, case = 0.25, folder / "flow"  # ml/s: a Reynolds number of 21
    tube_file(folder / "long.swc", 40, 2)
    lumen(program, folder, "convert", "long.swc", "long.lumen", "--quiet")
    label = json.loads(lumen(program, folder, "info", "long.lumen", "--json", "--quiet").stdout)["branches"][0]["label"]
    size = ["--edge", "0.15r", "--layers", "6", "--growth", "1.2"]
    filled = json.loads(lumen(program, folder, "convert", "long.lumen", "long.vtu", "--json", "--quiet", *size).stdout)["volume_mesh"]["volume_mm3"]
    lumen(program, folder, "export", "openfoam", "long.lumen", "flow", "--cells", "prisms", "--inlets", f"{label}={flow}", "--quiet", *size)
    done = run(case, "./Allrun")
    expect(done.returncode == 0 and "converged in" in done.stdout, f"flow: {done.stdout} {done.stderr}")
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(next(case.glob("wall-*.vtp"))))
    reader.Update()
    table = reader.GetOutput()
    place, triangles = vtk_to_numpy(table.GetPoints().GetData()), vtk_to_numpy(table.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    middle = place[triangles].mean(axis=1)
    pressure = vtk_to_numpy(table.GetCellData().GetArray("pressure_Pa"))
    stress = numpy.linalg.norm(vtk_to_numpy(table.GetCellData().GetArray("wall_shear_stress_Pa")), axis=1)
    away = numpy.hypot(middle[:, 0], middle[:, 1])
    inner = (middle[:, 2] > 12) & (middle[:, 2] < 32) & (away > 1.5)
    fall = -numpy.polyfit(1e-3 * middle[inner, 2], pressure[inner], 1)[0]
    # triangles cut corners off the circle, so its radius is that of a cylinder with the volume of the cells
    radius = 1e-3 * math.sqrt(filled / (math.pi * numpy.ptp(place[:, 2])))
    law, wall = 8 * VISCOSITY * 1e-6 * flow / (math.pi * radius ** 4), 4 * VISCOSITY * 1e-6 * flow / (math.pi * radius ** 3)
    print(f"flow: pressure falls {fall / law:.4f} times as Poiseuille's law states, stress at the wall {stress[inner].mean() / wall:.4f}, radius {1e3 * radius:.4f} mm")
    near(fall, law, 0.01, "flow: fall of the pressure, Pa/m")


def check(program, folder, cases, flows):
    tube_file(folder / "tube.swc", 20, 2)
    lumen(program, folder, "convert", "tube.swc", "tube.lumen", "--quiet")
    check_case("tube", program, folder, "tube.lumen", "--layers", "4", "--growth", "1.4")
    for design in ("bifurcation", "kissing"):
        lumen(program, folder, "phantom", design, f"{design}.nrrd", "--size", "64", "--seeds", f"{design}.json", "--quiet")
        lumen(program, folder, "convert", f"{design}.nrrd", f"{design}.lumen", "--seeds", f"{design}.json", "--seeds-only", "--quiet")
        check_case(design, program, folder, f"{design}.lumen")
    check_case("extended", program, folder, "bifurcation.lumen", "--extend", "3r")
    check_case("bare", program, folder, "bifurcation.lumen", "--layers", "0")
    for k, case in enumerate(cases): check_case(f"case{k}", program, folder, str(pathlib.Path(case).resolve()))
    if flows and shutil.which("simpleFoam"): check_flow(program, folder)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    if numpy is None: skip("Python's VTK (python3-vtk9) or NumPy is not installed")
    if not (program.parent / "lumen-netgen").exists() and not shutil.which("lumen-netgen"): skip("lumen-netgen is not there")
    if not shutil.which("checkMesh"): print("OpenFOAM is not installed: polyMesh is not tested")
    words = sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder: check(str(program), pathlib.Path(folder), [w for w in words if w != "--flow"], "--flow" in words)
    return 1 if failures else 0


if __name__ == "__main__": sys.exit(main())
