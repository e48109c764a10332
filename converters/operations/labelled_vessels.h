// SPDX-License-Identifier: Apache-2.0
// Vessels that the labels of a volume mark.
#pragma once

#include <cstdint>
#include <set>

#include "converters/operations/context.h"
#include "converters/operations/source.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// Tree and wall points of the `chosen` labels, all but 0 if it is empty; mm, LPS. A branch has the
/// name of its label where there are several, or names are known. Throws Error(InvalidInput) for
/// voxels that are no labels, and for labels that are no vessels; and Error(Cancelled).
formats::Case labelledVessels(const LabelPart& labels, const std::set<std::int64_t>& chosen,
                              const Context& context);

}  // namespace lumen::operations
