// SPDX-License-Identifier: Apache-2.0
// Bones of a surface that moves.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/view/float3.h"

namespace lumen::convert {

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

}  // namespace lumen::convert
