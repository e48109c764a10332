#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs ParaView's reader of cases through VTK's pipeline. ParaView's own Python is used where it is (pvbatch), else VTK's with a
stand-in for the names that ParaView adds: Debian's ParaView and python3-vtk9 cannot be installed together.

check_paraview.py LUMEN. Ends with 77 where there is neither. packages/paraview/try.sh runs the plugin in ParaView itself."""
import importlib.util, json, math, os, pathlib, subprocess, sys, tempfile, types

PLUGIN = pathlib.Path(__file__).resolve().parents[2] / "packages/paraview/lumen_reader.py"


def stand_in():
    """paraview.util.vtkAlgorithm: decorators that leave functions as they are, and keep what they were told."""
    from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
    keep = lambda *_, **options: lambda function: setattr(function, "told", options) or function
    group = lambda *names: types.SimpleNamespace(**{name: keep for name in names})
    module = types.ModuleType("paraview.util.vtkAlgorithm")
    module.VTKPythonAlgorithmBase = VTKPythonAlgorithmBase
    module.smproxy, module.smproperty = group("reader"), group("stringvector", "intvector")
    module.smdomain, module.smhint = group("filelist", "xml"), group("filechooser")
    for name in ("paraview", "paraview.util"): sys.modules[name] = types.ModuleType(name)
    sys.modules["paraview.util.vtkAlgorithm"] = module


def load():
    spec = importlib.util.spec_from_file_location("lumen_reader", PLUGIN)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def check(holds, what):
    if not holds: raise SystemExit(f"check_paraview.py: {what}")


def outputs(reader):
    reader.Update()
    return [reader.GetOutputDataObject(port) for port in range(3)]


def check_lines(line, tree):
    check(line.GetNumberOfPoints() == len(tree["centre"]), f"{line.GetNumberOfPoints()} nodes")
    check(line.GetNumberOfLines() == len(tree["branches"]), f"{line.GetNumberOfLines()} lines")
    check(math.dist(line.GetPoint(7), tree["centre"][7]) < 1e-5, "a node lies elsewhere")
    radius, distance = (line.GetPointData().GetArray(name) for name in ("Radius", "RootDistance"))
    check(abs(radius.GetValue(7) - tree["radius"][7]) < 1e-6, "a radius is another")
    check(distance.GetValue(0) == 0 and distance.GetValue(7) > distance.GetValue(6) > 0, "distances from the root do not grow")
    labels = line.GetCellData().GetAbstractArray("Label")
    check([labels.GetValue(i) for i in range(labels.GetNumberOfValues())] == [b["label"] for b in tree["branches"]], "labels are others")


def check_surface(wall, line, volume):
    from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkMassProperties, vtkTriangleFilter
    edges = vtkFeatureEdges()
    edges.SetInputData(wall)
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    check(wall.GetNumberOfPolys() > 500 and edges.GetOutput().GetNumberOfCells() == 0, "the surface is not closed")
    triangles, mass = vtkTriangleFilter(), vtkMassProperties()
    triangles.SetInputData(wall)
    mass.SetInputConnection(triangles.GetOutputPort())
    check(abs(mass.GetVolume() / volume - 1) < 0.15, f"the surface holds {mass.GetVolume()} mm^3, the tubes {volume}")


def check_ends(ends, tree):
    check(ends.GetNumberOfPoints() == len(tree["branches"]) + 1, f"{ends.GetNumberOfPoints()} ends")
    way = ends.GetPointData().GetArray("Outwards").GetTuple(0)
    check(sum(a * b for a, b in zip(way, tree["direction"][0])) < -0.99, "the inlet does not point out of the vessel")


def main(lumen):
    try:
        import paraview.util.vtkAlgorithm  # noqa: F401
    except ImportError:
        try:
            stand_in()
        except ImportError:
            print("skipped: neither python3-paraview nor python3-vtk9 is there (apt install python3-vtk9)")
            return 77
    os.environ["LUMEN"] = lumen
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run = lambda *words: subprocess.run([lumen, *words, "--quiet"], cwd=folder, check=True, timeout=200)
        run("phantom", "bifurcation", "fork.nrrd", "--size", "48", "--seeds", "seeds.json")
        run("convert", "fork.nrrd", "fork.lumen", "--seeds", "seeds.json")
        run("convert", "fork.lumen", "fork.lumen.json")
        tree = json.loads((folder / "fork.lumen.json").read_text())["tree"]
        module = load()
        reader = module.LumenCaseReader()
        reader.SetFileName(str(folder / "fork.lumen"))
        line, wall, ends = outputs(reader)
        check_lines(line, tree)
        volume = sum(math.pi * tree["radius"][i] ** 2 * math.dist(tree["centre"][i], tree["centre"][p]) for i, p in enumerate(tree["parent"]) if p >= 0)
        check_surface(wall, line, volume)
        check_ends(ends, tree)
        fine = wall.GetNumberOfPolys()
        reader.SetEdgeLength("0.8r")
        coarse = outputs(reader)[1].GetNumberOfPolys()
        check(coarse < 0.7 * fine, f"{coarse} triangles of {fine}: the edge length changes nothing")
        reader.SetSurface(0)
        check(outputs(reader)[1].GetNumberOfPolys() == 0, "a surface is made that was switched off")
        try:
            module.run_lumen("convert", folder / "none.lumen", folder / "x.lumen.json")
            check(False, "a missing file is taken")
        except RuntimeError as error:
            check("none.lumen" in str(error), f"the message for a missing file is {error}")
    print("ParaView's reader: all held")
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 2: sys.exit(__doc__)
    sys.exit(main(str(pathlib.Path(sys.argv[1]).resolve())))
