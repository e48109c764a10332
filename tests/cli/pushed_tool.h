// SPDX-License-Identifier: Apache-2.0
// A catheter that a simulator pushes through a case: libblob's public interface and nothing else.
#pragma once

#include <cstdint>
#include <vector>

#include "blob.h"

namespace lumen::test {

/// How one push from a root to a tip went. Lengths in mm.
struct PushedTool {
  std::uint32_t tip = 0;  ///< a node without children
  double length = 0;      ///< of the way along the tree
  double outside = 0;     ///< the farthest that any point was outside after it was pushed back
  double pushedBack = 0;  ///< the farthest that any point was outside before
  std::uint32_t outsideNode = 0;  ///< the cursor of the point that was farthest outside
  double outsideAt[3] = {};       ///< and its place, LPS
  double fromTip = 0;             ///< of the head at the end from the tip's centre
  /// Along the tree, from the tip to the node at which the head's cursor ends; infinite if that is not
  /// on the way.
  double cursorFromTip = 0;
};

/// Pushes a tool of 200 points from the root of every tip to the tip, the head along the tree and the
/// body behind it; at the farthest tip it lies along the whole way. Each point has its own cursor,
/// which starts at the root and then follows, and moves by at most half of the way's least radius in a
/// step. In every step each point is displaced by up to a fifth of the radius in some direction; if
/// it then is outside, it is put back once, by the distance along the normal that libblob answers.
std::vector<PushedTool> pushToEveryTip(const blob_model* model);

/// The first node on each way from a root that a single point does not get to, pushed straight from
/// node to node in 64 steps each; ascending.
std::vector<std::uint32_t> firstClosedNodes(const blob_model* model);

}  // namespace lumen::test
