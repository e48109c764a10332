// SPDX-License-Identifier: Apache-2.0
// The tree of boxes behind blob_cursor_locate().
#pragma once

#include <vector>

#include "model.h"

namespace lumen::blob {

LocateTree buildLocateTree(const std::vector<NodeRecord>& nodes);

}  // namespace lumen::blob
