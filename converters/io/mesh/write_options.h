// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lumen::convert {

enum class MeshPer : std::uint8_t { Whole, Branch };
enum class ColorBy : std::uint8_t { None, Branch, Radius, Confidence };

/// Options of mesh formats; each format reads only its own.
struct WriteMeshOptions {
  bool stlSolids = false;  ///< STL: text, with one solid for each group of faces

  // glTF only
  MeshPer per = MeshPer::Whole;   ///< one mesh, or one for each branch
  ColorBy color = ColorBy::None;  ///< quantity that COLOR_0 shows
  bool meshopt = false;           ///< EXT_meshopt_compression; not with `draco`
  bool draco = false;             ///< KHR_draco_mesh_compression
  int dracoPositionBits = 16;     ///< quantisation of the surface's bounding box, 1 .. 30
  int dracoNormalBits = 10;       ///< quantisation of a normal, 2 .. 30
  bool skin = true;               ///< the motion of a case that has one
};

}  // namespace lumen::convert
