#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the table that Allrun of `lumen export openfoam` leaves: pressure on the left, wall shear stress on the right.

draw_wall.py wall-TIME.vtp OUT.png        (Debian: python3-vtk9)"""
import sys
import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy


def broadest(mesh):
    """The direction from which a surface looks broadest, and the one that is up then: its axes of inertia. The
    first points to the front of the patient (LPS: -y), and up to the head, or to the left where the surface lies flat."""
    _, axes = numpy.linalg.eigh(numpy.cov(vtk_to_numpy(mesh.GetPoints().GetData()).T))
    to_eye, up = axes[:, 0], axes[:, 2]
    if abs(axes[2, 1]) > abs(up[2]): up = axes[:, 1]
    return to_eye * (-1 if to_eye[1] > 0 else 1), up * (-1 if up[2] < 0 else 1)


def actor(mesh, array, title, most):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(mesh)
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray(array)
    table = vtk.vtkLookupTable()
    table.SetHueRange(0.667, 0)
    if mesh.GetCellData().GetArray(array).GetNumberOfComponents() > 1: table.SetVectorModeToMagnitude()
    table.Build()
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(*most)
    one, bar = vtk.vtkActor(), vtk.vtkScalarBarActor()
    one.SetMapper(mapper)
    bar.SetLookupTable(table)
    bar.SetTitle(title)
    bar.SetNumberOfLabels(4)
    bar.SetLabelFormat("%-#.3g")
    bar.SetMaximumWidthInPixels(60)
    bar.SetPosition(0.84, 0.1)
    bar.SetVerticalTitleSeparation(12)
    bar.UnconstrainedFontSizeOn()
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0, 0, 0)
        text.SetFontSize(15)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
    return one, bar


def bounds(mesh, array, share):
    """From the least to a quantile of the magnitudes, so that a few triangles do not decide the colours."""
    values = mesh.GetCellData().GetArray(array)
    sizes = sorted(sum(values.GetComponent(i, c) ** 2 for c in range(values.GetNumberOfComponents())) ** 0.5 if values.GetNumberOfComponents() > 1
                   else values.GetValue(i) for i in range(values.GetNumberOfTuples()))
    return sizes[0], sizes[min(len(sizes) - 1, int(share * len(sizes)))]


def main(source, out):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(source)
    reader.Update()
    mesh = reader.GetOutput()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(1400, 620)
    camera = None
    for k, (array, title, share) in enumerate((("pressure_Pa", "pressure, Pa", 1), ("wall_shear_stress_Pa", "stress, Pa", 0.98))):
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(0.5 * k, 0, 0.5 * k + 0.5, 1)
        for part in actor(mesh, array, title, bounds(mesh, array, share)): renderer.AddViewProp(part)
        camera = camera or renderer.GetActiveCamera()
        renderer.SetActiveCamera(camera)
        if k == 0:
            to_eye, up = broadest(mesh)
            camera.SetPosition(*to_eye)
            camera.SetFocalPoint(0, 0, 0)
            camera.SetViewUp(*up)
            renderer.ResetCamera()
            camera.Zoom(1.05)
        window.AddRenderer(renderer)
    window.Render()
    picture = vtk.vtkWindowToImageFilter()
    picture.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetInputConnection(picture.GetOutputPort())
    writer.SetFileName(out)
    writer.Write()


if __name__ == "__main__": sys.exit(main(*sys.argv[1:3]) if len(sys.argv) == 3 else __doc__)
