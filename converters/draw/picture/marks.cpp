// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "converters/base/shown_text.h"

namespace lumen::convert {

namespace {

constexpr int kLeastPicture = 160;  // pixels
constexpr double kSideways = 0.38;  // sin(22.5 degrees)
constexpr int kLetterWidth = 6, kLetterHeight = 7;

/// Size of a letter's pixels, and width of lines.
int letterScale(int width, int height) {
  return std::max(1, std::min(width, height) / 400);
}

int letterScale(const Picture& picture) {
  return letterScale(picture.width, picture.height);
}

}  // namespace

int roomForMarks(int width, int height) {
  if (std::min(width, height) < kLeastPicture) return 0;
  return 28 * letterScale(width, height);
}

ScaleBar makeScaleBar(const Camera& camera) {
  const double most = 0.2 * camera.width / camera.scale;
  const double power = std::pow(10, std::floor(std::log10(most)));
  ScaleBar bar{power, 0};
  for (const double times : {2.0, 5.0})
    if (times * power <= most) bar.length = times * power;
  bar.pixels = static_cast<int>(std::lround(bar.length * camera.scale));
  return bar;
}

void drawScaleBar(Picture& picture, const Camera& camera, const Rgb& ink) {
  const ScaleBar bar = makeScaleBar(camera);
  const int scale = letterScale(picture), x = 8 * scale, y = picture.height - 8 * scale;
  picture.fill(x, y - scale, x + bar.pixels, y, ink);
  picture.fill(x, y - 3 * scale, x + scale, y + 2 * scale, ink);
  picture.fill(x + bar.pixels - scale, y - 3 * scale, x + bar.pixels, y + 2 * scale, ink);
  picture.text(x, y - (5 + kLetterHeight) * scale, scale, shownNumber(bar.length) + " mm", ink);
}

std::string sidesTowards(const Eigen::Vector3d& direction) {
  constexpr std::array<char, 3> kPositive{'L', 'P', 'S'}, kNegative{'R', 'A', 'I'};
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(),
                   [&](int a, int b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  std::string sides;
  for (const int axis : axes)
    if (sides.empty() || std::abs(direction[axis]) > kSideways)
      sides += (direction[axis] >= 0 ? kPositive : kNegative)[static_cast<std::size_t>(axis)];
  return sides;
}

void drawSides(Picture& picture, const Camera& camera, const Rgb& ink) {
  const int scale = letterScale(picture), edge = 4 * scale;
  const int middle = (picture.height - kLetterHeight * scale) / 2;
  const Eigen::Vector3d right = camera.axes.row(0), up = camera.axes.row(1);
  const auto centred = [&](int y, const std::string& text) {
    picture.text((picture.width - textWidth(text, scale)) / 2, y, scale, text, ink);
  };
  picture.text(edge, middle, scale, sidesTowards(-right), ink);
  const std::string side = sidesTowards(right);
  picture.text(picture.width - edge - textWidth(side, scale), middle, scale, side, ink);
  centred(edge, sidesTowards(up));
  centred(picture.height - edge - kLetterHeight * scale, sidesTowards(-up));
}

void drawLegend(Picture& picture, const Legend& legend, const Rgb& ink) {
  const int scale = letterScale(picture), letter = kLetterWidth * scale;
  const std::size_t count = legend.values.size();
  const bool isNamed = count == legend.colours.size();
  std::vector<int> widths;  // with a letter's room between two values
  for (const std::string& value : legend.values) widths.push_back(textWidth(value, scale) + letter);
  const int titleWidth = textWidth(legend.title, scale);
  int length = std::accumulate(widths.begin(), widths.end(), isNamed ? 0 : -letter);
  if (!isNamed) length = std::max({length, picture.width / 4, titleWidth});
  const int x0 = picture.width - 8 * scale - length;
  const int values = picture.height - (4 + kLetterHeight) * scale;
  const int bar = values - 7 * scale, title = bar - (2 + kLetterHeight) * scale;
  const auto fill = [&](int from, int to, std::size_t colour) {
    picture.fill(from, bar, to, bar + 5 * scale, legend.colours[colour]);
  };
  if (isNamed) {  // the sides of the patient stand in the row of values
    picture.text(x0 - titleWidth - letter, bar - scale, scale, legend.title, ink);
    for (std::size_t i = 0, x = 0; i < count; x += static_cast<std::size_t>(widths[i++])) {
      const int at = x0 + static_cast<int>(x);
      fill(at, at + widths[i], i);
      picture.text(at, title, scale, legend.values[i], ink);
    }
    return;
  }
  for (int x = 0; x < length; ++x)
    fill(x0 + x, x0 + x + 1,
         static_cast<std::size_t>(x) * legend.colours.size() / static_cast<std::size_t>(length));
  picture.text(x0, title, scale, legend.title, ink);
  const int steps = std::max(1, static_cast<int>(count) - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const int room = length - textWidth(legend.values[i], scale);
    picture.text(x0 + room * static_cast<int>(i) / steps, values, scale, legend.values[i], ink);
  }
}

}  // namespace lumen::convert
