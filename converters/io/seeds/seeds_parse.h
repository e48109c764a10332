// SPDX-License-Identifier: Apache-2.0
// Reading seeds from JSON. Private to the sources of seeds.
#pragma once

#include <optional>
#include <string>

#include "converters/base/json_place.h"
#include "converters/io/seeds/seeds.h"

namespace lumen::convert {

/// Millimetres in the unit that `unit` names: "mm" or "m".
double scaleOf(const JsonPlace& unit);

/// "vessel" or "aneurysm"; empty for another word.
std::optional<formats::BranchKind> branchKind(const std::string& word);

}  // namespace lumen::convert
