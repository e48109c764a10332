// SPDX-License-Identifier: Apache-2.0
// The projection of a volume as a camera sees it.
#pragma once

#include <array>
#include <vector>

#include "converters/base/progress.h"
#include "converters/draw/picture/camera.h"
#include "converters/draw/raster/picture.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The greatest value along each ray of a volume, which must stay; trilinear between voxels, at
/// steps of the least spacing.
class Projector {
public:
  /// Reads the volume once. Throws Error(Cancelled).
  Projector(const Volume& volume, Progress& progress);

  /// One value for each pixel; rows from the top; minus infinity beside the volume. The bits do not
  /// depend on the number of threads, and are those of taking every sample: bricks that hold no
  /// value above the greatest so far are passed over. Throws Error(Cancelled).
  [[nodiscard]] std::vector<float> greatest(const Camera& camera, Progress& progress) const;

private:
  const Volume& m_volume;
  std::array<int, 3> m_bricks{};
  std::vector<float> m_most;  ///< the greatest value in a brick or interpolated with it
};

/// Values that are black and white.
struct GreyWindow {
  float black = 0, white = 1;
};

/// Window from the median of a projection to its highest thousandth.
GreyWindow chooseWindow(std::vector<float> projection);

/// A projection as a picture; black beside the volume.
Picture greyPicture(const std::vector<float>& projection, int width, int height,
                    const GreyWindow& window);

}  // namespace lumen::convert
