// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/volume_behind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <variant>

#include <tbb/parallel_for.h>

namespace lumen::convert {

namespace {

constexpr int kBrick = 8;          // voxels
constexpr float kBrightest = 190;  // brightness, at most 255: vessels stand out before it
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Range of a ray in index space that lies in the box of the voxels: from `first` to `last` steps;
/// empty if first > last.
struct RayRange {
  double first = -kInfinity, last = kInfinity;
};

RayRange stretchIn(const std::array<int, 3>& size, const Eigen::Vector3d& from,
                   const Eigen::Vector3d& step) {
  RayRange s;
  for (int a = 0; a < 3; ++a) {
    const double low = -0.5, high = size[static_cast<std::size_t>(a)] - 0.5;
    if (std::abs(step[a]) < 1e-12) {
      if (from[a] < low || from[a] > high) return {1, 0};
      continue;
    }
    const double t0 = (low - from[a]) / step[a], t1 = (high - from[a]) / step[a];
    s.first = std::max(s.first, std::min(t0, t1));
    s.last = std::min(s.last, std::max(t0, t1));
  }
  return s;
}

/// Voxels, trilinear between their centres; beyond the outermost centres as there.
template <class Pixel>
class Trilinear {
public:
  Trilinear(const std::array<int, 3>& size, const std::vector<Pixel>& voxels)
      : m_voxels(voxels.data()) {
    std::size_t stride = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      m_last[a] = size[a] - 1;
      m_stride[a] = stride;
      stride *= static_cast<std::size_t>(size[a]);
    }
  }

  /// The voxel below a place along an axis, and the share of the next.
  struct Along {
    std::size_t at, next;
    float share;
  };
  [[nodiscard]] Along along(std::size_t axis, double place) const {
    const double inside = std::min(std::max(place, 0.0), static_cast<double>(m_last[axis]));
    const int below = static_cast<int>(inside);
    const std::size_t at = static_cast<std::size_t>(below) * m_stride[axis];
    return {at, below < m_last[axis] ? at + m_stride[axis] : at,
            static_cast<float>(inside - below)};
  }

  [[nodiscard]] float at(const Eigen::Vector3d& p) const {
    const Along x = along(0, p[0]), y = along(1, p[1]), z = along(2, p[2]);
    const auto row = [&](std::size_t start) {
      const auto a = static_cast<float>(m_voxels[start + x.at]);
      return a + x.share * (static_cast<float>(m_voxels[start + x.next]) - a);
    };
    const auto plane = [&](std::size_t start) {
      const float a = row(start + y.at);
      return a + y.share * (row(start + y.next) - a);
    };
    const float a = plane(z.at);
    return a + z.share * (plane(z.next) - a);
  }

private:
  const Pixel* m_voxels;
  std::array<int, 3> m_last{};
  std::array<std::size_t, 3> m_stride{};
};

/// The bricks of a volume along a ray.
class Bricks {
public:
  Bricks(const std::array<int, 3>& size, const std::array<int, 3>& count,
         const std::vector<float>& most)
      : m_size(size), m_count(count), m_most(most) {}

  /// The first whole step from `t` on that lies in a brick that holds more than `met`, or beyond
  /// `last`.
  [[nodiscard]] double skip(const Eigen::Vector3d& from, const Eigen::Vector3d& step, double t,
                            double last, float met) const {
    while (t <= last) {
      std::size_t brick = 0;
      double leaves = kInfinity;
      for (std::size_t a = 3; a-- > 0;) {
        const auto axis = static_cast<Eigen::Index>(a);
        const double place = from[axis] + t * step[axis];
        const double inside = std::min(std::max(place, 0.0), m_size[a] - 1.0);
        const int b = static_cast<int>(inside) / kBrick;
        brick = brick * static_cast<std::size_t>(m_count[a]) + static_cast<std::size_t>(b);
        // points beyond the outermost centres are of the outermost bricks
        const double side = step[axis] > 0 ? (b + 1 < m_count[a] ? kBrick * (b + 1.0) : kInfinity)
                                           : (b > 0 ? 1.0 * kBrick * b : -kInfinity);
        if (std::abs(step[axis]) > 1e-12)
          leaves = std::min(leaves, (side - from[axis]) / step[axis]);
      }
      if (m_most[brick] > met) return t;
      t = std::max(t + 1, std::ceil(leaves));
    }
    return t;
  }

private:
  const std::array<int, 3>& m_size;
  const std::array<int, 3>& m_count;
  const std::vector<float>& m_most;
};

template <class Pixel>
float greatestOn(const Trilinear<Pixel>& voxels, const Bricks& bricks, const RayRange& stretch,
                 const Eigen::Vector3d& from, const Eigen::Vector3d& step) {
  constexpr int kRun = 4;  // samples between two looks at the bricks
  float greatest = -std::numeric_limits<float>::infinity();
  double t = std::ceil(stretch.first);
  while ((t = bricks.skip(from, step, t, stretch.last, greatest)) <= stretch.last)
    for (int i = 0; i < kRun && t <= stretch.last; ++i, t += 1)
      greatest = std::max(greatest, voxels.at(from + t * step));
  return greatest;
}

/// The greatest voxel from the first of a brick to the first of the next.
template <class Pixel>
float greatestInBrick(const std::array<int, 3>& size, const std::vector<Pixel>& voxels,
                      const std::array<int, 3>& brick) {
  std::array<int, 3> end{};
  for (std::size_t a = 0; a < 3; ++a) end[a] = std::min(size[a], kBrick * (brick[a] + 1) + 1);
  Pixel most = std::numeric_limits<Pixel>::lowest();
  for (int k = kBrick * brick[2]; k < end[2]; ++k)
    for (int j = kBrick * brick[1]; j < end[1]; ++j) {
      const std::size_t row = static_cast<std::size_t>(size[0]) *
                              (static_cast<std::size_t>(j) +
                               static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k));
      for (int i = kBrick * brick[0]; i < end[0]; ++i)
        most = std::max(most, voxels[row + static_cast<std::size_t>(i)]);
    }
  return static_cast<float>(most);
}

}  // namespace

