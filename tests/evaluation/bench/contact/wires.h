// SPDX-License-Identifier: Apache-2.0
// The load of reinforcement learning: many guidewires in one vessel, each in an environment of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/case/case.h"
#include "method.h"

namespace lumen::bench {

struct WireOptions {
  std::size_t environments = 4096;
  std::size_t points = 100;  ///< of each wire
  std::size_t frames = 8;
  double spacing = 0.5;   ///< mm along the axis; less in a path that is too short for the wire
  double advance = 0.05;  ///< mm in a frame: 50 mm/s at 1 ms
  std::uint64_t seed = 1;
};

/// Points of one frame lie wire after wire, from the tip back.
struct Wires {
  std::size_t environments = 0, points = 0;
  std::vector<std::vector<double>> position;  ///< of each frame: x, y, z, mm
  std::vector<std::vector<std::uint32_t>>
      station;  ///< of each frame: the node whose axis a point is off
  [[nodiscard]] std::size_t frames() const { return position.size(); }
  [[nodiscard]] std::size_t count() const { return environments * points; }
};

/// Wires on random paths from a root to a leaf, at random depths. A point lies off the axis by a share of
/// the way to the wall that swings along the wire between 0.05 and 1.05, in a direction that turns: three
/// in ten are within a tenth of the wall, one in seven is past it. The model is the case's. The same seed gives the
/// same wires.
Wires makeWires(const formats::CenterlineTree& tree, const blob_model* model,
                const WireOptions& options);

/// How far the wall of the vessel of node `station` is from a point of its axis in a unit direction, mm;
/// the node's radius where the field has none within four radii.
double wallAlong(const blob_model* model, std::uint32_t station, const double* axis,
                 const double* direction);

/// A unit vector across `along`, at an angle about it.
void across(const double* along, double angle, double* result);

}  // namespace lumen::bench
