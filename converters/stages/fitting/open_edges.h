// SPDX-License-Identifier: Apache-2.0
// The lumen of a tree is one: no wall stands across an edge (docs/method.md, section 2.9).
#pragma once

#include <cstdint>
#include <functional>

#include "formats/case/case.h"

namespace lumen::convert {

/// Adds blobs to the models of a fitted case wherever a point that is pushed along an edge of the
/// tree would leave the lumen; the smallest that open a passage of four tenths of the edge's lesser
/// radius. An edge stays closed if it is so long that following does not lead along it;
/// measureReachability() reports these. `mayOpen`, if given, is asked about each edge, by its farther
/// end: others are left alone.
void openEdges(formats::Case& target, const std::function<bool(std::uint32_t node)>& mayOpen = {});

}  // namespace lumen::convert
