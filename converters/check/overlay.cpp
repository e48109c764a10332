// SPDX-License-Identifier: Apache-2.0
#include "converters/check/overlay.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <tbb/parallel_for.h>

#include "converters/common/statistics.h"
#include "converters/common/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kLeastEdge = 480,
              kMostScale = 4;                // pixels; small volumes are enlarged, up to 4 times
constexpr int kGap = 8, kLegendHeight = 24;  // pixels
constexpr Rgb kBackdrop{24, 24, 32}, kInk{230, 230, 230};

struct Shade {
  Agreement agreement;
  Rgb colour;
  std::string_view meaning;
};

/// In the order in which they are drawn: what disagrees hides what does not.
constexpr std::array<Shade, 4> kShades{{
    {Agreement::NotJudged, {110, 140, 255}, "not judged"},
    {Agreement::Good, {60, 220, 90}, "wall within half a voxel"},
    {Agreement::Fair, {250, 200, 40}, "within one voxel"},
    {Agreement::Poor, {255, 60, 60}, "farther, or no edge"},
}};

/// A projection along one axis of the index space.
struct Panel {
  int across, down, along;  // axes
  double right, below;      // pixels for a voxel
  int x, width, height;     // in the picture

  [[nodiscard]] std::array<double, 2> pixel(const Vector3d& index) const {
    return {x + (index[across] + 0.5) * right, (index[down] + 0.5) * below};
  }
};

std::array<Panel, 3> layOut(const VolumeGeometry& geometry) {
  std::array<Panel, 3> panels{
      {{0, 1, 2, 0, 0, 0, 0, 0}, {0, 2, 1, 0, 0, 0, 0, 0}, {1, 2, 0, 0, 0, 0, 0, 0}}};
  const double finest = geometry.spacing.minCoeff();
  double longest = 0;
  for (int a = 0; a < 3; ++a)
    longest = std::max(longest, geometry.size[static_cast<std::size_t>(a)] * geometry.spacing[a]);
  const double scale =
      std::clamp(std::ceil(kLeastEdge * finest / longest), 1.0, double(kMostScale));
  const auto edge = [&](int axis, double pixels) {
    return std::max(1, static_cast<int>(geometry.size[static_cast<std::size_t>(axis)] * pixels));
  };
  int x = 0;
  for (Panel& panel : panels) {
    panel.right = scale * geometry.spacing[panel.across] / finest;
    panel.below = scale * geometry.spacing[panel.down] / finest;
    panel.width = edge(panel.across, panel.right);
    panel.height = edge(panel.down, panel.below);
    panel.x = x;
    x += panel.width + kGap;
  }
  return panels;
}

/// The greatest value (times `sign`) of each line of voxels along the panel's axis, `across` fastest.
template <class T>
std::vector<float> project(const std::vector<T>& voxels, const VolumeGeometry& geometry,
                           const Panel& panel, float sign) {
  const std::array<std::size_t, 3> size{static_cast<std::size_t>(geometry.size[0]),
                                        static_cast<std::size_t>(geometry.size[1]),
                                        static_cast<std::size_t>(geometry.size[2])};
  const std::array<std::size_t, 3> stride{1, size[0], size[0] * size[1]};
  const auto across = static_cast<std::size_t>(panel.across);
  const auto down = static_cast<std::size_t>(panel.down);
  const auto along = static_cast<std::size_t>(panel.along);
  std::vector<float> image(size[across] * size[down]);
  tbb::parallel_for(std::size_t{0}, size[down], [&](std::size_t j) {
    float* row = image.data() + j * size[across];
    std::fill(row, row + size[across], -INFINITY);
    for (std::size_t k = 0; k < size[along]; ++k) {
      const T* from = voxels.data() + j * stride[down] + k * stride[along];
      for (std::size_t i = 0; i < size[across]; ++i)
        row[i] = std::max(row[i], sign * static_cast<float>(from[i * stride[across]]));
    }
  });
  return image;
}

void drawProjection(Picture& picture, const std::vector<float>& image, int across,
                    const Panel& panel) {
  constexpr double kDarkest = 0.01, kBrightest = 0.995;  // quantiles: single voxels set no scale
  constexpr float kGrey = 200;                           // leaves the lines the brightest
  std::vector<float> sorted = image;
  const float low = lowerQuantile(sorted, kDarkest), high = lowerQuantile(sorted, kBrightest);
  for (int y = 0; y < panel.height; ++y)
    for (int x = 0; x < panel.width; ++x) {
      const int i = std::min(static_cast<int>((x + 0.5) / panel.right), across - 1);
      const int j = std::min(static_cast<int>((y + 0.5) / panel.below),
                             static_cast<int>(image.size()) / across - 1);
      const float value = image[static_cast<std::size_t>(j) * static_cast<std::size_t>(across) +
                                static_cast<std::size_t>(i)];
      const float share = high > low ? std::clamp((value - low) / (high - low), 0.0F, 1.0F) : 0.0F;
      const auto grey = static_cast<std::uint8_t>(kGrey * share);
      picture.set(panel.x + x, y, {grey, grey, grey});
    }
}

void drawTree(Picture& picture, const formats::CenterlineTree& tree, const CheckReport& report,
              const VolumeGeometry& geometry, const Panel& panel) {
  for (const Shade& shade : kShades)
    for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
      if (report.nodes[n] != shade.agreement) continue;
      const auto from = tree.parent[n] < 0 ? n : static_cast<std::size_t>(tree.parent[n]);
      const auto a = panel.pixel(geometry.indexFromWorld(toEigen(tree.centre[from])));
      const auto b = panel.pixel(geometry.indexFromWorld(toEigen(tree.centre[n])));
      picture.line(a[0], a[1], b[0], b[1], shade.colour);
    }
}

void drawLegend(Picture& picture, int top) {
  constexpr int kTextScale = 2, kSwatch = 20, kSpace = 24;
  int x = kGap;
  for (const Shade& shade : kShades) {
    for (int i = 0; i < kSwatch; ++i)
      for (int j = 0; j < 4; ++j) picture.set(x + i, top + kLegendHeight / 2 + j - 2, shade.colour);
    x = picture.text(x + kSwatch + kGap, top + 5, kTextScale, shade.meaning, kInk) + kSpace;
  }
}

}  // namespace

Picture drawOverlay(const Volume& volume, const formats::CenterlineTree& tree,
                    const CheckReport& report) {
  constexpr int kLegendWidth = 1140;
  const std::array<Panel, 3> panels = layOut(volume.geometry);
  int height = 0;
  for (const Panel& panel : panels) height = std::max(height, panel.height);
  const int width = std::max(panels[2].x + panels[2].width, kLegendWidth);
  Picture picture(width, height + kLegendHeight, kBackdrop);
  for (const Panel& panel : panels) {
    const auto image = std::visit(
        [&](const auto& voxels) {
          return project(voxels, volume.geometry, panel, report.options.dark ? -1.0F : 1.0F);
        },
        volume.voxels);
    drawProjection(picture, image, volume.geometry.size[static_cast<std::size_t>(panel.across)],
                   panel);
    drawTree(picture, tree, report, volume.geometry, panel);
  }
  drawLegend(picture, height);
  return picture;
}

}  // namespace lumen::convert
