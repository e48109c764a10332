// SPDX-License-Identifier: Apache-2.0
// The lumen of a tree is one: no wall stands across an edge (docs/method.md, section 2.8).
#pragma once

#include <cstddef>

#include "formats/case/case.h"

namespace lumen::convert {

/// Adds blobs to the models of a fitted case wherever a point that is pushed along an edge of the
/// tree would leave the lumen, as narrow as opens it. The number of edges that stay closed.
std::size_t openEdges(formats::Case& target);

}  // namespace lumen::convert
