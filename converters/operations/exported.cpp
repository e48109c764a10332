// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/exported.h"

#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/operations/surface_of.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

/// Adds the case's name to the error of a target about it.
convert::ExportResult filesOf(const formats::Case& value, const std::string& name,
                              const ExportPlan& plan, Progress& progress) {
  try {
    return convert::exportCase(plan.target, value, plan.options, plan.texts, progress);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::InvalidInput) throw;
    throw invalidInput(name + ": " + error.what());
  }
}

}  // namespace

convert::ExportResult exported(const formats::Case& value, const std::string& name, ExportPlan plan,
                               const Context& context) {
  plan.options.word = context.fieldWord;
  convert::ExportResult result = filesOf(value, name, plan, context.progress);
  const auto warn = [&](const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences)
      context.progress.warn(formats::printable(plan.folder) + ": " + sentence);
  };
  if (result.surface) warn(surfaceWarnings(*result.surface, context));
  warn(result.losses);
  return result;
}

}  // namespace lumen::operations
