// SPDX-License-Identifier: Apache-2.0
// A picture of a case, without a display.
#pragma once

#include <cstdint>
#include <optional>

#include "converters/base/progress.h"
#include "converters/draw/picture/camera.h"
#include "converters/draw/picture/trace.h"
#include "converters/draw/picture/volume_behind.h"
#include "converters/draw/raster/picture.h"
#include "converters/io/mesh/write_options.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct PictureOptions {
  View view = View::Best;
  /// None: all vessels have that of a vessel, or that of their system where the case states systems.
  ColorBy colour = ColorBy::None;
  int width = 1000, height = 800;  ///< pixels, each 16 or more
  double turn = 0;        ///< radians about the picture's upright axis: from in front to the left
  bool allTurns = false;  ///< scale and centre are those that hold the vessels at any turn
  /// The bar of the scale, the sides of the patient at the edges, and the legend of the colours,
  /// where the picture is at least 160 pixels wide and high.
  bool marks = true;
};

/// Pictures of one case, of which all parts that do not depend on the view are made once.
class CasePainter {
public:
  /// `source` must stay. Throws Error(InvalidInput) for a case without models or a node.
  explicit CasePainter(const formats::Case& source);

  /// Draws the greatest value of a volume, which must stay, along each ray behind the vessels from
  /// now on; the grey of a value is the same at all turns. Throws Error(InvalidInput) if no node
  /// lies in it; Error(Cancelled).
  void setVolume(const Volume& volume, Progress& progress);

  /// The blended surface, shaded; its bytes do not depend on the number of threads. Throws
  /// Error(InvalidInput) for a case that lacks the values to be shown as colours; Error(Cancelled).
  [[nodiscard]] Picture draw(const PictureOptions& options, Progress& progress) const;

private:
  [[nodiscard]] Picture background(const PictureOptions& options, const Camera& camera,
                                   Progress& progress) const;

  const formats::Case& m_source;
  SurfaceTracer m_tracer;
  std::optional<Projector> m_projector;
};

/// One picture of a case, with a volume behind it if there is one, as CasePainter makes it; throws
/// as CasePainter.
Picture drawCase(const formats::Case& source, const PictureOptions& options, const Volume* volume,
                 Progress& progress);

}  // namespace lumen::convert
