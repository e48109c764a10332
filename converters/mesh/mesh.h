// SPDX-License-Identifier: Apache-2.0
// Triangle meshes of a case's wall.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "converters/common/progress.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Vertices in mm, LPS; triangles counter-clockwise seen from outside the lumen; vertex normals
/// outward.
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
  /// Edge of a marching-cubes cell, mm; 0: the case's voxel size. Nodes narrower than two cells get
  /// a cell of a half, a quarter or an eighth, so that thin vessels stay whole and round.
  double cell = 0;
};

/// One mesh per branch, in the tree's order (docs/method.md, section 5). For each node with blobs,
/// marching cubes at the iso-level on a lattice that all nodes share, of the connected component
/// of the lumen at the node's centre. The patch is cut by the radical planes to the nodes within
/// two edges, and the node's side kept. A vessel's free end is cut flat at the end of its last
/// node's cylinder and left open; an aneurysm's dome stays whole.
///
/// Within a patch vertices are shared and the surface is an oriented 2-manifold with boundary.
/// Patches of adjacent nodes meet at the radical planes only to within their models' disagreement,
/// and share no vertex. Normals are the model's, outward.
///
/// Throws Error(InvalidInput) if the case has no models, no voxel size while `cell` is 0, or a cell
/// that is too small for it, and Error(Cancelled).
std::vector<BranchMesh> polygonise(const formats::Case& source, const PolygoniseOptions& options,
                                   Progress& progress);

struct WriteMeshOptions {
  bool draco = false;          ///< glTF only: KHR_draco_mesh_compression
  int dracoPositionBits = 14;  ///< quantisation of a branch's bounding box, 1 .. 30
  int dracoNormalBits = 10;    ///< quantisation of a normal, 2 .. 30
};

/// Writes by `format`: "glb", "gltf" (with embedded buffers), "obj", "stl" (binary), "ply"
/// (binary), atomically. glTF is metres, +Y up, through the root node's matrix; the others stay in
/// mm, LPS.
void writeMesh(const std::vector<BranchMesh>& meshes, const std::filesystem::path& file,
               const std::string& format, const WriteMeshOptions& options);

}  // namespace lumen::convert
