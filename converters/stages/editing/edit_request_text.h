// SPDX-License-Identifier: Apache-2.0
// Requests as texts with places instead of indices. Private to the sources of edit_request.
#pragma once

#include <string>

#include "converters/stages/editing/edit_request.h"

namespace lumen::convert {

/// The request as JSON: a branch by its label and its middle node's place, a node by its place and
/// its branch's label, each with the radius there. Branch and node are of `tree`.
std::string textOfRequest(const EditRequest& request, const formats::CenterlineTree& tree);

/// The request that such a text is in another tree. Throws Error(InvalidInput) for a text that is
/// none, and where the tree has no vessel at the place.
EditRequest requestInTree(const std::string& text, const formats::CenterlineTree& tree);

}  // namespace lumen::convert
