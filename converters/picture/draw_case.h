// SPDX-License-Identifier: Apache-2.0
// A picture of a case, without a display.
#pragma once

#include <cstdint>

#include "converters/check/picture.h"
#include "converters/common/progress.h"
#include "converters/picture/camera.h"
#include "converters/volume/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

enum class ColourBy : std::uint8_t { Vessel, Branch, Radius, Confidence };

struct PictureOptions {
  View view = View::Best;
  ColourBy colour = ColourBy::Vessel;
  int width = 1000, height = 800;  ///< pixels
  double turn = 0;                 ///< radians about the axis from foot to head
};

/// The blended surface of a case with models, shaded, with a scale bar; behind it, of `volume`, if there is one, the
/// greatest value along each ray. Throws Error(InvalidInput) for a case without models, a node, or what is to be the
/// colour; Error(Cancelled).
Picture drawCase(const formats::Case& source, const PictureOptions& options, const Volume* volume,
                 Progress& progress);

}  // namespace lumen::convert
