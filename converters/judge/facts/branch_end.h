// SPDX-License-Identifier: Apache-2.0
// The end of a vessel in words.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen::convert {

/// For each branch of a valid case a sentence on its last node, without subject and full stop: "goes
/// on as a and b at (1.0, 2.0, 3.0)", "leaves the volume at ...", or why tracking ended there. Places
/// in mm, LPS; names as they are. What the tree and the volume's border show comes before the recorded reason, which an
/// edit may have outdated.
std::vector<std::string> describeEnds(const formats::Case& value);

}  // namespace lumen::convert
