// SPDX-License-Identifier: Apache-2.0
// Light on a traced surface.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/draw/picture/camera.h"
#include "converters/draw/picture/trace.h"
#include "converters/draw/raster/picture.h"

namespace lumen::convert {

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
