// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/overlay/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include <tbb/parallel_for.h>

namespace lumen::convert {
namespace {

constexpr double kWanted = 1600;  // pixels, of both views of the longer side
constexpr double kMostScale = 8;  // pixels for the finest voxel: small volumes are enlarged
constexpr char kNames[] = "xyz";

/// Grid axis for each patient axis: the one that goes most along it, each once, and whether it runs
/// against it.
struct Axes {
  std::array<int, 3> grid{};
  std::array<bool, 3> against{};
};

Axes axesOf(const VolumeGeometry& geometry) {
  Axes axes;
  double best = -1;
  for (const std::array<int, 3>& order :
       {std::array{0, 1, 2}, std::array{0, 2, 1}, std::array{1, 0, 2}, std::array{1, 2, 0},
        std::array{2, 0, 1}, std::array{2, 1, 0}}) {
    double along = 0;
    for (int p = 0; p < 3; ++p)
      along += std::abs(geometry.direction(p, order[static_cast<std::size_t>(p)]));
    if (along <= best + 1e-9) continue;
    best = along;
    axes.grid = order;
  }
  for (int p = 0; p < 3; ++p)
    axes.against[static_cast<std::size_t>(p)] =
        geometry.direction(p, axes.grid[static_cast<std::size_t>(p)]) < 0;
  return axes;
}

/// The view with the patient axis `across` to the right and `down` down, or up if `up`.
Panel viewOf(const Axes& axes, int across, int down, bool up) {
  const auto a = static_cast<std::size_t>(across), d = static_cast<std::size_t>(down);
  Panel panel{axes.grid[a], axes.grid[d], axes.grid[3 - a - d]};
  panel.flipAcross = axes.against[a];
  panel.flipDown = axes.against[d] != up;
  panel.title = std::string(1, kNames[a]).append(" right, ").append(1, kNames[d]);
  panel.title.append(up ? " up" : " down");
  return panel;
}

template <class T>
Projection projectVoxels(const std::vector<T>& voxels, const Panel& panel, float sign) {
  std::array<std::size_t, 3> size{}, stride{1, 1, 1};
  for (std::size_t a = 0; a < 3; ++a) size[a] = static_cast<std::size_t>(panel.size[a]);
  stride[1] = size[0];
  stride[2] = size[0] * size[1];
  const auto across = static_cast<std::size_t>(panel.across);
  const auto down = static_cast<std::size_t>(panel.down);
  const auto along = static_cast<std::size_t>(panel.along);
  Projection image{panel.size[across], panel.size[down], {}};
  image.values.assign(size[across] * size[down], -std::numeric_limits<float>::infinity());
  tbb::parallel_for(std::size_t{0}, size[down], [&](std::size_t j) {
    float* row = image.values.data() + (panel.flipDown ? size[down] - 1 - j : j) * size[across];
    for (std::size_t k = 0; k < size[along]; ++k) {
      const T* from = voxels.data() + j * stride[down] + k * stride[along];
      for (std::size_t i = 0; i < size[across]; ++i)
        row[i] = std::max(row[i], sign * static_cast<float>(from[i * stride[across]]));
    }
    if (panel.flipAcross) std::reverse(row, row + size[across]);
  });
  return image;
}

}  // namespace

std::array<double, 2> Panel::pixel(const Eigen::Vector3d& index) const {
  const double i =
      flipAcross ? size[static_cast<std::size_t>(across)] - 1 - index[across] : index[across];
  const double j = flipDown ? size[static_cast<std::size_t>(down)] - 1 - index[down] : index[down];
  return {x + (i + 0.5) * right, y + (j + 0.5) * below};
}

Layout layOut(const VolumeGeometry& geometry, int gap, int legendWidth, int legendHeight) {
  const Axes axes = axesOf(geometry);
  const auto length = [&](std::size_t p) {
    const int axis = axes.grid[p];
    return geometry.size[static_cast<std::size_t>(axis)] * geometry.spacing[axis];
  };
  const double finest = geometry.spacing.minCoeff();
  const double scale = std::clamp(kWanted / std::max(length(0) + length(1), length(2) + length(1)),
                                  1 / finest, kMostScale / finest);
  Layout layout{{viewOf(axes, 0, 2, true), viewOf(axes, 1, 2, true), viewOf(axes, 0, 1, false)}};
  for (Panel& panel : layout.panels) {
    panel.size = geometry.size;
    panel.right = scale * geometry.spacing[panel.across];
    panel.below = scale * geometry.spacing[panel.down];
    const auto edge = [&](int axis, double pixels) {
      return std::max(1, static_cast<int>(geometry.size[static_cast<std::size_t>(axis)] * pixels));
    };
    panel.width = edge(panel.across, panel.right);
    panel.height = edge(panel.down, panel.below);
  }
  layout.panels[1].x = layout.legendX = layout.panels[0].width + gap;
  layout.panels[2].y = layout.legendY = layout.panels[0].height + gap;
  layout.width = layout.legendX + std::max(layout.panels[1].width, legendWidth);
  layout.height = layout.legendY + std::max(layout.panels[2].height, legendHeight);
  return layout;
}

float Projection::at(double across, double down) const {
  const double i = std::clamp(across - 0.5, 0.0, double(width - 1));
  const double j = std::clamp(down - 0.5, 0.0, double(height - 1));
  const int i0 = static_cast<int>(i), j0 = static_cast<int>(j);
  const int i1 = std::min(i0 + 1, width - 1), j1 = std::min(j0 + 1, height - 1);
  const auto u = static_cast<float>(i - i0), v = static_cast<float>(j - j0);
  const auto value = [&](int a, int b) {
    return values[static_cast<std::size_t>(b) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(a)];
  };
  return (1 - v) * ((1 - u) * value(i0, j0) + u * value(i1, j0)) +
         v * ((1 - u) * value(i0, j1) + u * value(i1, j1));
}

Projection project(const Volume& volume, const Panel& panel, float sign) {
  return std::visit([&](const auto& voxels) { return projectVoxels(voxels, panel, sign); },
                    volume.voxels);
}

}  // namespace lumen::convert
