// SPDX-License-Identifier: Apache-2.0
// Triangle meshes of a case's wall.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <filesystem>
#include <string>
#include <vector>

#include "converters/common/progress.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Vertices in mm, LPS; triangles counter-clockwise seen from outside the lumen; vertex normals outward.
struct MeshTraits : OpenMesh::DefaultTraits {
  VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::None);
};
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<MeshTraits>;

struct BranchMesh {
  std::string label;
  TriMesh mesh;
};

struct PolygoniseOptions {
  double cell = 0;  ///< edge of a marching-cubes cell, mm; 0: the case's voxel size
};

/// One mesh per branch: for each node, marching cubes at the iso-level on a grid around the node, cut by
/// the radical planes to its topological neighbours (design notes section 4), the node's side kept. Vertices that
/// coincide within a branch are shared; patches of adjacent nodes meet at the radical planes only to
/// within their models' disagreement. Throws Error(InvalidInput) if the case has no models, or no voxel size
/// while `cell` is 0, and Error(Cancelled).
std::vector<BranchMesh> polygonise(const formats::Case& source, const PolygoniseOptions& options,
                                   Progress& progress);

struct WriteMeshOptions {
  bool draco = false;           ///< glTF only: KHR_draco_mesh_compression
  int dracoPositionBits = 14;   ///< quantisation of a branch's bounding box
};

/// Writes by `format`: "glb", "gltf" (with embedded buffers), "obj", "stl" (binary), "ply" (binary), atomically.
/// glTF is metres, +Y up, through the root node's matrix; the others stay in mm, LPS.
void writeMesh(const std::vector<BranchMesh>& meshes, const std::filesystem::path& file,
               const std::string& format, const WriteMeshOptions& options);

}  // namespace lumen::convert
