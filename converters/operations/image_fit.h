// SPDX-License-Identifier: Apache-2.0
// A case whose walls lie where a volume shows them best.
#pragma once

#include <string>

#include "converters/operations/context.h"
#include "converters/stages/fitting/fit_options.h"
#include "converters/stages/fitting/image/fit_to_image.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// The volume that a case was tracked in.
struct ImagePart {
  convert::Volume voxels;
  std::string name;  ///< for messages
};

struct ImageFittedCase {
  formats::Case value;
  convert::ImageFitReport report;
};

/// The case, called `name`, with the centres, radii and wall points of its vessels where the blurred
/// image of these is most like the volume, and with models fitted to them. The volume is used up:
/// its voxels are gone before models are fitted. Warns if the case was made from another volume.
/// Takes seconds to minutes, on all threads. Throws Error(InvalidInput) with both names if the case
/// has no wall points or no vessel is wide enough to show its contrast, as convert::fit(), and
/// Error(Cancelled).
ImageFittedCase fittedToImage(formats::Case value, const std::string& name, ImagePart image,
                              const convert::FitOptions& options, const Context& context);

}  // namespace lumen::operations
