// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/image_fit.h"

#include <utility>

#include "converters/base/warning.h"
#include "converters/io/volume/write_volume.h"
#include "converters/judge/facts/check_facts.h"
#include "converters/operations/naming.h"
#include "converters/stages/fitting/fit.h"

namespace lumen::operations {

namespace {

/// Moves walls and tree. The volume goes with the call.
convert::ImageFitReport moveWalls(formats::Case& value, const std::string& name,
                                  const ImagePart image, const Context& context) {
  const auto source =
      convert::sourceRelation(convert::describeSource(image.voxels), value.metadata);
  if (const auto text = source.warning(image.name))
    warn(context.progress, about(name, {WarningCode::CaseOtherVolume, *text}));
  return naming(name + " and " + image.name, [&] {
    return convert::fitToImage(value, image.voxels, convert::recordedImageFit(value, image.voxels),
                               context.progress);
  });
}

}  // namespace

ImageFittedCase fittedToImage(formats::Case value, const std::string& name, ImagePart image,
                              const convert::FitOptions& options, const Context& context) {
  const convert::ImageFitReport report = moveWalls(value, name, std::move(image), context);
  convert::fit(value, options, context.progress);
  return {std::move(value), report};
}

}  // namespace lumen::operations
