// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/exported.h"

#include <utility>
#include <vector>

#include "converters/base/warning.h"
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
  const std::string folder = formats::printable(plan.folder);
  if (result.surface)
    for (const Warning& warning : surfaceWarnings(*result.surface, value, context))
      warn(context.progress, about(folder, warning));
  for (const std::string& loss : result.losses)
    warn(context.progress, about(folder, {WarningCode::ExportLoss, loss}));
  for (const Warning& warning : result.warnings) warn(context.progress, about(folder, warning));
  return result;
}

}  // namespace lumen::operations
