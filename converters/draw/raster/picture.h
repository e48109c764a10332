// SPDX-License-Identifier: Apache-2.0
// A picture in memory, and as a PNG file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lumen::convert {

using Rgb = std::array<std::uint8_t, 3>;

/// Rows from the top, pixels from the left.
struct Picture {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  Picture(int w, int h, const Rgb& colour)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), colour) {}

  /// Does nothing outside.
  void set(int x, int y, const Rgb& colour);
  void line(double x0, double y0, double x1, double y1, const Rgb& colour);
  /// Three pixels wide.
  void thickLine(double x0, double y0, double x1, double y1, const Rgb& colour);
  /// Fills the pixels from (x0, y0) to before (x1, y1).
  void fill(int x0, int y0, int x1, int y1, const Rgb& colour);
  /// Letters of 5 by 7 pixels, `scale` times as large, with the upper left corner at (x, y): ASCII
  /// letters, digits and the signs , . : ( ) - _ + /; others are left blank.
  /// Gives the x behind the last.
  int text(int x, int y, int scale, std::string_view letters, const Rgb& colour);
};

/// Pixels from the left side of the first letter to the right side of the last, as Picture::text()
/// draws them.
int textWidth(std::string_view letters, int scale);

/// The bytes of a PNG file. Throws Error(Failed).
std::string encodePng(const Picture& picture);

}  // namespace lumen::convert
