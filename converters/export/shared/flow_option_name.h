// SPDX-License-Identifier: Apache-2.0
// Names of the options of flow solvers' targets, which rows and messages share (base/option_name.h).
#pragma once

#include "converters/base/option_name.h"

namespace lumen::convert {

struct FlowOptionNames {
  OptionName inlets{"inlets"};
  OptionName cells{"cells"};
  OptionName flow{"flow"};
};

inline constexpr FlowOptionNames kFlowOption{};

}  // namespace lumen::convert
