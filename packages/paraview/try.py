# SPDX-License-Identifier: Apache-2.0
"""Run by pvbatch: try.py PLUGIN CASE PICTURE. Loads the plugin, opens the case as a file of its kind, and draws its three outputs."""
import sys

from paraview.simple import (ColorBy, Glyph, LoadPlugin, OpenDataFile, OutputPort, CreateRenderView, ResetCamera, SaveScreenshot, Show,
                             Tube)

plugin, case, picture = sys.argv[1:]
LoadPlugin(plugin, ns=globals())
reader = OpenDataFile(case)  # by its ending, as File, Open does
assert reader is not None and reader.GetXMLName() == "LumenCase", reader
reader.UpdatePipeline()
for port, name in enumerate(("centerline", "surface", "ends")):
    found = OutputPort(reader, port).GetDataInformation()
    arrays = found.GetPointDataInformation()
    print(name, found.GetNumberOfPoints(), "points", found.GetNumberOfCells(), "cells",
          [arrays.GetArrayInformation(i).GetName() for i in range(arrays.GetNumberOfArrays())])
    assert found.GetNumberOfPoints() > 1, name

view = CreateRenderView(ViewSize=[900, 700], Background=[0.16, 0.18, 0.22], UseColorPaletteForBackground=0, OrientationAxesVisibility=1)
wall = Show(OutputPort(reader, 1), view)
ColorBy(wall, None)
wall.Opacity, wall.DiffuseColor = 0.3, [0.9, 0.4, 0.35]
line = Show(Tube(Input=OutputPort(reader, 0), Radius=0.12), view)
ColorBy(line, ("POINTS", "Radius"))
line.SetScalarBarVisibility(view, True)
arrows = Show(Glyph(Input=OutputPort(reader, 2), GlyphType="Arrow", OrientationArray=["POINTS", "Outwards"],
                    ScaleArray=["POINTS", "No scale array"], ScaleFactor=2, GlyphMode="All Points"), view)
arrows.DiffuseColor = [1, 0.9, 0.3]
ResetCamera(view)
at = list(view.CameraFocalPoint)
view.CameraPosition, view.CameraViewUp = [at[0] - 4, at[1] - 30, at[2] + 4], [0, 0, 1]  # from the front, head up
ResetCamera(view)
SaveScreenshot(picture, view)
print("saved", picture)
