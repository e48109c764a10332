// SPDX-License-Identifier: Apache-2.0
// A second look at the walls of a tracked vessel, with both neighbours of every node known
// (docs/method.md, section 1.11).
#pragma once

#include <cstddef>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Nodes that are much wider than the vessel on both sides of them, by a poor fit, are fitted anew to
/// what the sides let expect; where nothing fits, they are marked as bridged and lose their points.
/// Then vessels that are not round get their walls (wall_section.h). Other nodes stay as they are.
/// `branches`: in the order of `seeds`; each on its own, in parallel, but for the first `known`.
void reviewWalls(const TrackContext& context, const std::vector<SeedBranch>& seeds,
                 std::size_t known, std::vector<TrackedBranch>& branches);

}  // namespace lumen::convert
