// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/shade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include <tbb/parallel_for.h>

namespace lumen::convert {

namespace {

constexpr int kDirections = 8, kSteps = 4;  // numbers for occlusion
constexpr float kAmbient = 0.55F, kDiffuse = 0.6F, kSpecular = 0.12F, kShininess = 32;

/// sRGB, IEC 61966-2-1.
float decodeSrgb(std::uint8_t value) {
  const float v = static_cast<float>(value) / 255;
  return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

/// The greatest sine above the surface's plane of the surfaces in one direction.
float findHorizon(const TracedSurface& surface, double pixelsPerMm, int x, int y, double angle,
                  double reach) {
  const std::size_t pixel = surface.at(x, y);
  const Eigen::Vector3f& normal = surface.normal[pixel];
  float highest = 0;
  for (int step = 1; step <= kSteps; ++step) {
    const double length = reach * step / kSteps;
    const int u = x + static_cast<int>(std::lround(length * std::cos(angle)));
    const int v = y + static_cast<int>(std::lround(length * std::sin(angle)));
    if (u < 0 || v < 0 || u >= surface.width || v >= surface.height) break;
    const std::size_t other = surface.at(u, v);
    if (!surface.isHit(other)) continue;
    const Eigen::Vector3f to(static_cast<float>((u - x) / pixelsPerMm),
                             static_cast<float>((y - v) / pixelsPerMm),
                             surface.depth[other] - surface.depth[pixel]);
    const float distance = to.norm();
    if (distance <= 0) continue;
    // points far in front shade little
    const auto range = static_cast<float>(2 * reach / pixelsPerMm);
    const float weight = std::max(0.0F, 1 - distance / (2 * range));
    highest = std::max(highest, weight * (normal.dot(to) / distance - 0.1F));
  }
  return highest;
}

Light litAt(const TracedSurface& surface, std::size_t pixel, const Light& colour, float sky) {
  static const Eigen::Vector3f kLight = Eigen::Vector3f(-0.45F, 0.6F, 0.66F).normalized();
  static const Eigen::Vector3f kHalf = (kLight + Eigen::Vector3f::UnitZ()).normalized();
  const Eigen::Vector3f& n = surface.normal[pixel];
  const float diffuse = std::max(0.0F, n.dot(kLight));
  const float shine = std::pow(std::max(0.0F, n.dot(kHalf)), kShininess);
  const Light lit = colour * (kAmbient * sky * (0.75F + 0.25F * n.y()) +
                              kDiffuse * diffuse * (0.4F + 0.6F * sky));
  return lit + Light::Constant(kSpecular * shine * sky);
}

}  // namespace

std::uint8_t encodeSrgb(float light) {
  const float v = std::clamp(light, 0.0F, 1.0F);
  const float s = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

std::vector<float> computeOcclusion(const TracedSurface& surface, const Camera& camera,
                                    double reach) {
  std::vector<float> sky(surface.depth.size(), 1);
  tbb::parallel_for(0, surface.height, [&](int y) {
    for (int x = 0; x < surface.width; ++x) {
      const std::size_t pixel = surface.at(x, y);
      if (!surface.isHit(pixel)) continue;
      // other directions at the neighbours, which the samples of a pixel average
      const double turn = ((x & 1) + 2 * (y & 1)) / 4.0;
      float sum = 0;
      for (int k = 0; k < kDirections; ++k)
        sum += findHorizon(surface, camera.scale, x, y,
                           2 * std::numbers::pi * (k + turn) / kDirections, reach);
      sky[pixel] = std::clamp(1 - 1.2F * sum / kDirections, 0.0F, 1.0F);
    }
  });
  return sky;
}

Picture shade(const TracedSurface& surface, const Camera& camera, const std::vector<Light>& colours,
              const Picture& background, int samples) {
  const std::vector<float> sky = computeOcclusion(surface, camera, 0.02 * surface.width);
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = decodeSrgb(static_cast<std::uint8_t>(i));
  Picture picture = background;
  tbb::parallel_for(0, picture.height, [&](int y) {
    for (int x = 0; x < picture.width; ++x) {
      Light sum = Light::Zero();
      int hits = 0;
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) {
          const std::size_t pixel = surface.at(samples * x + i, samples * y + j);
          if (!surface.isHit(pixel)) continue;
          sum += litAt(surface, pixel, colours[surface.node[pixel]], sky[pixel]);
          ++hits;
        }
      if (hits == 0) continue;
      Rgb& out =
          picture.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                         static_cast<std::size_t>(x)];
      const auto all = static_cast<float>(samples * samples);
      for (std::size_t c = 0; c < 3; ++c)
        out[c] = encodeSrgb((sum[static_cast<Eigen::Index>(c)] +
                             (all - static_cast<float>(hits)) * linear[out[c]]) /
                            all);
    }
  });
  return picture;
}

}  // namespace lumen::convert
