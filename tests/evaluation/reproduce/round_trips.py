#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How near a case's surface is to the surface that the case was made of: meshes of phantoms and of real vessels, there and back.

  round_trips.py DATA FOLDER LUMEN [NAME...]

Phantoms are made by LUMEN as centerlines with radii, and their closed surface is the source; DATA has real meshes. Each source
becomes a case, and the case a mesh (default parameters both ways). 20 000 points on either wall, evenly by area, are measured
against the other surface; flat ends are left out of both, as an end that is open in one has a face in the other. NAMEs choose
rows. Meshes stay in FOLDER, and so do round_trips.md, which is printed too, and NAME.png, both surfaces side by side, where
Xvfb or a display is (xvfb-run -a). Needs python3-vtk9 and python3-numpy.
"""
import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

POINTS = 20000
PHANTOMS = ["tube", "helix", "bifurcation", "kissing", "stenosis", "hairpin", "right-angle"]
CURVES = "neurovascular/centerlines"
NEURO = "neurovascular/vessel_architecture_collision.obj"
REAL = [("aorta", "aorta/aorta-surface.stl"), ("aorta with centerline", "aorta/aorta-surface.stl", "aorta/aorta-centerline.vtp"),
        ("aorta, open ends", "aorta/aorta-surface-open-ends.stl"),
        ("aorta in metres, a wall", "aorta-metres/AbdominalAorta.stl"),
        ("aneurysm in metres, a wall", "aorta-metres/AbdominalAorticAneurysm.stl"),
        ("neurovascular", NEURO), ("neurovascular with curves", NEURO, CURVES),
        ("thrombectomy", "neurovascular/mechanical_thrombectomy_collision_FIX_REMESH.obj")]


def run(*words):
    begin = time.monotonic()
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip().splitlines()[-1])
    return done.stdout, time.monotonic() - begin


def load(path):
    readers = {".stl": vtk.vtkSTLReader, ".obj": vtk.vtkOBJReader, ".vtp": vtk.vtkXMLPolyDataReader}
    reader = readers[path.suffix]()
    reader.SetFileName(str(path))
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(reader.GetOutputPort())
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    triangles.Update()
    return triangles.GetOutput()


def corners(mesh):
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    return points, vtk_to_numpy(mesh.GetPolys().GetData()).reshape(-1, 4)[:, 1:]


def scaled(mesh, factor):
    move = vtk.vtkTransform()
    move.Scale(factor, factor, factor)
    change = vtk.vtkTransformPolyDataFilter()
    change.SetTransform(move)
    change.SetInputData(mesh)
    change.Update()
    return change.GetOutput()


def wall_faces(mesh):
    """Which faces of a mesh of lumen are wall: those of the first group, by its field data."""
    kinds = mesh.GetFieldData().GetAbstractArray("GroupKinds")
    face = mesh.GetCellData().GetArray("ModelFaceID")
    walls = {k + 1 for k in range(kinds.GetNumberOfValues()) if kinds.GetValue(k) == "wall"}
    return np.array([int(number) in walls for number in vtk_to_numpy(face)])


def sample(mesh, wall=None):
    points, faces = corners(mesh)
    if wall is not None:
        faces = faces[wall]
    a, b, c = (points[faces[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    random = np.random.default_rng(1)
    chosen = random.choice(len(faces), POINTS, p=area / area.sum())
    u, v = random.random((2, POINTS))
    outside = u + v > 1
    u[outside], v[outside] = 1 - u[outside], 1 - v[outside]
    return a[chosen] + u[:, None] * (b - a)[chosen] + v[:, None] * (c - a)[chosen]


def away(points, mesh):
    """Distance of each point to the surface, and the face that is nearest."""
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    near, cell, part, squared = [0.0] * 3, vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
    distance, face = np.empty(len(points)), np.empty(len(points), int)
    for k, point in enumerate(points):
        locator.FindClosestPoint(point, near, cell, part, squared)
        distance[k], face[k] = squared.get() ** 0.5, cell.get()
    return distance, face


def radii_at(points, swc):
    rows = np.array([line.split() for line in swc.read_text().splitlines() if line and line[0] != "#"], float)
    centre, radius = rows[:, 2:5], rows[:, 5]
    out = np.empty(len(points))
    for k in range(0, len(points), 1000):
        out[k:k + 1000] = radius[((points[k:k + 1000, None] - centre) ** 2).sum(2).argmin(1)]
    return out


def edge_length(mesh):
    points, faces = corners(mesh)
    return np.mean([np.linalg.norm(points[faces[:, k]] - points[faces[:, k - 1]], axis=1).mean() for k in range(3)])


def scores(distance, unit):
    share = distance / unit
    return [float(np.median(share)), float(np.quantile(share, 0.99)), float(share.max())]


def picture(file, left, right):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(1200, 600)
    camera = None
    for k, mesh in enumerate((left, right)):
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(mesh)
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(0.8, 0.35, 0.3)
        view = vtk.vtkRenderer()
        view.SetViewport(k / 2, 0, (k + 1) / 2, 1)
        view.SetBackground(1, 1, 1)
        view.AddActor(actor)
        if camera:
            view.SetActiveCamera(camera)
        else:
            view.ResetCamera()
            camera = view.GetActiveCamera()
            camera.Zoom(1.4)
        window.AddRenderer(view)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(file))
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


def there_and_back(lumen, folder, name, source, centerline, factor, in_edges):
    stem = folder / name.replace(" ", "-").replace(",", "")
    case, back = stem.with_suffix(".lumen"), stem.with_suffix(".back.vtp")
    line = ["--centerline", centerline] if centerline else []
    _, seconds = run(lumen, "convert", source, case, "--json", *line)
    run(lumen, "convert", case, back, "--quiet")
    run(lumen, "convert", case, stem.with_suffix(".swc"), "--quiet")
    info = json.loads(run(lumen, "info", case, "--json")[0])
    old, new = scaled(load(source), factor), load(back)
    wall = wall_faces(new)
    there = sample(new, wall)
    distance, _ = away(there, old)
    here = sample(old, wall_faces(load(source)) if source.suffix == ".vtp" else None)
    missing, face = away(here, new)
    here, missing = here[wall[face]], missing[wall[face]]
    unit = edge_length(old) if in_edges else None
    result = scores(distance, unit or radii_at(there, stem.with_suffix(".swc")))
    result += scores(missing, unit or radii_at(here, stem.with_suffix(".swc")))
    try:
        picture(stem.with_suffix(".png"), old, new)
    except RuntimeError:
        pass
    if "wall" in name:  # most of it is the outer side, which the lumen leaves out
        result[3:] = []
    return [name, len(info["branches"])] + [f"{value:.3f}" for value in result] + ["-"] * (6 - len(result)) + [f"{seconds:.1f}"]


def table(title, rows):
    head = ["surface", "branches", "median", "99 %", "greatest", "of the source: median", "99 %", "greatest", "s"]
    lines = [f"**{title}**", "", "| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n\n"


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    data, folder, lumen, names = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3], sys.argv[4:]
    folder.mkdir(parents=True, exist_ok=True)
    phantoms, real = [], []
    for name in PHANTOMS:
        if names and name not in names:
            continue
        truth = folder / f"{name}-truth.lumen"
        run(lumen, "phantom", name, folder / f"{name}.nrrd", "--truth", truth, "--quiet")
        run(lumen, "convert", truth, folder / f"{name}-truth.swc", "--quiet")
        source = folder / f"{name}-truth.vtp"
        run(lumen, "convert", folder / f"{name}-truth.swc", source, "--quiet")
        phantoms.append(there_and_back(lumen, folder, name, source, None, 1, True))
    for name, file, *line in REAL:
        if names and name not in names:
            continue
        if not (data / file).exists():
            print(f"round_trips.py: there is no {data / file}", file=sys.stderr)
            continue
        try:
            real.append(there_and_back(lumen, folder, name, data / file, data / line[0] if line else None,
                                       1000 if "metres" in name else 1, False))
        except RuntimeError as error:
            real.append([name, str(error).replace(str(data) + "/", "")] + [""] * 7)
    text = "# Round trips\n\nA surface becomes a case, and the case a surface again, by default parameters. First the "
    text += "distance of the new wall to the source, then that of the source's wall to the new surface, each as median, 99 % "
    text += "and greatest of 20 000 points, evenly by area, without flat ends. The lumen of a wall with a "
    text += "thickness leaves out the outer side.\n\n"
    if phantoms:
        text += table("Phantoms, in the mean edge length of the source", phantoms)
    if real:
        text += table("Real surfaces, in radii of the nearest node", real)
    text = text.rstrip() + "\n"
    (folder / "round_trips.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
