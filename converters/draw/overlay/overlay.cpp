// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

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

namespace {

using Eigen::Vector3d;

constexpr int kGap = 8, kLineHeight = 22, kTextScale = 2;  // pixels
constexpr int kLegendWidth = 560, kLegendHeight = 250;     // pixels, at least
constexpr std::size_t kManyBranches = 12;                  // more have smaller names
constexpr std::size_t kNumbered = 9;                       // missing vessels with a number
constexpr Rgb kBackdrop{24, 24, 32}, kInk{230, 230, 230}, kMissing = kMissingColour,
                                                          kLabel{150, 220, 255};

struct Shade {
  Agreement agreement;
  Rgb colour;
  std::string_view meaning;
};

/// Shades in the order in which they are drawn: disagreement hides agreement.
constexpr std::array<Shade, 4> kShades{{
    {Agreement::NotJudged, {110, 140, 255}, "not judged"},
    {Agreement::Good, {60, 220, 90}, "wall within half a voxel"},
    {Agreement::Fair, {250, 200, 40}, "within one voxel"},
    {Agreement::Poor, {255, 60, 60}, "farther, or no edge"},
}};

/// Text where no other text is, on a dark ground.
class Labels {
public:
  explicit Labels(Picture& picture) : m_picture(picture) {}

  /// Gives false, and draws nothing, where it would hide another or leave `panel`.
  bool put(const Panel& panel, double x, double y, std::string_view text, const Rgb& colour,
           int scale) {
    const int width = textWidth(text, scale) + 2 * scale;
    const PixelBox box{static_cast<int>(x), static_cast<int>(y), static_cast<int>(x) + width,
                       static_cast<int>(y) + 9 * scale};
    if (box.left < panel.x || box.top < panel.y || box.right > panel.x + panel.width ||
        box.bottom > panel.y + panel.height)
      return false;
    for (const PixelBox& other : m_boxes)
      if (box.left < other.right && other.left < box.right && box.top < other.bottom &&
          other.top < box.bottom)
        return false;
    m_boxes.push_back(box);
    m_picture.fill(box.left, box.top, box.right, box.bottom, {0, 0, 0});
    m_picture.text(box.left + scale, box.top + scale, scale, text, colour);
    return true;
  }

private:
  struct PixelBox {
    int left, top, right, bottom;
  };
  Picture& m_picture;
  std::vector<PixelBox> m_boxes;
};

void drawProjection(Picture& picture, const Projection& image, const Panel& panel) {
  constexpr double kDarkest = 0.01, kBrightest = 0.995;  // quantiles: single voxels set no scale
  constexpr float kGrey = 200;                           // leaves the lines the brightest
  std::vector<float> sorted = image.values;
  const float low = lowerQuantile(sorted, kDarkest), high = lowerQuantile(sorted, kBrightest);
  for (int y = 0; y < panel.height; ++y)
    for (int x = 0; x < panel.width; ++x) {
      const float value = image.at((x + 0.5) / panel.right, (y + 0.5) / panel.below);
      const float share = high > low ? std::clamp((value - low) / (high - low), 0.0F, 1.0F) : 0.0F;
      const auto grey = static_cast<std::uint8_t>(kGrey * share);
      picture.set(panel.x + x, panel.y + y, {grey, grey, grey});
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
      picture.thickLine(a[0], a[1], b[0], b[1], shade.colour);
    }
}

void drawMissing(Picture& picture, const CheckReport& report, const VolumeGeometry& geometry,
                 const Panel& panel) {
  for (const MissingVessel& vessel : report.missing.vessels)
    for (std::size_t i = 0; i + 1 < vessel.path.size(); ++i) {
      const auto a = panel.pixel(geometry.indexFromWorld(vessel.path[i].position));
      const auto b = panel.pixel(geometry.indexFromWorld(vessel.path[i + 1].position));
      picture.line(a[0], a[1], b[0], b[1], kMissing);
    }
}

/// Numbers of the longest missing vessels, then the names of branches at their last nodes; letters
/// of `least` times their smallest size and more.
void drawLabels(Labels& labels, const formats::CenterlineTree& tree, const CheckReport& report,
                const VolumeGeometry& geometry, const Panel& panel, int least) {
  const auto& vessels = report.missing.vessels;
  for (std::size_t i = 0; i < std::min(kNumbered, vessels.size()); ++i) {
    const auto& path = vessels[i].path;
    const auto at = panel.pixel(geometry.indexFromWorld(path[path.size() / 2].position));
    labels.put(panel, at[0] + 4, at[1] - 9, std::to_string(i + 1), kMissing, least + 1);
  }
  // large ones to the right, else small ones on any side: those that reach far look like another's
  const bool few = tree.branches.size() <= kManyBranches;
  for (const formats::Branch& branch : tree.branches) {
    const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
    const auto at = panel.pixel(geometry.indexFromWorld(toEigen(tree.centre[last])));
    const double wide = textWidth(branch.label, least) + 2 * least;
    if (few && labels.put(panel, at[0] + 4, at[1] - 9, branch.label, kLabel, least + 1)) continue;
    for (const auto& [x, y] :
         {std::pair{4.0, -4.0}, std::pair{-4.0 - wide, -4.0}, std::pair{-0.5 * wide, 4.0},
          std::pair{-0.5 * wide, -4.0 - 9.0 * least}})
      if (labels.put(panel, at[0] + x, at[1] + y, branch.label, kLabel, least)) break;
  }
}

std::string rounded(double value) {
  return std::to_string(std::lround(value));
}

void drawLegend(Picture& picture, int left, int top, const CheckReport& report) {
  constexpr int kSwatch = 20;
  int y = top;
  const auto line = [&](const Rgb* swatch, const std::string& text) {
    if (y + kLineHeight > picture.height) return;
    if (swatch != nullptr) picture.fill(left, y + 6, left + kSwatch, y + 10, *swatch);
    picture.text(left + (swatch != nullptr ? kSwatch + kGap : 0), y, kTextScale, text, kInk);
    y += kLineHeight;
  };
  for (const Shade& shade : kShades) line(&shade.colour, std::string(shade.meaning));
  line(&kMissing, "not in the case, longest first");
  const auto& vessels = report.missing.vessels;
  for (std::size_t i = 0; i < std::min(kNumbered, vessels.size()); ++i) {
    const Vector3d& at = vessels[i].path[vessels[i].path.size() / 2].position;
    line(nullptr, std::to_string(i + 1) + ": " + rounded(vessels[i].length) + " mm at (" +
                      rounded(at.x()) + ", " + rounded(at.y()) + ", " + rounded(at.z()) + ")");
  }
  if (vessels.size() > kNumbered)
    line(nullptr, "and " + std::to_string(vessels.size() - kNumbered) + " shorter");
}

void drawPanel(Picture& picture, const Volume& volume, const formats::CenterlineTree& tree,
               const CheckReport& report, const Panel& panel) {
  drawProjection(picture, project(volume, panel, report.options.dark ? -1.0F : 1.0F), panel);
  drawMissing(picture, report, volume.geometry, panel);
  drawTree(picture, tree, report, volume.geometry, panel);
}

}  // namespace

