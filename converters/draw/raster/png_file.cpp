// SPDX-License-Identifier: Apache-2.0
// Declared in picture.h: PNG files (ISO/IEC 15948) of pixels in sRGB, with the choices of libpng.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>

#include <zlib.h>

#include "converters/base/error.h"
#include "converters/draw/raster/picture.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kPixelBytes = 3;
using PngRow = std::vector<std::uint8_t>;

/// The neighbour of a byte that the gradient of left, up and upper left predicts.
int paeth(int left, int up, int corner) {
  const int gradient = left + up - corner;
  const int toLeft = std::abs(gradient - left), toUp = std::abs(gradient - up);
  const int toCorner = std::abs(gradient - corner);
  if (toLeft <= toUp && toLeft <= toCorner) return left;
  return toUp <= toCorner ? up : corner;
}

/// Fills `to` with the number of a filter and the row `row`, filtered; `above` is the row before.
void filterRow(std::uint8_t filter, std::span<const std::uint8_t> row,
               std::span<const std::uint8_t> above, PngRow& to) {
  to[0] = filter;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int left = i < kPixelBytes ? 0 : row[i - kPixelBytes];
    const int corner = i < kPixelBytes ? 0 : above[i - kPixelBytes];
    const std::array predicted = {0, left, int{above[i]}, (left + above[i]) / 2,
                                  paeth(left, above[i], corner)};
    to[i + 1] = static_cast<std::uint8_t>(row[i] - predicted[filter]);
  }
}

/// The sum of the bytes' magnitudes, as numbers with a sign: a small one packs well.
std::size_t magnitudeOf(std::span<const std::uint8_t> bytes) {
  std::size_t sum = 0;
  for (const std::uint8_t byte : bytes) sum += byte < 128 ? byte : 256U - byte;
  return sum;
}

/// All rows, each by the filter that leaves the smallest numbers.
PngRow filteredRows(const Picture& picture) {
  const std::size_t size = kPixelBytes * static_cast<std::size_t>(picture.width);
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(picture.pixels.data());
  const PngRow none(size);
  PngRow all, row(size + 1), best;
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    std::size_t least = SIZE_MAX;
    for (std::uint8_t filter = 0; filter < 5; ++filter) {
      const bool needsAbove = filter >= 2, needsLeft = filter == 1 || filter >= 3;
      if ((needsAbove && picture.height == 1) || (needsLeft && picture.width == 1)) continue;
      filterRow(filter, {bytes + y * size, size},
                y == 0 ? std::span(none) : std::span(bytes + (y - 1) * size, size), row);
      const std::size_t magnitude = magnitudeOf(std::span(row).subspan(1));
      if (magnitude >= least) continue;
      least = magnitude;
      best = row;
    }
    all.insert(all.end(), best.begin(), best.end());
  }
  return all;
}

/// Lowers the window in the head of zlib's bytes, which readers allocate, to what `size` bytes need.
void lowerWindow(std::string& bytes, std::size_t size) {
  constexpr unsigned kDeflate = 8, kLevelBits = 0xe0, kCheck = 31;
  unsigned window = static_cast<std::uint8_t>(bytes[0]) >> 4;
  while (window > 0 && size <= std::size_t{1} << (window + 7)) --window;
  const unsigned first = window << 4 | kDeflate;
  const unsigned second = static_cast<std::uint8_t>(bytes[1]) & kLevelBits;
  bytes[0] = static_cast<char>(first);
  bytes[1] = static_cast<char>(second + kCheck - (first << 8 | second) % kCheck);
}

std::string packed(const PngRow& rows) {
  constexpr int kMemory = 8;
  constexpr std::size_t kLookAhead = 262;  // of zlib, beyond its window
  const bool isSmall = rows.size() <= 1U << 14;
  int bits = MAX_WBITS;
  while (isSmall && rows.size() + kLookAhead <= std::size_t{1} << (bits - 1)) --bits;
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, bits, kMemory, Z_FILTERED) != Z_OK)
    throw failed("the picture cannot be encoded: zlib has no memory");
  std::string bytes(deflateBound(&stream, rows.size()), '\0');
  stream.next_in = const_cast<Bytef*>(rows.data());
  stream.avail_in = static_cast<uInt>(rows.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  const int end = deflate(&stream, Z_FINISH);
  bytes.resize(stream.total_out);
  deflateEnd(&stream);
  if (end != Z_STREAM_END) throw failed("the picture cannot be encoded: it is too large");
  if (isSmall) lowerWindow(bytes, rows.size());
  return bytes;
}

std::string bigEndian(std::size_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

void addChunk(std::string& file, const std::string& name, std::string_view content) {
  const std::string checked = name + std::string(content);
  const auto* const bytes = reinterpret_cast<const Bytef*>(checked.data());
  file += bigEndian(content.size()) + checked +
          bigEndian(crc32(0, bytes, static_cast<uInt>(checked.size())));
}

}  // namespace

std::string encodePng(const Picture& picture) {
  constexpr std::size_t kMostInChunk = 8192;
  std::string file = "\x89PNG\r\n\x1a\n";
  const auto width = static_cast<std::size_t>(picture.width);
  const auto height = static_cast<std::size_t>(picture.height);
  // 8 bits, of red, green and blue, not interlaced
  addChunk(file, "IHDR", bigEndian(width) + bigEndian(height) + std::string("\x08\x02\0\0\0", 5));
  addChunk(file, "sRGB", std::string(1, '\0'));
  const std::string content = packed(filteredRows(picture));
  for (std::size_t at = 0; at < content.size(); at += kMostInChunk)
    addChunk(file, "IDAT", std::string_view(content).substr(at, kMostInChunk));
  addChunk(file, "IEND", "");
  return file;
}

}  // namespace lumen::convert
