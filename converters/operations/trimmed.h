// SPDX-License-Identifier: Apache-2.0
// A case without ends of vessels that are too thin or too short.
#pragma once

#include <string>
#include <vector>

#include "converters/operations/context.h"
#include "converters/stages/editing/trim.h"
#include "formats/case/case.h"

namespace lumen::operations {

struct TrimmedCase {
  formats::Case value;
  std::vector<convert::TrimmedEnd> ends;  ///< the parts that are gone, in the order of the branches
};

/// The case, called `name`, without the ends that trimEnds() finds by `limits`. Models around them
/// are fitted again by the options of the case's last fit, if it has wall points, on all threads.
/// Throws Error(InvalidInput) if nothing would be left, and Error(Cancelled).
TrimmedCase trimmed(formats::Case value, const convert::TrimLimits& limits, const std::string& name,
                    const Context& context);

}  // namespace lumen::operations