Rgb colourOf(Agreement agreement) {
  for (const Shade& shade : kShades)
    if (shade.agreement == agreement) return shade.colour;
  return kInk;
}

std::vector<OverlayPanel> drawOverlayPanels(const Volume& volume,
                                            const formats::CenterlineTree& tree,
                                            const CheckReport& report) {
  constexpr int kLeastText = 2;  // on paper a panel is half as large as on a screen
  std::vector<OverlayPanel> panels;
  for (Panel panel : layOut(volume.geometry, 0, 0, 0).panels) {
    panel.x = panel.y = 0;
    Picture picture(panel.width, panel.height, kBackdrop);
    drawPanel(picture, volume, tree, report, panel);
    Labels labels(picture);
    drawLabels(labels, tree, report, volume.geometry, panel, kLeastText);
    panels.push_back({panel.title, std::move(picture)});
  }
  return panels;
}

Picture drawOverlay(const Volume& volume, const formats::CenterlineTree& tree,
                    const CheckReport& report) {
  const Layout layout = layOut(volume.geometry, kGap, kLegendWidth, kLegendHeight);
  Picture picture(layout.width, layout.height, kBackdrop);
  for (const Panel& panel : layout.panels) {
    drawPanel(picture, volume, tree, report, panel);
    Labels labels(picture);
    labels.put(panel, panel.x + 2, panel.y + 2, panel.title, kInk, kTextScale);
    drawLabels(labels, tree, report, volume.geometry, panel, 1);
  }
  drawLegend(picture, layout.legendX, layout.legendY, report);
  return picture;
}

}  // namespace lumen::convert
