// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "converters/base/field_word.h"
#include "converters/io/mesh/surface_mesh.h"
#include "formats/view/float3.h"

namespace lumen::convert {

enum class MeshPer : std::uint8_t { Whole, Branch };
enum class ColorBy : std::uint8_t { None, Branch, Radius, Confidence, System };

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
  FieldWord word{};               ///< names fields in messages
};

// Bones of a surface that moves.

/// Frames that carry vertices: joint j carries a point X to translation + scale * R (X - rest[j]).
/// One vertex hangs on at most four joints; its weights are shares of 65535, which they add up to.
struct MeshSkin {
  std::vector<std::string> name;      ///< of each joint
  std::vector<formats::Float3> rest;  ///< mm, LPS

  /// Joints and weights of each vertex, for each level of detail.
  using Four = std::array<std::uint16_t, 4>;
  struct Vertices {
    std::vector<Four> joint, weight;
  };
  std::vector<Vertices> levels;

  /// s, ascending, from 0 on; between two of them places and scales are linear, and rotations go
  /// along the shorter arc.
  std::vector<float> time;
  /// Values of each joint, time by time: those of joint j at time t are at [j][t].
  std::vector<std::vector<formats::Float3>> translation;    ///< mm, LPS
  std::vector<std::vector<std::array<float, 4>>> rotation;  ///< x, y, z, w
  std::vector<std::vector<float>> scale;
  double startTime = 0;  ///< s: time of the case at which `time` is 0
};

// Names of face kinds in files.

constexpr const char* faceKindName(FaceKind kind) {
  switch (kind) {
    case FaceKind::Inlet:
      return "inlet";
    case FaceKind::Outlet:
      return "outlet";
    case FaceKind::Cap:
      return "cap";
    case FaceKind::Wall:
      break;
  }
  return "wall";
}

}  // namespace lumen::convert
