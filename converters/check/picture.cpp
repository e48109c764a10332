// SPDX-License-Identifier: Apache-2.0
#include "converters/check/picture.h"

#include <algorithm>
#include <cmath>

#include <png.h>

#include "converters/common/error.h"

namespace lumen::convert {
namespace {

/// Seven rows of five pixels, the leftmost in the highest bit.
struct Glyph {
  char letter;
  std::array<std::uint8_t, 7> rows;
};

// clang-format off
constexpr std::array<Glyph, 27> kGlyphs{{
    {'a', {0x00, 0x00, 0x0e, 0x01, 0x0f, 0x11, 0x0f}}, {'b', {0x10, 0x10, 0x1e, 0x11, 0x11, 0x11, 0x1e}},
    {'c', {0x00, 0x00, 0x0e, 0x11, 0x10, 0x11, 0x0e}}, {'d', {0x01, 0x01, 0x0f, 0x11, 0x11, 0x11, 0x0f}},
    {'e', {0x00, 0x00, 0x0e, 0x11, 0x1f, 0x10, 0x0e}}, {'f', {0x06, 0x09, 0x08, 0x1c, 0x08, 0x08, 0x08}},
    {'g', {0x00, 0x0f, 0x11, 0x11, 0x0f, 0x01, 0x0e}}, {'h', {0x10, 0x10, 0x1e, 0x11, 0x11, 0x11, 0x11}},
    {'i', {0x04, 0x00, 0x0c, 0x04, 0x04, 0x04, 0x0e}}, {'j', {0x02, 0x00, 0x06, 0x02, 0x02, 0x12, 0x0c}},
    {'k', {0x10, 0x10, 0x12, 0x14, 0x18, 0x14, 0x12}}, {'l', {0x0c, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'m', {0x00, 0x00, 0x1a, 0x15, 0x15, 0x15, 0x15}}, {'n', {0x00, 0x00, 0x1e, 0x11, 0x11, 0x11, 0x11}},
    {'o', {0x00, 0x00, 0x0e, 0x11, 0x11, 0x11, 0x0e}}, {'p', {0x00, 0x1e, 0x11, 0x11, 0x1e, 0x10, 0x10}},
    {'q', {0x00, 0x0f, 0x11, 0x11, 0x0f, 0x01, 0x01}}, {'r', {0x00, 0x00, 0x16, 0x19, 0x10, 0x10, 0x10}},
    {'s', {0x00, 0x00, 0x0f, 0x10, 0x0e, 0x01, 0x1e}}, {'t', {0x08, 0x08, 0x1c, 0x08, 0x08, 0x09, 0x06}},
    {'u', {0x00, 0x00, 0x11, 0x11, 0x11, 0x11, 0x0f}}, {'v', {0x00, 0x00, 0x11, 0x11, 0x11, 0x0a, 0x04}},
    {'w', {0x00, 0x00, 0x11, 0x11, 0x15, 0x15, 0x0a}}, {'x', {0x00, 0x00, 0x11, 0x0a, 0x04, 0x0a, 0x11}},
    {'y', {0x00, 0x11, 0x11, 0x11, 0x0f, 0x01, 0x0e}}, {'z', {0x00, 0x00, 0x1f, 0x02, 0x04, 0x08, 0x1f}},
    {',', {0x00, 0x00, 0x00, 0x00, 0x0c, 0x04, 0x08}},
}};
// clang-format on

constexpr int kColumns = 5;

}  // namespace

void Picture::set(int x, int y, const Rgb& colour) {
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x)] = colour;
}

void Picture::line(double x0, double y0, double x1, double y1, const Rgb& colour) {
  const double longest = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
  // what lies far outside of the picture would take for ever
  if (!(longest <= 4.0 * (width + height))) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(longest)));
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double x = x0 + t * (x1 - x0), y = y0 + t * (y1 - y0);
    if (x < 0 || y < 0 || x >= width || y >= height) continue;
    set(static_cast<int>(x), static_cast<int>(y), colour);
  }
}

int Picture::text(int x, int y, int scale, std::string_view letters, const Rgb& colour) {
  for (const char letter : letters) {
    const auto* glyph = std::find_if(kGlyphs.begin(), kGlyphs.end(),
                                     [&](const Glyph& g) { return g.letter == letter; });
    for (int row = 0; glyph != kGlyphs.end() && row < 7 * scale; ++row)
      for (int column = 0; column < kColumns * scale; ++column)
        if ((glyph->rows[static_cast<std::size_t>(row / scale)] >> (kColumns - 1 - column / scale) &
             1) != 0)
          set(x + column, y + row, colour);
    x += (kColumns + 1) * scale;
  }
  return x;
}

std::string encodePng(const Picture& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  const auto write = [&](void* to) {
    return png_image_write_to_memory(&image, to, &size, 0, picture.pixels.data(), 0, nullptr);
  };
  std::string bytes;
  bool written = write(nullptr) != 0;
  if (written) {
    bytes.resize(size);
    written = write(bytes.data()) != 0;
  }
  if (!written) throw failed(std::string("the picture cannot be encoded: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace lumen::convert
