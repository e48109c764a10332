// SPDX-License-Identifier: Apache-2.0
// PNG files beside those of libpng.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>

#include "converters/draw/raster/picture.h"

namespace lumen::convert {
namespace {

/// Sizes about those where libpng leaves out filters, lowers zlib's window or begins a new chunk.
std::vector<Picture> pictures() {
  std::vector<Picture> all;
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {1, 1}, {1, 40}, {40, 1}, {2, 3}, {60, 80}, {73, 74}, {300, 200}}) {
    Picture& shades = all.emplace_back(width, height, Rgb{});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        shades.set(x, y,
                   {static_cast<std::uint8_t>(3 * x), static_cast<std::uint8_t>(x * y),
                    static_cast<std::uint8_t>(y * y)});
    Picture& text = all.emplace_back(width, height, Rgb{255, 255, 255});
    text.line(0, 0, width, height, {200, 0, 0});
    text.text(2, 2, 1, "lumen", {0, 0, 0});
  }
  return all;
}

TEST(PngFile, LibpngReadsThePixels) {
  for (const Picture& picture : pictures()) {
    const std::string file = encodePng(picture);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&image, file.data(), file.size()), 0)
        << image.message;
    ASSERT_EQ(static_cast<int>(image.width), picture.width);
    ASSERT_EQ(static_cast<int>(image.height), picture.height);
    image.format = PNG_FORMAT_RGB;
    std::vector<Rgb> pixels(picture.pixels.size());
    ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0)
        << image.message;
    EXPECT_EQ(image.warning_or_error, 0U) << image.message;
    EXPECT_TRUE(pixels == picture.pixels) << picture.width << " x " << picture.height;
  }
}

TEST(PngFile, HasTheBytesOfLibpng) {
  for (const Picture& picture : pictures()) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(picture.width);
    image.height = static_cast<png_uint_32>(picture.height);
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = 0;
    ASSERT_NE(
        png_image_write_to_memory(&image, nullptr, &size, 0, picture.pixels.data(), 0, nullptr), 0);
    std::string file(size, '\0');
    ASSERT_NE(
        png_image_write_to_memory(&image, file.data(), &size, 0, picture.pixels.data(), 0, nullptr),
        0);
    EXPECT_TRUE(encodePng(picture) == file) << picture.width << " x " << picture.height;
  }
}

}  // namespace
}  // namespace lumen::convert
