// SPDX-License-Identifier: Apache-2.0
#include "converters/picture/volume_behind.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

#include <tbb/parallel_for.h>

namespace lumen::convert {

namespace {

/// Where a ray in index space lies in the box of the voxels' centres: from `first` to `last` steps.
struct Stretch {
  double first = 0, last = -1;
};

Stretch stretchIn(const VolumeGeometry& geometry, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& step) {
  Stretch s{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int a = 0; a < 3; ++a) {
    const double low = -0.5, high = geometry.size[static_cast<std::size_t>(a)] - 0.5;
    if (std::abs(step[a]) < 1e-12) {
      if (from[a] < low || from[a] > high) return {};
      continue;
    }
    const double t0 = (low - from[a]) / step[a], t1 = (high - from[a]) / step[a];
    s.first = std::max(s.first, std::min(t0, t1));
    s.last = std::min(s.last, std::max(t0, t1));
  }
  return s;
}

template <class Pixel>
float greatestOn(const VolumeGeometry& geometry, const std::vector<Pixel>& voxels,
                 const Eigen::Vector3d& from, const Eigen::Vector3d& step) {
  const Stretch stretch = stretchIn(geometry, from, step);
  const auto nx = static_cast<std::size_t>(geometry.size[0]),
             ny = static_cast<std::size_t>(geometry.size[1]);
  float greatest = -std::numeric_limits<float>::infinity();
  for (double t = std::ceil(stretch.first); t <= stretch.last; t += 1) {
    const Eigen::Vector3d p = from + t * step;
    std::array<std::size_t, 3> i{};
    for (int a = 0; a < 3; ++a) {
      const auto index = static_cast<std::size_t>(a);
      i[index] = static_cast<std::size_t>(
          std::clamp<long>(std::lround(p[a]), 0, geometry.size[index] - 1));
    }
    greatest = std::max(greatest, static_cast<float>(voxels[i[0] + nx * (i[1] + ny * i[2])]));
  }
  return greatest;
}

Picture greysOf(const std::vector<float>& values, int width, int height) {
  std::vector<float> sorted;
  for (const float v : values)
    if (std::isfinite(v)) sorted.push_back(v);
  std::sort(sorted.begin(), sorted.end());
  Picture picture(width, height, {0, 0, 0});
  if (sorted.empty()) return picture;
  const float black = sorted[sorted.size() / 2],
              white = sorted[(sorted.size() - 1) - sorted.size() / 1000];
  const float range = white > black ? white - black : 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const auto grey = static_cast<std::uint8_t>(
        std::lround(235 * std::clamp((values[i] - black) / range, 0.0F, 1.0F)));
    picture.pixels[i] = {grey, grey, grey};
  }
  return picture;
}

}  // namespace

Picture volumeBehind(const Volume& volume, const Camera& camera, Progress& progress) {
  const VolumeGeometry& geometry = volume.geometry;
  const double length = 0.5 * geometry.spacing.minCoeff();  // mm
  const Eigen::Vector3d origin = geometry.indexFromWorld(Eigen::Vector3d::Zero());
  const auto turned = [&](const Eigen::Vector3d& mm) {
    return Eigen::Vector3d(geometry.indexFromWorld(mm) - origin);
  };
  const Eigen::Vector3d step = turned(length * camera.axes.row(2).transpose());
  std::vector<float> values(static_cast<std::size_t>(camera.width) *
                            static_cast<std::size_t>(camera.height));
  std::visit(
      [&](const auto& voxels) {
        tbb::parallel_for(0, camera.height, [&](int y) {
          if (progress.cancelled()) return;
          for (int x = 0; x < camera.width; ++x)
            values[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
                   static_cast<std::size_t>(x)] =
                greatestOn(geometry, voxels,
                           geometry.indexFromWorld(camera.place(x + 0.5, y + 0.5, 0)), step);
        });
      },
      volume.voxels);
  progress.check();
  return greysOf(values, camera.width, camera.height);
}

}  // namespace lumen::convert
