// SPDX-License-Identifier: Apache-2.0
// Changes of seeds, as a page asks for them.
#pragma once

#include <optional>
#include <string>

#include "viewer/session/arguments.h"
#include "viewer/session/document.h"

namespace lumen::viewer {

struct SeedChange {
  std::string label;  ///< label of the seed
  std::string title;  ///< title for undo, such as "move seed ica"
  Document document;  ///< after the change
};

/// The change with the name `op`, or nothing if no change of seeds has that name. Throws
/// Error(Usage) for arguments that do not fit the document.
std::optional<SeedChange> changeSeeds(const std::string& op, const Arguments& request,
                                      const Document& document);

}  // namespace lumen::viewer
