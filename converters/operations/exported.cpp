// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/exported.h"

#include <utility>
#include <vector>

#include "converters/operations/naming.h"
#include "converters/operations/surface_of.h"
#include "formats/container/printable.h"

namespace lumen::operations {

convert::ExportResult exported(const formats::Case& value, const std::string& name, ExportPlan plan,
                               const Context& context) {
  plan.options.word = context.fieldWord;
  convert::ExportResult result = naming(name, [&] {
    return convert::exportCase(plan.target, value, plan.options, plan.texts, context.progress);
  });
  const auto warn = [&](const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences)
      context.progress.warn(formats::printable(plan.folder) + ": " + sentence);
  };
  if (result.surface) warn(surfaceWarnings(*result.surface, context));
  warn(result.losses);
  return result;
}

}  // namespace lumen::operations
