// SPDX-License-Identifier: Apache-2.0
// Lumen that two vessels of a tree both claim (docs/method.md, section 7.3).
#pragma once

#include <cstdint>
#include <vector>

#include "formats/case/case.h"

namespace lumen::convert {

/// Two vessels whose tubes overlap beyond their joint.
struct SharedLumen {
  std::uint32_t branch = 0, other = 0;
  std::uint32_t node = 0;  ///< of `branch`, where the overlap is deepest
  double length = 0;       ///< mm of the vessel of which more overlaps
  double depth = 0;        ///< mm that both tubes have in common across their axes, at `node`
  double share = 0;        ///< depth there as a share of the thinner one's diameter, in (0, 1]
};

/// The pairs of vessels whose tubes overlap by more than `tolerance` mm somewhere beyond their joint,
/// the deepest first: at places that the path along edges and links joins over more than four times
/// both radii, or not at all. Vessels that leave one another at 29 degrees or more have parted there.
std::vector<SharedLumen> findSharedLumen(const formats::CenterlineTree& tree, double tolerance);

}  // namespace lumen::convert
