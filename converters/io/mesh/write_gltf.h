// SPDX-License-Identifier: Apache-2.0
// Meshes as the bytes of a glTF file. Equal meshes give equal bytes.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

/// LPS millimetres to glTF metres, column-major: x = left, y = superior (up), z = anterior. A
/// rotation and a scale; nothing is mirrored.
constexpr std::array<double, 16> kGltfFromLps = {0.001, 0,     0,      0,  //
                                                 0,     0,     -0.001, 0,  //
                                                 0,     0.001, 0,      0,  //
                                                 0,     0,     0,      1};

/// glTF 2.0: a surface, finest first where there are several levels of detail, which must have the
/// same labels and groups. GLB if `binary`, otherwise JSON with its buffer in a data URI.
///
/// Below a root node whose matrix is kGltfFromLps there is one node with one mesh, in LPS
/// millimetres, or one for each branch, named by its label. A mesh has one primitive for each group
/// of faces, whose `extras` state its name, number and kind; its vertices are its own, so that flat
/// ends have edges, and lie exactly where those of its neighbours do. Vertices have the attributes
/// that vertexStreams() lists; a mesh's `extras` state their units, the branches' labels, and the
/// meaning of colours. Coarser levels are nodes outside of the scene that MSFT_lod names.
///
/// With a skin, meshes are roots beside that node, in glTF's own metres, and the node has the joints
/// as children, in LPS millimetres: programs without skins show the case at rest. Vertices have
/// JOINTS_0 and WEIGHTS_0, and an animation "motion" has linear samplers; its extras state `start_s`
/// where the time of the case is not that of the file. Every option counts with a skin, too.
///
/// Throws Error(Unsupported) above 2 GiB of vertex data, Error(InvalidInput) if the quantity to
/// colour by is missing, Error(Usage) for options that exclude one another, and Error(Failed) if
/// Draco refuses a mesh.
std::string encodeGltf(std::span<const SurfaceMesh> levels, bool binary,
                       const WriteMeshOptions& options, const MeshSkin* skin = nullptr);

/// A node without a mesh: a named place with its z axis along `direction`.
struct GltfPlace {
  std::string name;
  std::array<double, 3> position{};
  std::array<double, 3> direction{0, 0, 1};  ///< unit
};

/// A scene for programs that read the names of nodes and ignore matrices.
struct GltfScene {
  std::vector<std::string> nodes;  ///< names of the nodes, one per level
  bool lod = false;  ///< coarser levels by MSFT_lod; otherwise they are nodes of the scene
  std::vector<GltfPlace> places;
};

/// A GLB of vertices that are already in the file's frame: the root node has no matrix, vertices
/// have POSITION and NORMAL only, and `scene` gives one name per level. Where the surface states
/// systems of vessels, each has a material of its own, with its name and colour. Throws
/// Error(Unsupported) above 2 GiB of vertex data.
std::string encodeGlbScene(std::span<const SurfaceMesh> levels, const GltfScene& scene);

}  // namespace lumen::convert
