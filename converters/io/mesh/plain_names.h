// SPDX-License-Identifier: Apache-2.0
// Names of groups for formats without quotation marks.
#pragma once

#include <string>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// One word: white space and control characters become "_".
std::string oneWord(const std::string& name);

/// Name of an OpenFOAM patch: letters, digits, "_", "." and "-" of ASCII, all else "_"; at most 100
/// characters.
std::string openFoamWord(const std::string& name);

/// `rule(name)` of each name; a name that is already taken gets a number.
std::vector<std::string> distinct(const std::vector<std::string>& names,
                                  std::string (*rule)(const std::string&));

/// The names of groups, in their order.
std::vector<std::string> plainGroupNames(const std::vector<FaceGroup>& groups);

}  // namespace lumen::convert
