// SPDX-License-Identifier: Apache-2.0
// Places of a tree that a person should look at, whatever its volume shows there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/judge/check/check.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A tree that hangs on nothing.
struct LooseTree {
  std::uint32_t node = 0;  ///< first node of its root
  std::size_t branches = 0;
  double length = 0;  ///< mm
};

/// All trees but the longest one that do not begin where their vessel enters the volume: within 1.5 radii of
/// its border. The longest first.
std::vector<LooseTree> findLooseTrees(const formats::CenterlineTree& tree,
                                      const VolumeGeometry& geometry);

/// A stretch of a vessel that runs within another one.
struct DoubledTrack {
  std::uint32_t node = 0;    ///< in its middle
  std::uint32_t branch = 0;  ///< that the stretch is of, the shorter of both
  std::uint32_t other = 0;   ///< branch in whose lumen it runs
  double length = 0;         ///< mm
};

/// Stretches longer than four radii of the wider vessel, whose nodes lie nearer to the axis of another
/// vessel than half of its radius and point the same way within 37 degrees: a child leaves its parent's
/// axis sooner. One for each pair of vessels, the longest first.
std::vector<DoubledTrack> findDoubledTracks(const formats::CenterlineTree& tree);

/// Nodes of one branch that follow one another.
struct NodeStretch {
  std::uint32_t first = 0, end = 0;
  double length = 0;  ///< mm
};

/// Stretches of three and more nodes whose wall agrees poorly with the volume, the longest first.
/// `agreement` has a verdict for each node.
std::vector<NodeStretch> findPoorStretches(const formats::CenterlineTree& tree,
                                           std::span<const Agreement> agreement);

}  // namespace lumen::convert
