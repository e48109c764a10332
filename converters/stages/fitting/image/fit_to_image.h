// SPDX-License-Identifier: Apache-2.0
// Walls that make the image of a case's vessels most like a volume (docs/method.md, section 2.11).
#pragma once

#include <cstddef>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct ImageFitOptions {
  bool dark = false;  ///< vessels are darker than their background
  double blur = 0;    ///< mm, > 0: standard deviation of the point-spread function to begin with
};

struct ImageFitReport {
  double blur = 0;        ///< mm, as measured, along the finest axis of the volume
  std::size_t nodes = 0;  ///< nodes whose walls are now those of the image
  std::size_t kept = 0;   ///< nodes that keep their wall points
};

/// The options for a case that was tracked in `volume`: the polarity of its last "track" step, and a
/// usual blur.
ImageFitOptions recordedImageFit(const formats::Case& value, const Volume& volume);

/// Replaces the wall points of the nodes of vessels, their centres and radii by those of the
/// cross-sections whose blurred images differ least from the volume, gives each node the standard
/// deviation of its radius (LUMEN_image.deviation of spec/lumen.md), and appends the step
/// "fit-image". Nodes keep theirs in forks, in aneurysms, where a person changed the wall, and where
/// the volume does not determine them. Bridged nodes between measured ones become measured. Models
/// stay as they are: fit() comes next. The result does not depend on the number of threads. Throws
/// Error(InvalidInput) if the case has no wall points or no vessel is wide enough to show its
/// contrast, and Error(Cancelled); the case is then as it was.
ImageFitReport fitToImage(formats::Case& target, const Volume& volume,
                          const ImageFitOptions& options, Progress& progress);

}  // namespace lumen::convert
