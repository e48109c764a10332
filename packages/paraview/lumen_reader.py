# SPDX-License-Identifier: Apache-2.0
"""Cases of lumen in ParaView: Tools, Manage Plugins, Load New, this file. Needs the program lumen on the path, or its place in the
environment variable LUMEN.

Three outputs: the centerline (lines with the radius, the branch and the course of each node), the closed surface (with its parts), and
the ends of vessels (points with the direction out of the vessel and the radius). Lengths are mm, axes are LPS."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile

from paraview.util.vtkAlgorithm import VTKPythonAlgorithmBase, smdomain, smhint, smproperty, smproxy
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkFloatArray, vtkIntArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

# Variables by which ParaView finds its own libraries and Python. Another program would load them, too.
FOREIGN = ("LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "PYTHONHOME", "PYTHONPATH", "LD_PRELOAD")


def run_lumen(*arguments):
    """Raises RuntimeError with lumen's message."""
    found = os.environ.get("LUMEN") or shutil.which("lumen")
    if not found: raise RuntimeError("The program lumen is not on the path; the environment variable LUMEN may state its place")
    environment = {name: value for name, value in os.environ.items() if name not in FOREIGN}
    done = subprocess.run([found, *map(str, arguments), "--quiet"], capture_output=True, text=True, env=environment)
    if done.returncode != 0: raise RuntimeError(done.stderr.strip().removeprefix("lumen: error: ") or f"lumen ended with {done.returncode}")


def add_array(data, kind, name, values, components=1):
    array = kind()
    array.SetName(name)
    if components > 1: array.SetNumberOfComponents(components)
    for value in values:
        if components > 1: array.InsertNextTuple(value)
        else: array.InsertNextValue(value)
    data.AddArray(array)


def points_of(positions):
    points = vtkPoints()
    for position in positions: points.InsertNextPoint(position)
    return points


def root_distances(tree):
    """mm along the tree; an edge to a branch's first node counts from the parent's ball on, as in `lumen info`."""
    distance, firsts = [], {branch["firstNode"] for branch in tree["branches"]}
    for node, parent in enumerate(tree["parent"]):
        edge = math.dist(tree["centre"][node], tree["centre"][parent]) if parent >= 0 else 0
        if node in firsts and parent >= 0: edge = max(0, edge - tree["radius"][parent])
        distance.append(edge + (distance[parent] if parent >= 0 else 0))
    return distance


def centerline(tree):
    """A line for each branch, from the node that it leaves its parent at; and one for each link of a loop."""
    data, lines, labels, numbers = vtkPolyData(), vtkCellArray(), [], []
    data.SetPoints(points_of(tree["centre"]))
    courses = [(branch["label"], index, ([branch["parentNode"]] if branch["parentNode"] >= 0 else [])
                + list(range(branch["firstNode"], branch["firstNode"] + branch["nodeCount"])))
               for index, branch in enumerate(tree["branches"])]
    courses += [("link", -1, link) for link in tree.get("links", [])]
    for label, index, nodes in courses:
        if len(nodes) < 2: continue
        lines.InsertNextCell(len(nodes))
        for node in nodes: lines.InsertCellPoint(node)
        labels.append(label)
        numbers.append(index)
    data.SetLines(lines)
    of_points, of_cells = data.GetPointData(), data.GetCellData()
    add_array(of_points, vtkFloatArray, "Radius", tree["radius"])
    add_array(of_points, vtkIntArray, "Branch", tree["branch"])
    add_array(of_points, vtkFloatArray, "Direction", tree["direction"], 3)
    add_array(of_points, vtkDoubleArray, "RootDistance", root_distances(tree))
    if "inlierRate" in tree: add_array(of_points, vtkFloatArray, "InlierRate", tree["inlierRate"])
    add_array(of_cells, vtkIntArray, "Branch", numbers)
    add_array(of_cells, vtkStringArray, "Label", labels)
    return data


def ends(tree):
    """A point for each free begin and end of a vessel."""
    parents, linked = set(tree["parent"]), {node for link in tree.get("links", []) for node in link}
    found = []
    for branch in tree["branches"]:
        first, last = branch["firstNode"], branch["firstNode"] + branch["nodeCount"] - 1
        if branch["parentNode"] < 0 and first not in linked: found.append((first, -1, branch["label"]))
        if last not in parents and last not in linked: found.append((last, 1, branch["label"]))
    data, cells = vtkPolyData(), vtkCellArray()
    data.SetPoints(points_of(tree["centre"][node] for node, _, _ in found))
    for i in range(len(found)):
        cells.InsertNextCell(1)
        cells.InsertCellPoint(i)
    data.SetVerts(cells)
    of = data.GetPointData()
    add_array(of, vtkStringArray, "Label", [label for _, _, label in found])
    add_array(of, vtkFloatArray, "Radius", [tree["radius"][node] for node, _, _ in found])
    add_array(of, vtkFloatArray, "Outwards", [[way * x for x in tree["direction"][node]] for node, way, _ in found], 3)
    return data


def read_vtp(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


@smproxy.reader(name="LumenCase", label="Lumen Case", extensions="lumen lumen.json", file_description="Cases of lumen",
                support_reload=False)
class LumenCaseReader(VTKPythonAlgorithmBase):
    """Reads a case anew when its file, or an option, has changed."""

    def __init__(self):
        VTKPythonAlgorithmBase.__init__(self, nInputPorts=0, nOutputPorts=3, outputType="vtkPolyData")
        self._file, self._edge, self._surface = None, "0.5r", True

    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="lumen lumen.json", file_description="Cases of lumen")
    def SetFileName(self, name):
        if self._file == name: return
        self._file = name
        self.Modified()

    @smproperty.intvector(name="Surface", default_values=1)
    @smdomain.xml('<BooleanDomain name="bool"/><Documentation>Make the closed surface, too.</Documentation>')
    def SetSurface(self, on):
        if self._surface == bool(on): return
        self._surface = bool(on)
        self.Modified()

    @smproperty.stringvector(name="EdgeLength", default_values="0.5r")
    @smdomain.xml("<Documentation>Length of the surface's edges: in mm, such as 0.5, or as a share of the radius, such as 0.5r.</Documentation>")
    def SetEdgeLength(self, length):
        if self._edge == length: return
        self._edge = length
        self.Modified()

    def RequestData(self, request, inputs, outputs):
        if not self._file: raise RuntimeError("No file is chosen")
        with tempfile.TemporaryDirectory(prefix="lumen-") as name:
            folder = pathlib.Path(name)
            text = folder / "case.lumen.json"
            run_lumen("convert", self._file, text)
            case = json.loads(text.read_text())
            parts = [centerline(case["tree"]), vtkPolyData(), ends(case["tree"])]
            if self._surface and "models" in case:
                run_lumen("convert", self._file, folder / "wall.vtp", "--edge", self._edge)
                parts[1] = read_vtp(folder / "wall.vtp")
        for port, part in enumerate(parts): vtkPolyData.GetData(outputs, port).ShallowCopy(part)
        return 1
