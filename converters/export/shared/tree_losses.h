// SPDX-License-Identifier: Apache-2.0
// Sentences on the parts of a tree that a file of lines of points cannot hold.
#pragma once

#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen {

/// Sentences without a full stop about links that close loops and aneurysms; none if there is
/// neither.
std::vector<std::string> treeLosses(const formats::CenterlineTree& tree);

}  // namespace lumen
