#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The closed surface of a case beside marching cubes over a field that is sampled everywhere.

  marching_cubes.py LUMEN FOLDER CASE [CASE ...]

Runs in an environment with the packages of marching_cubes.txt: python3 -m venv ENV && ENV/bin/pip install --require-hashes -r
marching_cubes.txt && ENV/bin/python marching_cubes.py ... For each case:

  lumen          `lumen convert CASE OUT.stl`
  models         the greatest of the nodes' own models, f - T, at every point of a lattice: the case's walls without its
                 tree; then vtkFlyingEdges3D
  nets           the same samples, inside or outside; then vtkSurfaceNets3D, with its own smoothing
  polyballs      the spheres of the centerline, min |p - c(t)|^2 - r(t)^2 over its segments, as VMTK's vtkvmtkPolyBallLine
                 has it (L. Antiga, vtkVmtk/ComputationalGeometry/vtkvmtkPolyBallLine.cxx: the place t on a segment is that
                 of the least power, with radii linear in t); then vtkMarchingCubes, as vmtkcenterlinemodeller has it

Each of them is given as it is, and once more by `+ quadrics` with as few triangles as vtkQuadricDecimation leaves while no vertex of every sixteenth is farther
from them than a tenth of a voxel, which is the least error that lumen allows by default; the time is that of one decimation.

Lattices have an edge of a quarter of the least radius, as nothing else keeps the thinnest vessel whole, and of half a voxel.
Samples are taken only near a node or segment (within 1.6 radii); a program that asks everywhere, as VMTK's does, takes longer.
Each runs in a process of its own. Seconds are of wall and of processor, memory is the peak of the process; parts and handles
are those of the surface, beside those of the case's graph; crossings are pairs of triangles that pass through each other. Prints Markdown.
"""
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

MOST = 400_000_000  # samples: 1.6 GB
STEPS = 6  # of the bisection: reductions to within a sixtieth
SAMPLED = 16


def read(lumen, case):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([lumen, "convert", case, f"{folder}/c.lumen.json", "--quiet"], check=True)
        return json.loads(Path(f"{folder}/c.lumen.json").read_text())


class Lattice:
    """Values at the points of a lattice around a case, at first all outside."""

    def __init__(self, centres, radii, edge):
        import numpy as np
        self.edge, self.origin = edge, (centres - 2 * radii[:, None]).min(0)
        self.size = np.ceil(((centres + 2 * radii[:, None]).max(0) - self.origin) / edge).astype(int) + 1
        if self.size.astype(float).prod() > MOST:
            sys.exit(f"{self.size.astype(float).prod() * 4 / 1e9:.1f} GB")
        self.value = np.full(self.size[::-1], -1.0, np.float32)

    def near(self, low, high):
        """The part of the values within a box, and the coordinates of its points."""
        import numpy as np
        first = np.maximum(np.floor((low - self.origin) / self.edge).astype(int), 0)
        last = np.minimum(np.ceil((high - self.origin) / self.edge).astype(int) + 1, self.size)
        x, y, z = (self.origin[a] + self.edge * np.arange(first[a], last[a]) for a in range(3))
        part = self.value[first[2]:last[2], first[1]:last[1], first[0]:last[0]]
        return part, x[None, None, :], y[None, :, None], z[:, None, None]


def sample_models(case, edge):
    import numpy as np
    tree, models = case["tree"], case["models"]
    centres, radii = np.array(tree["centre"], float), np.array(tree["radius"], float)
    lattice, offset = Lattice(centres, radii, edge), models["offset"]
    blobs, widths = np.array(models["centre"], float).reshape(-1, 3), np.array(models["width"], float)
    assert models["kernel"] == "cauchy"
    for node in range(len(radii)):
        part, x, y, z = lattice.near(centres[node] - 1.6 * radii[node], centres[node] + 1.6 * radii[node])
        # a node's model stands for its own stretch: beyond 1.6 radii others do, and within the ball only itself is asked
        ball = (x - centres[node, 0])**2 + (y - centres[node, 1])**2 + (z - centres[node, 2])**2 < (1.6 * radii[node])**2
        f = np.full(part.shape, -models["isoLevel"])
        for j in range(offset[node], offset[node + 1]):
            u = ((x - blobs[j, 0])**2 + (y - blobs[j, 1])**2 + (z - blobs[j, 2])**2) * (models["kernelParameter"] / widths[j]**2)
            f += widths[j] / (1 + u)**2
        np.copyto(part, np.maximum(part, f), where=ball, casting="same_kind")
    return lattice


def sample_polyballs(case, edge):
    import numpy as np
    tree = case["tree"]
    centres, radii = np.array(tree["centre"], float), np.array(tree["radius"], float)
    lattice = Lattice(centres, radii, edge)
    for node, parent in enumerate(tree["parent"]):
        other = parent if parent >= 0 else node
        a, b, ra, rb = centres[other], centres[node], radii[other], radii[node]
        reach = 1.6 * max(ra, rb)
        part, x, y, z = lattice.near(np.minimum(a, b) - reach, np.maximum(a, b) + reach)
        d, dr = b - a, rb - ra
        squared = d @ d - dr * dr
        if squared > 0:
            t = np.clip(((x - a[0]) * d[0] + (y - a[1]) * d[1] + (z - a[2]) * d[2] + ra * dr) / squared, 0, 1)
        else:
            t = 0.0
        power = (x - a[0] - t * d[0])**2 + (y - a[1] - t * d[1])**2 + (z - a[2] - t * d[2])**2 - (ra + t * dr)**2
        np.maximum(part, -power, out=part, casting="same_kind")
    return lattice


def extract(lattice, name):
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk
    image = vtk.vtkImageData()
    image.SetDimensions(*map(int, lattice.size))
    image.SetSpacing(lattice.edge, lattice.edge, lattice.edge)
    image.SetOrigin(*lattice.origin)
    image.GetPointData().SetScalars(numpy_to_vtk(lattice.value.ravel(), deep=False))
    if name == "nets":
        image.GetPointData().SetScalars(numpy_to_vtk((lattice.value.ravel() > 0).astype("uint8"), deep=True))
        nets = vtk.vtkSurfaceNets3D()
        nets.SetInputData(image)
        nets.SetValue(0, 1)
        nets.SetOutputMeshTypeToTriangles()
        nets.Update()
        return nets.GetOutput()
    cubes = vtk.vtkFlyingEdges3D() if name == "models" else vtk.vtkMarchingCubes()
    cubes.SetInputData(image)
    cubes.SetValue(0, 0.0)
    cubes.ComputeNormalsOff()
    if name == "models":
        cubes.ComputeGradientsOff()
    cubes.Update()
    return cubes.GetOutput()


def greatest_distance(surface, few):
    """From every SAMPLED-th vertex of one surface to another one, mm."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    to, distance = vtk.vtkImplicitPolyDataDistance(), vtk.vtkDoubleArray()
    to.SetInput(few)
    to.FunctionValue(numpy_to_vtk(vtk_to_numpy(surface.GetPoints().GetData())[::SAMPLED], deep=True), distance)
    return abs(vtk_to_numpy(distance)).max()


