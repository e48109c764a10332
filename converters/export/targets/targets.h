// SPDX-License-Identifier: Apache-2.0
// A case as a phantom of CathSim, a learning environment for guidewires on MuJoCo.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// phantom_assets/vessel.xml and, below phantom_assets/meshes/vessel, visual.stl, simplified.stl
/// and hull_N.stl: the wall in convex pieces (wall_prisms.h). Metres. Throws as lumenSurface().
ExportResult exportCathsim(const ExportInput& input);

TargetRow cathsimRow();

// A case as one GLB for an engine of games or pictures, with the names of nodes that it looks at.

/// vessels.glb: a thick wall; a node for each named end, its z axis out of the vessel. Throws as
/// wallSurface() and encodeGlbScene().
ExportResult exportGodot(const ExportInput& input);    ///< -col: a collider of its triangles
ExportResult exportUnity(const ExportInput& input);    ///< _LOD0, _LOD1, _LOD2, and MSFT_lod
ExportResult exportUnreal(const ExportInput& input);   ///< MSFT_lod
ExportResult exportBlender(const ExportInput& input);  ///< one mesh

TargetRow godotRow();
TargetRow unityRow();
TargetRow unrealRow();
TargetRow blenderRow();

// A case as the cache that NVIDIA's catheter navigation (isaac-for-healthcare) reads, and as a
// stage of USD.

/// The cache, always in mm and LPS, its arrays in the order z, y, x: metadata.json, mu_volume.npy
/// (synthetic: see isaac.cpp), vessel_mask.npy, centerline_points_mm.npy, centerline_edges.npy,
/// centerline_radii_mm.npy. vessel.usda in the folder's frame: a thick wall. Throws Error(Usage) for
/// too many samples, and as wallSurface().
ExportResult exportIsaac(const ExportInput& input);

TargetRow isaacRow();

// A case as a scene of MuJoCo 3: vessels with a solid wall, and a guidewire that an actuator pushes
// into them.

/// scene.xml, whose wire bends by the plugin mujoco.elasticity.cable; scene-joints.xml, that scene
/// for engines without plugins; meshes/wall_K.stl. Metres. The solid is all that is not lumen, or
/// with a thickness in the options a wall of it, within reach of the wire. Throws as lumenSurface()
/// and findInsertion().
ExportResult exportMujoco(const ExportInput& input);

TargetRow mujocoRow();

// A case as the input of solvers of blood flow in one dimension: svOneDSolver of SimVascular, and
// openBF.

/// Two descriptions of each tree, of one oneDNetwork(): TREE.in for svOneDSolver, in cgs, and
/// TREE.yml with TREE_inlet.dat for openBF v2, in SI. Trees are `vessels`, `vessels2`, .... Throws
/// as flowNetwork() and oneDNetwork().
ExportResult exportOneD(const ExportInput& input);

TargetRow oneDRow();

// A case as solids for 3D printers.

/// wall.stl and wall.3mf, a solid wall around the lumen that is open at the ends, and core.stl and
/// core.3mf, the lumen as a solid; mm. README.md states the least thickness of the wall and where
/// it is. Throws as lumenSurface() and wallSurface().
ExportResult exportPrint(const ExportInput& input);

TargetRow printRow();

// A case as a project of SimVascular.

/// vessels.svproj, Paths/NAME.pth and Segmentations/NAME.ctgr of each branch, with circles at its
/// nodes, about a radius apart, Models/vessel.mdl and .vtp, and, if the surface can be
/// filled with cells, mesh-complete, all in cm, LPS. Throws as lumenSurface() and branchPaths().
ExportResult exportSimVascular(const ExportInput& input);

TargetRow simVascularRow();

// A case as a scene of 3D Slicer.

/// scene.mrml, which opens the rest: vessels.vtp, centerlines/NAME.mrk.json (a Markups curve with
/// radii for each branch), seeds.mrk.json (a control point for each branch, as lumen track reads
/// it) and ends.mrk.json. All in mm and LPS, which each file states. Throws as lumenSurface().
ExportResult exportSlicer(const ExportInput& input);

TargetRow slicerRow();

// A case as the folder that stEVE, a learning environment for catheters, reads: paths and meshes as
// of SimVascular, and a Python module that makes its vessel tree with radii.

/// Paths/NAME.pth of each branch and Meshes/vessel.vtp, in centimetres, as its class VMR scales
/// them; vessel.obj and vessels.py, in mm, for its class FromMesh. Positions are LPS, as in the
/// case. The mesh of the .obj looks into the lumen, where the instruments are: stEVE does not turn
/// it. Throws as lumenSurface().
ExportResult exportSteve(const ExportInput& input);

TargetRow steveRow();

// A case as the input of svZeroDSolver, the blood flow solver of SimVascular without a dimension.

/// model.json, in cgs (cm, g, s, dyn), as the solver's own examples: a BloodVessel with R, C and L
/// for each segment of flowNetwork(), junctions that share a pressure, the mean flow of blood.h at
/// inlets, outletResistances() at outlets. Loops are junctions like others. Throws as
/// flowNetwork().
ExportResult exportSvZeroD(const ExportInput& input);

TargetRow svZeroDRow();

}  // namespace lumen::convert