Projector::Projector(const Volume& volume, Progress& progress) : m_volume(volume) {
  const std::array<int, 3>& size = volume.geometry.size;
  for (std::size_t a = 0; a < 3; ++a) m_bricks[a] = (size[a] + kBrick - 1) / kBrick;
  const auto plane = static_cast<std::size_t>(m_bricks[0]) * static_cast<std::size_t>(m_bricks[1]);
  m_most.resize(plane * static_cast<std::size_t>(m_bricks[2]));
  std::visit(
      [&](const auto& voxels) {
        tbb::parallel_for(0, m_bricks[2], [&](int k) {
          if (progress.cancelled()) return;
          std::size_t brick = plane * static_cast<std::size_t>(k);
          for (int j = 0; j < m_bricks[1]; ++j)
            for (int i = 0; i < m_bricks[0]; ++i)
              m_most[brick++] = greatestInBrick(size, voxels, {i, j, k});
        });
      },
      volume.voxels);
  progress.check();
}

std::vector<float> Projector::greatest(const Camera& camera, Progress& progress) const {
  const VolumeGeometry& geometry = m_volume.geometry;
  const Eigen::Vector3d origin = geometry.indexFromWorld(camera.place(0.5, 0.5, 0));
  const auto along = [&](double x, double y, double depth) {
    return Eigen::Vector3d(geometry.indexFromWorld(camera.place(x + 0.5, y + 0.5, depth)) - origin);
  };
  const Eigen::Vector3d right = along(1, 0, 0), down = along(0, 1, 0),
                        step = along(0, 0, geometry.spacing.minCoeff());
  const auto width = static_cast<std::size_t>(camera.width);
  std::vector<float> values(width * static_cast<std::size_t>(camera.height));
  const Bricks bricks(geometry.size, m_bricks, m_most);
  std::visit(
      [&](const auto& voxels) {
        const Trilinear trilinear(geometry.size, voxels);
        tbb::parallel_for(0, camera.height, [&](int y) {
          if (progress.cancelled()) return;
          for (int x = 0; x < camera.width; ++x) {
            const Eigen::Vector3d from = origin + x * right + y * down;
            values[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
                greatestOn(trilinear, bricks, stretchIn(geometry.size, from, step), from, step);
          }
        });
      },
      m_volume.voxels);
  progress.check();
  return values;
}

GreyWindow chooseWindow(std::vector<float> projection) {
  std::erase_if(projection, [](float v) { return !std::isfinite(v); });
  if (projection.empty()) return {};
  const auto at = [&](std::size_t i) {
    const auto place = projection.begin() + static_cast<std::ptrdiff_t>(i);
    std::nth_element(projection.begin(), place, projection.end());
    return *place;
  };
  const std::size_t n = projection.size();
  const float black = at(n / 2), white = at((n - 1) - n / 1000);
  return {black, white > black ? white : black + 1};
}

Picture greyPicture(const std::vector<float>& projection, int width, int height,
                    const GreyWindow& window) {
  Picture picture(width, height, {0, 0, 0});
  for (std::size_t i = 0; i < projection.size(); ++i) {
    const float share = (projection[i] - window.black) / (window.white - window.black);
    const auto grey =
        static_cast<std::uint8_t>(std::lround(kBrightest * std::clamp(share, 0.0F, 1.0F)));
    picture.pixels[i] = {grey, grey, grey};
  }
  return picture;
}

}  // namespace lumen::convert
