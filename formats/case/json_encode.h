// SPDX-License-Identifier: Apache-2.0
// The JSON encoding, `.lumen.json`: from a case to text.
#pragma once

#include <string>

#include "formats/case/case.h"

namespace lumen::formats {

/// The canonical text: equal cases give equal texts (a negative zero is written as zero). The case
/// must pass validate().
std::string encodeJson(const Case& value);

}  // namespace lumen::formats
