// SPDX-License-Identifier: Apache-2.0
// Names of groups as formats without quotation marks take them.
#pragma once

#include <string>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// In one word: white space and control characters become "_".
std::string oneWord(const std::string& name);

/// As OpenFOAM takes the name of a patch: letters, digits, "_", "." and "-" of ASCII, all else "_";
/// at most 100 characters.
std::string openFoamWord(const std::string& name);

/// `rule(name)` of each name; one that is then taken gets a number.
std::vector<std::string> distinct(const std::vector<std::string>& names,
                                  std::string (*rule)(const std::string&));

/// The names of groups, in their order.
std::vector<std::string> namesOf(const std::vector<FaceGroup>& groups);

}  // namespace lumen::convert