def simplified(surface, error):
    """The fewest triangles within `error`, mm, by bisection, and the seconds of the last decimation."""
    import vtk
    low, high, best, seconds = 0.0, 1.0, surface, [0.0, 0.0]
    for _ in range(STEPS):
        begin, processor = time.monotonic(), time.process_time()
        decimation = vtk.vtkQuadricDecimation()
        decimation.SetInputData(surface)
        decimation.SetTargetReduction((low + high) / 2)
        decimation.Update()
        now = [time.monotonic() - begin, time.process_time() - processor]
        if greatest_distance(surface, decimation.GetOutput()) > error:
            high = (low + high) / 2
            continue
        low, best, seconds = (low + high) / 2, decimation.GetOutput(), now
    return best, seconds


def one(name, lumen, case, edge, out):
    import vtk
    value = read(lumen, case)
    begin, processor = time.monotonic(), time.process_time()
    way, _, ending = name.partition(" + ")
    surface = extract((sample_polyballs if way == "polyballs" else sample_models)(value, edge), way)
    seconds = [time.monotonic() - begin, time.process_time() - processor]
    if ending:
        surface, more = simplified(surface, 0.1 * (value["metadata"].get("voxelSize") or edge))
        seconds = [a + b for a, b in zip(seconds, more)]
    writer = vtk.vtkSTLWriter()
    writer.SetFileName(out)
    writer.SetFileTypeToBinary()
    writer.SetInputData(surface)
    writer.Write()
    print(json.dumps({"seconds": seconds, "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))


def timed(*words):
    """Seconds and the peak of memory of a program that is run now."""
    begin = time.monotonic()
    child = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"marching_cubes.py: {' '.join(map(str, words))} failed")
    return {"seconds": [time.monotonic() - begin, usage.ru_utime + usage.ru_stime], "memory": usage.ru_maxrss / 1024}


def row(lumen, case, name, edge, out, result):
    info = json.loads(subprocess.run([lumen, "info", out, "--json", "--quiet"], capture_output=True, text=True, check=True).stdout)
    known = [part for part in info["components"] if part["genus"] is not None]
    handles = str(sum(part["genus"] for part in known)) + ("" if len(known) == len(info["components"]) else " and more")
    return (f"| {Path(case).stem} | {name} | {edge} | {result['seconds'][0]:.1f} | {result['seconds'][1]:.1f} | {result['memory']:.0f} | "
            f"{info['triangles']:,} | {'yes' if info['closed'] and info['manifold'] else 'no'} | {len(info['components'])} | {handles} | {info['self_intersections']} | "
            f"{info['volume_mm3']:.1f} |")


def main():
    if len(sys.argv) == 7 and sys.argv[1] == "--one":
        return one(sys.argv[2], sys.argv[3], sys.argv[4], float(sys.argv[5]), sys.argv[6])
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    lumen, folder = sys.argv[1], Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    print("| case | way | lattice, mm | s | processor s | MB | triangles | closed manifold | parts | handles | crossings | volume, mm³ |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for case in sys.argv[3:]:
        out = folder / f"{Path(case).stem}.stl"
        print(row(lumen, case, "lumen", "-", out, timed(lumen, "convert", case, out)), flush=True)
        value = read(lumen, case)
        least, voxel = min(value["tree"]["radius"]) / 4, value["metadata"].get("voxelSize")
        for edge in [least] + ([voxel / 2] if voxel else []):
            for name in (way + ending for way in ("models", "nets", "polyballs") for ending in ("", " + quadrics")):
                done = subprocess.run([sys.executable, __file__, "--one", name, lumen, case, str(edge), out], capture_output=True,
                                      text=True, check=False)
                if done.returncode != 0:
                    print(f"| {Path(case).stem} | {name} | {edge:.3f} | | | not run: {done.stderr.strip().splitlines()[-1]} | | | | | | |")
                    continue
                print(row(lumen, case, name, f"{edge:.3f}", out, json.loads(done.stdout)), flush=True)
    return None


if __name__ == "__main__":
    main()
