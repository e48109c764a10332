// SPDX-License-Identifier: Apache-2.0
// The meshes that a scene of SOFA loads.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace lumen::convert {

/// A loader of a surface, MeshOBJLoader or MeshSTLLoader, or of what lumen does not read.
struct SofaLoader {
  std::string component;  ///< its class, such as MeshOBJLoader; not fit to print
  std::string name;       ///< its own; SOFA's default, "loader", if it has none
  std::string node;       ///< the names of its nodes, with a / between them
  std::string filename;   ///< as the scene states it
  std::size_t line = 0;
  /// From the file's coordinates to the scene's: what the loader does, and then what the
  /// MechanicalObject beside it does, if it takes its points from there.
  Eigen::Affine3d toScene = Eigen::Affine3d::Identity();
  bool isMovedTwice = false;  ///< that MechanicalObject moves it, too
  bool isStill = false;       ///< in its node or below are collision models with moving="0"
};

/// The loaders of a scene in XML, in its order. `name`: of the file, printable, for messages. Throws
/// Error(InvalidInput), with the line, for what is no scene, and numbers that are none.
std::vector<SofaLoader> sofaLoaders(std::string_view text, const std::string& name);

/// The one that loads the vessels: called `wanted`, by its own name or that of its node. Without a
/// `wanted`: the only one; the only one of a node whose name says vessel; or the only one that is
/// still. Throws Error(InvalidInput) with all that there are if that is not one; and
/// Error(Unsupported) for one of a component that lumen does not read.
const SofaLoader& vesselLoader(const std::vector<SofaLoader>& loaders, const std::string& wanted,
                               const std::string& name);

}  // namespace lumen::convert
