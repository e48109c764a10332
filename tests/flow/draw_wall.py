#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the table that Allrun of `lumen export openfoam` leaves: pressure on the left, wall shear stress on the right.

draw_wall.py wall-TIME.vtp OUT.png        (Debian: python3-vtk9)"""
import sys
import vtk


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
    bar.SetMaximumWidthInPixels(70)
    bar.SetPosition(0.88, 0.1)
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0, 0, 0)
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
        if k == 0:  # seen from in front of the patient: LPS, so from -y
            camera.SetPosition(0, -1, 0)
            camera.SetFocalPoint(0, 0, 0)
            camera.SetViewUp(0, 0, 1)
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
