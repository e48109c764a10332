// SPDX-License-Identifier: Apache-2.0
// The steady pressures that a network of vessels leads to, before a solver finds them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/export/shared/network.h"

namespace lumen::convert {

/// Pa, at each joint, of the steady flow that the exported boundary conditions state:
/// blood::meanFlow() into each inlet, outletResistances() behind outlets, lumped().resistance
/// between joints.
std::vector<double> steadyPressures(const FlowNetwork& network);

/// Pa, at each joint, of a steady flow with lumped().resistance between joints; `into`: m^3/s that
/// flow into each joint from outside, which sum to 0 in each tree; `zero`: a joint of each tree at
/// which the pressure is 0.
std::vector<double> pressuresOfFlows(const FlowNetwork& network, const std::vector<double>& into,
                                     const std::vector<std::uint32_t>& zero);

/// A sentence for each inlet whose steady pressure no artery has, with the segment that takes most
/// of it; labels as they are.
std::vector<std::string> pressureWarnings(const FlowNetwork& network);

}  // namespace lumen::convert
