// SPDX-License-Identifier: Apache-2.0
// Corrections of a case by hand, as a page asks for them.
#pragma once

#include <optional>
#include <string>

#include "converters/stages/editing/edit.h"
#include "viewer/session/arguments.h"
#include "viewer/session/document.h"

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

}  // namespace lumen::viewer
