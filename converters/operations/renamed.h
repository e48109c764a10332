// SPDX-License-Identifier: Apache-2.0
// A case whose vessels have other names.
#pragma once

#include <span>
#include <string>

#include "converters/operations/context.h"
#include "formats/case/case.h"

namespace lumen::operations {

struct NewName {
  std::string label, becomes;  ///< of a branch
};

/// The case, called `name`, with these labels in place of those; all change at once, so two branches
/// may change theirs for each other's. Each is kept as a correction, which another case of the same
/// volume takes over (stages/editing/edit_request.h). Throws Error(InvalidInput) for a label that no
/// branch has or that is given twice, for two branches of one label, and for a text that is no label.
formats::Case renamed(formats::Case value, std::span<const NewName> names, const std::string& name);

}  // namespace lumen::operations
