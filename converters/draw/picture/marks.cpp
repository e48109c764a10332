// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

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
  const int scale = letterScale(picture), margin = 8 * scale;
  const auto count = static_cast<int>(legend.values.size());
  const bool isNamed = legend.values.size() == legend.colours.size();  // a name below each colour
  int least = -kLetterWidth * scale, widest = 0;  // with a letter's room between two values
  for (const std::string& value : legend.values) {
    least += textWidth(value, scale) + kLetterWidth * scale;
    widest = std::max(widest, textWidth(value, scale) + kLetterWidth * scale);
  }
  if (isNamed) least = count * widest;
  const int length = std::max({picture.width / 4, textWidth(legend.title, scale), least});
  const int x0 = picture.width - margin - length;
  const int bottom = picture.height - 4 * scale, values = bottom - kLetterHeight * scale;
  const int bar = values - 7 * scale, title = bar - (2 + kLetterHeight) * scale;
  for (int x = 0; x < length; ++x) {
    const std::size_t colour =
        static_cast<std::size_t>(x) * legend.colours.size() / static_cast<std::size_t>(length);
    picture.fill(x0 + x, bar, x0 + x + 1, bar + 5 * scale, legend.colours[colour]);
  }
  picture.text(x0, title, scale, legend.title, ink);
  for (std::size_t i = 0; i < legend.values.size(); ++i) {
    const int room = isNamed ? length : length - textWidth(legend.values[i], scale);
    const int steps = isNamed ? count : std::max(1, count - 1);
    picture.text(x0 + room * static_cast<int>(i) / steps, values, scale, legend.values[i], ink);
  }
}

}  // namespace lumen::convert
