// SPDX-License-Identifier: Apache-2.0
// A case whose vessels have anatomical names.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "converters/stages/anatomy/artery_stretches.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// The arteries of the circle of Willis and of the aortic arch in a case, called `name`. Throws Error(InvalidInput) for a
/// case without a source volume, which alone shows where the left and the front of a patient are.
std::vector<convert::ArteryStretch> anatomicalNames(const formats::Case& value,
                                                    const std::string& name);

struct AnatomicallyNamed {
  formats::Case value;
  std::size_t renamed = 0;  ///< number of branches that have another name
};

/// The case with its branches cut where these stretches begin and end, and named after them: the stretches
/// of one name are numbered along the flow, by their way from where their tree begins: L-MCA, L-MCA-2. A
/// cut gives a part another name and leaves the lumen whole. Branches without an automatic name
/// (geometry/automatic_names.h) were named by somebody, and stay. Each change is kept as a correction (stages/editing/edit_request.h).
AnatomicallyNamed anatomicallyNamed(formats::Case value,
                                    std::span<const convert::ArteryStretch> stretches);

}  // namespace lumen::operations
