#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tree that another program finds in a map of labels, or in a volume from the map, as SWC. Started by peers.py.

  peer_trees.py PEER MAP VOLUME OUT.swc (of TubeTK: OUT.tre)

Vessels are voxels of the label 1. Each program runs with the values of its own documentation; where lengths must be chosen, they are those
of a voxel, as stated beside them. Needs the packages of peers.txt.
"""
import sys

import numpy
import SimpleITK


def voxels_of(file):
    """Vessel or not for each voxel, as x, y, z; spacing; origin."""
    image = SimpleITK.ReadImage(file)
    return SimpleITK.GetArrayFromImage(image).transpose(2, 1, 0) == 1, numpy.array(image.GetSpacing()), numpy.array(image.GetOrigin())


def write_swc(file, points, radii, edges):
    """Graphs may have loops: edges that lead back to a node are left out, but for their last step, which is drawn to a node of its own."""
    near = [[] for _ in points]
    for a, b in edges:
        near[a].append(b)
        near[b].append(a)
    number, rows = {}, []

    def add(node, parent):
        rows.append((*points[node], max(float(radii[node]), 1e-3), parent))
        return len(rows)

    for root in sorted(range(len(points)), key=lambda node: len(near[node]) != 1):
        if root in number or not near[root]: continue
        number[root] = add(root, -1)
        waiting = [(root, -1)]
        while waiting:
            node, before = waiting.pop()
            for other in near[node]:
                if other == before: continue
                if other not in number:
                    number[other] = add(other, number[node])
                    waiting.append((other, node))
                elif other < node: add(other, number[node])
    with open(file, "w", encoding="ascii") as out:
        for k, (x, y, z, radius, parent) in enumerate(rows): out.write(f"{k + 1} 0 {x:.4f} {y:.4f} {z:.4f} {radius:.4f} {parent}\n")


def kimimaro(labels, _, out):
    """TEASAR. `const` is a voxel's edge in place of 300 nm of a neuron, and no soma is looked for."""
    from kimimaro import skeletonize
    vessel, spacing, origin = voxels_of(labels)
    parts = skeletonize(vessel.astype(numpy.uint8), anisotropy=tuple(spacing), dust_threshold=0, parallel=1, progress=False,
                        teasar_params={"scale": 1.5, "const": float(spacing.max()), "soma_detection_threshold": numpy.inf})
    part = parts.get(1)
    write_swc(out, part.vertices + origin, part.radii, part.edges)


def skan(labels, _, out):
    """Thinning by scikit-image, paths by skan, radii by the distance to the nearest voxel outside, as its tutorial has them."""
    from scipy.ndimage import distance_transform_edt
    from skan import Skeleton
    from skimage.morphology import skeletonize
    vessel, spacing, origin = voxels_of(labels)
    paths = Skeleton(skeletonize(vessel), spacing=tuple(spacing))
    cells = numpy.rint(paths.coordinates).astype(int)
    radii = distance_transform_edt(vessel, sampling=spacing)[tuple(cells.T)]
    edges = {(min(a, b), max(a, b)) for k in range(paths.n_paths) for path in [paths.path(k)] for a, b in zip(path, path[1:])}
    write_swc(out, cells * spacing + origin, radii, sorted(edges))


def network_of(surface, out):
    """VMTK's network extraction, which begins at an opening: each part of the surface is opened at the place that is farthest from its middle."""
    import vtk
    from vmtk import vtkvmtk
    from vtk.util.numpy_support import vtk_to_numpy
    parts = vtk.vtkPolyDataConnectivityFilter()
    parts.SetInputData(surface)
    parts.SetExtractionModeToAllRegions()
    parts.Update()
    points, radii, edges = [], [], []
    for part in range(parts.GetNumberOfExtractedRegions()):
        parts.SetExtractionModeToSpecifiedRegions()
        parts.InitializeSpecifiedRegionList()
        parts.AddSpecifiedRegion(part)
        clean = vtk.vtkCleanPolyData()
        clean.SetInputConnection(parts.GetOutputPort())
        clean.Update()
        one = vtk.vtkPolyData()
        one.DeepCopy(clean.GetOutput())
        places = vtk_to_numpy(one.GetPoints().GetData())
        end = int(numpy.argmax(numpy.linalg.norm(places - places.mean(axis=0), axis=1)))
        cells = vtk.vtkIdList()
        one.BuildLinks()
        one.GetPointCells(end, cells)
        for k in range(cells.GetNumberOfIds()): one.DeleteCell(cells.GetId(k))
        one.RemoveDeletedCells()
        network = vtkvmtk.vtkvmtkPolyDataNetworkExtraction()
        network.SetInputData(one)
        network.SetAdvancementRatio(1.05)
        network.SetRadiusArrayName("Radius")
        network.SetTopologyArrayName("Topology")
        network.SetMarksArrayName("Marks")
        network.Update()
        lines = network.GetOutput()
        if lines.GetNumberOfPoints() == 0: continue
        found, width = vtk_to_numpy(lines.GetPoints().GetData()), vtk_to_numpy(lines.GetPointData().GetArray("Radius"))
        for k in range(lines.GetNumberOfCells()):
            ids = lines.GetCell(k).GetPointIds()
            ids = numpy.array([ids.GetId(i) for i in range(ids.GetNumberOfIds())])
            known = (width[ids] > 0) & (width[ids] < 1e3)  # ends have none, and few places no bound
            if not known.any(): continue
            width[ids] = numpy.nan_to_num(numpy.interp(range(len(ids)), numpy.flatnonzero(known), width[ids][known]))
            edges += [(len(points) + a, len(points) + b) for a, b in zip(ids, ids[1:]) if a != b]
        points += list(found)
        radii += list(width)
    write_swc(out, points, radii, edges)


