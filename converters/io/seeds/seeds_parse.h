// SPDX-License-Identifier: Apache-2.0
// Reading seeds from JSON. Private to the sources of seeds.
#pragma once

#include <optional>
#include <string>

#include "converters/base/json_place.h"
#include "converters/io/seeds/seeds.h"

namespace lumen::convert {

/// Millimetres in the unit that `unit` names: "mm" or "m".
double unitInMillimetres(const JsonPlace& unit);

/// Sets the kind that "vessel", "aneurysm" or "root" names; false for another word.
bool setKind(const std::string& word, SeedBranch& branch);
/// The word of a branch's kind.
std::string kindOf(const SeedBranch& branch);

}  // namespace lumen::convert
