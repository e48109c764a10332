// SPDX-License-Identifier: Apache-2.0
// The part of two nodes' radical plane that a tool can reach.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "formats/field/tree_view.h"
#include "formats/field/vector.h"

namespace lumen::field {

/// A convex polygon on the plane where two nodes have the same power, around their balls' common
/// disc, from which half-planes are cut.
class RadicalDisc {
public:
  /// A square that holds all points of the plane within kReachRadii of both centres.
  RadicalDisc(const TreeView& tree, std::uint32_t a, std::uint32_t b);

  /// Keeps the points where `node` has no less power than the two less `slack`, mm^2.
  void cut(const TreeView& tree, std::uint32_t node, double slack);

  [[nodiscard]] bool isEmpty() const { return m_count == 0; }

private:
  static constexpr double kReachRadii = 1.5;
  static constexpr std::size_t kMostCorners = 32;  ///< a cut that would add more is left out
  static constexpr std::size_t kEverywhere = kMostCorners + 1;

  Vec m_origin;     ///< the first centre, mm; corners are relative to it
  double m_radius;  ///< the first node's, mm
  std::array<Vec, kMostCorners> m_corner;
  std::size_t m_count = 0;
};

}  // namespace lumen::field
