// SPDX-License-Identifier: Apache-2.0
// Corrections of a case and changes of its seeds by hand, as a page asks for them.
#pragma once

#include <optional>
#include <string>

#include "converters/stages/editing/edit.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document.h"

namespace lumen::viewer {

/// A document with a corrected case, whose stale models are not fitted yet.
struct Correction {
  convert::Change change;
  std::shared_ptr<formats::Case> value;
  Document document;  ///< its seeds follow the case; its case is `value`
};

/// The correction with the name `op`, or nothing if no correction has that name. Throws
/// Error(Usage) if there is no case, and for arguments that do not fit it.
std::optional<Correction> correct(const std::string& op, const Arguments& request,
                                  const Document& document);

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
