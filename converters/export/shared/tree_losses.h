// SPDX-License-Identifier: Apache-2.0
// What a file that holds lines of points, and no more, lacks of a case's tree.
#pragma once

#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen {

/// Sentences without a full stop about links that close loops and aneurysms; none if there is neither.
std::vector<std::string> treeLosses(const formats::CenterlineTree& tree);

}  // namespace lumen
