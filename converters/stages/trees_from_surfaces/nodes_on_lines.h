// SPDX-License-Identifier: Apache-2.0
// The lines of vessels as a tree of nodes with wall points.
#pragma once

#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/trees_from_surfaces/vessel_line.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Tree and wall points of the lines, a branch each, in their order. Nodes are a width apart; those
/// of a child within its parent's lumen are bridged and have no points. Wall points are where rays
/// from a node's centre first meet the wall, without those that belong to nodes near by along the
/// tree: those more than three quarters of the distance towards them, by power. So another vessel's
/// wall, which no ray reaches, and the far wall of a fork belong to no node. No radius is below
/// `least`, mm: where a line passes so near to the wall, nothing shows how wide the lumen is.
/// Throws Error(Cancelled).
formats::Case nodesOnLines(const std::vector<VesselLine>& lines, const LumenGeometry& lumen,
                           double least, Progress& progress);

}  // namespace lumen::convert
