// SPDX-License-Identifier: Apache-2.0
// Wall points where none could be measured: on the cylinders of nodes that were bridged or given.
#pragma once

#include <vector>

#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen::convert {

/// A ring of points for every node that was not measured and has no points: around it at its
/// radius, mm, LPS, without points in another branch's lumen near by along the tree. Empty for all
/// other nodes.
std::vector<std::vector<formats::Vec3f>> pointsOfUnmeasured(const formats::Case& value,
                                                            const formats::Neighbours& neighbours);

}  // namespace lumen::convert
