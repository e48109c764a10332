// SPDX-License-Identifier: Apache-2.0
// A case as the folder of files that a simulator, or another program, loads.
#pragma once

#include <string>

#include "converters/export/export_case.h"
#include "converters/operations/context.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// The reader of a folder, and the options for it.
struct ExportPlan {
  const convert::ExportTarget& target;
  convert::ExportOptions options{};   ///< messages name their fields by the context's word
  convert::OptionTexts texts{};       ///< the options as lumen-export.json records them
  std::string folder = "the folder";  ///< for messages
};

/// The files of the folder as bytes by name, in the target's unit and axes (spec/export.md): the
/// target's own, README.md and lumen-export.json. Warns, with the folder's name first, of the
/// surface and of parts of the case that the folder lacks. Takes seconds to minutes, on all threads.
/// The program lumen-netgen fills volume meshes, in a private folder. Throws Error(InvalidInput), with `name` first, for a case that the target cannot hold, Error(Usage) for
/// options that do not fit it, Error(Unsupported) for a format that lumen was built without, and
/// Error(Cancelled).
convert::ExportResult exported(const formats::Case& value, const std::string& name, ExportPlan plan,
                               const Context& context);

}  // namespace lumen::operations
