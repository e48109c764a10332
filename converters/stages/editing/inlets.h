// SPDX-License-Identifier: Apache-2.0
// Places in the vessels of a case, and the ends at which blood comes into its trees.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
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

/// The vessel whose wall is nearest to a point.
struct NearVessel {
  std::uint32_t branch = 0;
  double toWall = 0;  ///< mm from the point to the wall; negative within
};

/// The vessel nearest to a point, mm, LPS, by balls around its nodes; empty without vessels.
std::optional<NearVessel> nearestVessel(const formats::CenterlineTree& tree,
                                        const Eigen::Vector3d& point);

/// A place at which no tree begins, although it was asked for.
struct UnusedPlace {
  enum class Why : std::uint8_t {
    InNoVessel,
    SameEnd,    ///< an earlier place has the end that is nearest to it
    NotDivided  ///< its tree begins at an earlier place, and has no node at which to divide it
  };
  std::size_t index = 0;
  Why why = Why::InNoVessel;

  bool operator==(const UnusedPlace&) const = default;
};

/// "an earlier root has the end that is nearest to it", without the place.
std::string reasonFor(UnusedPlace::Why why);

/// Makes the end of a tree that is nearest to each place, along the vessels, its root. A tree in
/// which several places have an end of their own is divided between them at the narrowest node on
/// the path, and a link holds the two parts together. The case has no models. Places in mm, LPS.
/// Returns those at which no tree begins.
std::vector<UnusedPlace> beginAt(formats::Case& target, std::span<const Eigen::Vector3d> places);

}  // namespace lumen::convert
