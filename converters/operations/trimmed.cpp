// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/trimmed.h"

#include <utility>

#include "converters/operations/naming.h"
#include "converters/stages/fitting/fit.h"

namespace lumen::operations {

TrimmedCase trimmed(formats::Case value, const convert::TrimLimits& limits, const std::string& name,
                    const Context& context) {
  convert::TrimResult result = naming(name, [&] { return convert::trimEnds(value, limits); });
  if (!result.change.stale.empty() && value.points)
    convert::refit(value, result.change.stale, convert::recordedFitOptions(value),
                   context.progress);
  return {std::move(value), std::move(result.ends)};
}

}  // namespace lumen::operations