def triangles(image, level):
    """Marching cubes of a VTK image, with the smoothing of VMTK's tutorials (30 passes of .1)."""
    import vtk
    cubes, smooth = vtk.vtkMarchingCubes(), vtk.vtkWindowedSincPolyDataFilter()
    cubes.SetInputData(image)
    cubes.SetValue(0, level)
    smooth.SetInputConnection(cubes.GetOutputPort())
    smooth.SetNumberOfIterations(30)
    smooth.SetPassBand(0.1)
    smooth.Update()
    return smooth.GetOutput()


def vtk_image(values, spacing, origin):
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk
    image = vtk.vtkImageData()
    image.SetDimensions(values.shape)
    image.SetSpacing(spacing)
    image.SetOrigin(origin)
    image.GetPointData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(values.ravel(order="F"), dtype=numpy.float32), deep=True))
    return image


def vmtk_network(labels, _, out):
    vessel, spacing, origin = voxels_of(labels)
    network_of(triangles(vtk_image(numpy.pad(vessel, 1), spacing, origin - spacing), 0.5), out)


def vmtk_levels(labels, volume, out):
    """Geodesic active contours from the map, as VMTK's script has them: advection alone; 300 iterations, as in its tutorial."""
    from scipy.ndimage import distance_transform_edt
    from vmtk import vmtkscripts
    image, vessel, spacing, origin = SimpleITK.ReadImage(volume, SimpleITK.sitkFloat32), *voxels_of(labels)
    inside, outside = (distance_transform_edt(one, sampling=spacing) for one in (vessel, ~vessel))
    distance = SimpleITK.GetImageFromArray((outside - inside).astype(numpy.float32).transpose(2, 1, 0))
    distance.SetSpacing(spacing.tolist())
    distance.SetOrigin(origin.tolist())
    distance = SimpleITK.Resample(distance, image, SimpleITK.Transform(), SimpleITK.sitkLinear, 10.0)
    script = vmtkscripts.vmtkLevelSetSegmentation()
    script.Image, script.InitialLevelSets = (
        vtk_image(SimpleITK.GetArrayFromImage(one).transpose(2, 1, 0), image.GetSpacing(), image.GetOrigin()) for one in (image, distance))
    script.NumberOfIterations = 300
    script.Execute()
    network_of(triangles(script.LevelSets, 0.0), out)


def tubetk(labels, volume, out):
    """Ridges through each third voxel of the map's skeleton, in a volume of cubic voxels, with the values of TubeTK's notebook on head MRA."""
    import itk
    from itk import TubeTK
    from scipy.ndimage import distance_transform_edt
    from skimage.morphology import skeletonize
    vessel, spacing, origin = voxels_of(labels)
    cubic = TubeTK.ResampleImage.New(Input=itk.imread(volume, itk.F), MakeHighResIso=True)
    cubic.Update()
    tubes = TubeTK.SegmentTubes.New(Input=cubic.GetOutput())
    tubes.SetMinRoundness(0.02)
    tubes.SetMinRidgeness(0.5)
    tubes.SetMinCurvature(0.0)
    tubes.SetMinLevelness(0.0)
    tubes.SetRadiusInObjectSpace(float(cubic.GetOutput().GetSpacing()[0]))
    tubes.SetOptimizeRadius(True)
    cells = numpy.argwhere(skeletonize(vessel))[::3]
    tubes.SetSeedsInObjectSpaceList([itk.Point[itk.D, 3]((cell * spacing + origin).tolist()) for cell in cells])
    tubes.SetSeedRadiiInObjectSpaceList(distance_transform_edt(vessel, sampling=spacing)[tuple(cells.T)].tolist())
    tubes.ProcessSeeds()
    writer = itk.SpatialObjectWriter[3].New(tubes.GetTubeGroup())
    writer.SetFileName(out)
    writer.Update()


PEERS = {"kimimaro": kimimaro, "skan": skan, "vmtk-network": vmtk_network, "vmtk-levels": vmtk_levels, "tubetk": tubetk}

if __name__ == "__main__": PEERS[sys.argv[1]](*sys.argv[2:5])
