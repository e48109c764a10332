// SPDX-License-Identifier: Apache-2.0
// Places in the vessels of a case, and the ends at which blood comes into its trees.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// A node of a vessel in whose ball a point lies.
struct NodePlace {
  std::uint32_t branch = 0, node = 0;
  double share = 0;  ///< distance from the node's centre over its radius, at most 1
};

/// The nearest node of a branch by `share`; empty if the point, mm, LPS, lies in none of its balls.
std::optional<NodePlace> placeIn(const formats::CenterlineTree& tree, std::uint32_t branch,
                                 const Eigen::Vector3d& point);

/// The nearest node of all vessels by `share`; empty if the point, mm, LPS, lies in no ball of any.
std::optional<NodePlace> placeIn(const formats::CenterlineTree& tree, const Eigen::Vector3d& point);

/// The root above a node.
std::uint32_t rootAbove(const formats::CenterlineTree& tree, std::uint32_t node);

/// Makes the end of a tree that is nearest to each place, along the vessels, its root. A tree in
/// which several places have an end of their own is divided between them at the narrowest node on
/// the path, and a link holds the two parts together. The case has no models. Returns the indices of
/// places, mm, LPS, that lie in no vessel.
std::vector<std::size_t> beginAt(formats::Case& target, std::span<const Eigen::Vector3d> places);

}  // namespace lumen::convert
