// SPDX-License-Identifier: Apache-2.0
// The blended surface of a case as rays meet it.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/draw/picture/camera.h"
#include "converters/draw/raster/picture.h"
#include "converters/geometry/case_model.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The first hit behind each pixel of a camera; rows from the top.
struct TracedSurface {
  static constexpr float kNothing = -std::numeric_limits<float>::infinity();
  int width = 0, height = 0;
  std::vector<float> depth;             ///< mm towards the viewer; kNothing where no vessel is
  std::vector<Eigen::Vector3f> normal;  ///< unit, out of the lumen, in the camera's axes
  std::vector<std::uint32_t> node;      ///< node of a cursor on the surface

  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] bool isHit(std::size_t pixel) const { return depth[pixel] > kNothing; }
};

/// Points where rays meet the wall, by section 4.6 of docs/method.md: sphere tracing (J. C. Hart,
/// 1996) of libblob's distance, of each node in its own power cell, so vessels that touch stay
/// apart.
class SurfaceTracer {
public:
  /// `source` has models and a node, and must stay. Throws as openModels().
  explicit SurfaceTracer(const formats::Case& source);

  /// Traces on all cores; the bits do not depend on their number. Throws Error(Cancelled).
  [[nodiscard]] TracedSurface trace(const Camera& camera, Progress& progress) const;

private:
  const formats::CenterlineTree& m_tree;
  OwnedModel m_model;
};

// Light on a traced surface.

/// Colours of linear light.
using Light = Eigen::Vector3f;

/// A channel of linear light, 0 to 1, as sRGB (IEC 61966-2-1).
std::uint8_t encodeSrgb(float light);

/// Share of the sky that each pixel sees, 0 to 1: less in forks, between vessels, and behind
/// others. It follows from the depths around the pixel, within `reach` pixels (L. Bavoil, M. Sainz,
/// Image-space horizon-based ambient occlusion, 2008, in few directions).
std::vector<float> computeOcclusion(const TracedSurface& surface, const Camera& camera,
                                    double reach);

/// The picture of a surface that has `samples` times `samples` pixels for each of the background's:
/// lit from the upper left in front, with the colour of each node, over the background. Its bits do
/// not depend on the number of threads.
Picture shade(const TracedSurface& surface, const Camera& camera, const std::vector<Light>& colours,
              const Picture& background, int samples);

}  // namespace lumen::convert
