// SPDX-License-Identifier: Apache-2.0
// The meshes that a scene of SOFA loads.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace lumen::convert {

/// A loader of a surface, MeshOBJLoader or MeshSTLLoader, or of a format that lumen does not read.
struct SofaLoader {
  std::string component;  ///< its class, such as MeshOBJLoader; unescaped
  std::string name;       ///< its own name; SOFA's default, "loader", if it has none
  std::string node;       ///< path of its nodes' names, with a / between them
  std::string filename;   ///< file name as the scene states it
  std::size_t line = 0;
  /// From the file's coordinates to the scene's: the loader's transform, then that of the
  /// MechanicalObject beside it, if it takes its points from the loader.
  Eigen::Affine3d toScene = Eigen::Affine3d::Identity();
  bool isMovedTwice = false;  ///< that MechanicalObject moves the mesh as well
  bool isStill = false;       ///< collision models in its node or below have moving="0"
};

/// The loaders of a scene in XML, in document order. `name`: printable name of the file, for
/// messages. Throws Error(InvalidInput), with the line, for XML that is no scene, and for malformed
/// numbers.
std::vector<SofaLoader> sofaLoaders(std::string_view text, const std::string& name);

/// The loader of the vessels: the one called `wanted`, by its own name or that of its node. Without
/// a `wanted`: the only one; the only one of a node whose name contains vessel; or the only one
/// that is still. Throws Error(InvalidInput) with all loaders if none or several match; and
/// Error(Unsupported) for a component that lumen does not read.
const SofaLoader& vesselLoader(const std::vector<SofaLoader>& loaders, const std::string& wanted,
                               const std::string& name);

}  // namespace lumen::convert
