// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom_pixels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/io/volume/dicom_codec.h"

namespace lumen::convert {
namespace {

using Bytes = std::vector<std::byte>;

Bytes bytesAt(DicomBytes& file, const DicomExtent& extent) {
  Bytes bytes(extent.length);
  file.read(extent.at, bytes);
  return bytes;
}

std::uint32_t little32(const Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;)
    value = value << 8U | std::to_integer<std::uint32_t>(bytes[at + i]);
  return value;
}

/// Unpacks runs into every `step`-th byte of `to` from `first` on; false if they are too short.
bool unpackRuns(std::span<const std::byte> from, std::size_t first, std::size_t step, Bytes& to) {
  std::size_t at = first, next = 0;
  while (at < to.size()) {
    if (next >= from.size()) return false;
    const auto code = std::to_integer<std::size_t>(from[next++]);
    constexpr std::size_t kNothing = 128, kRepeated = 257;
    if (code == kNothing) continue;
    const bool repeats = code > kNothing;
    const std::size_t count = repeats ? kRepeated - code : code + 1;
    if (from.size() - next < (repeats ? 1 : count)) return false;
    for (std::size_t i = 0; i < count && at < to.size(); ++i, at += step)
      to[at] = from[next + (repeats ? 0 : i)];
    next += repeats ? 1 : count;
  }
  return true;
}

/// Run-length encoding (DICOM PS3.5, annex G): one segment for each byte of a pixel, highest first.
Bytes decodeRuns(const DicomImage& image, const Bytes& stream) {
  constexpr std::size_t kHeader = 64;
  const std::size_t bytes = image.bitsAllocated / 8;
  const auto refuse = [] {
    return invalidInput("damaged: its run-length encoded pixels are not those of one image");
  };
  if (stream.size() < kHeader || little32(stream, 0) != bytes) throw refuse();
  Bytes pixels(image.frameBytes());
  for (std::size_t segment = 0; segment < bytes; ++segment) {
    const std::size_t begin = little32(stream, 4 + 4 * segment);
    const std::size_t end = segment + 1 < bytes ? little32(stream, 8 + 4 * segment) : stream.size();
    if (begin < kHeader || begin > end || end > stream.size()) throw refuse();
    const std::size_t place =
        std::endian::native == std::endian::little ? bytes - 1 - segment : segment;
    if (!unpackRuns(std::span(stream).subspan(begin, end - begin), place, bytes, pixels))
      throw refuse();
  }
  return pixels;
}

Bytes joinedFragments(DicomBytes& file, const DicomImage& image, std::size_t frame) {
  const auto& fragments = image.pixels.fragments;
  if (image.frames > 1) return bytesAt(file, fragments[frame]);
  Bytes stream;
  for (const DicomExtent& fragment : fragments) {
    const Bytes part = bytesAt(file, fragment);
    stream.insert(stream.end(), part.begin(), part.end());
  }
  return stream;
}

Bytes nativePixels(DicomBytes& file, const DicomImage& image, std::size_t frame) {
  const std::size_t size = image.frameBytes();
  Bytes pixels = bytesAt(file, {image.pixels.value.at + frame * size, size});
  const bool big = image.packing == DicomPacking::NativeBigEndian;
  if (big == (std::endian::native == std::endian::big)) return pixels;
  const auto step = static_cast<std::ptrdiff_t>(image.bitsAllocated / 8);
  for (auto at = pixels.begin(); at != pixels.end(); at += step) std::reverse(at, at + step);
  return pixels;
}

/// The values of pixels in T, from the used bits.
template <class T>
std::vector<T> storedValues(const Bytes& pixels, std::size_t bitsStored) {
  std::vector<T> values(pixels.size() / sizeof(T));
  std::memcpy(values.data(), pixels.data(), pixels.size());
  const auto unused = static_cast<unsigned>(8 * sizeof(T) - bitsStored);
  if (unused == 0) return values;
  using U = std::make_unsigned_t<T>;
  for (T& value : values) {
    const auto up = static_cast<U>(static_cast<std::uint64_t>(static_cast<U>(value)) << unused);
    value = static_cast<T>(static_cast<T>(up) >> unused);  // shifts the sign down, if T is signed
  }
  return values;
}

template <class To, class From, class Function>
std::vector<To> mapped(const std::vector<From>& from, Function function) {
  std::vector<To> to(from.size());
  std::transform(from.begin(), from.end(), to.begin(),
                 [&](From v) { return static_cast<To>(function(v)); });
  return to;
}

/// Stored values as the narrowest volume type that holds every value of their bits.
template <class T>
Voxels rescaled(const std::vector<T>& stored, const DicomImage& image, const DicomPlane& plane) {
  const double slope = plane.slope.value_or(1), intercept = plane.intercept.value_or(0);
  const auto scale = [=](T v) { return slope * static_cast<double>(v) + intercept; };
  if (slope == 1 && intercept == 0) {
    if constexpr (sizeof(T) == 4)
      return mapped<float>(stored, scale);
    else if constexpr (std::is_same_v<T, std::int8_t>)
      return mapped<std::int16_t>(stored, scale);
    else
      return stored;
  }
  if (slope != std::trunc(slope) || intercept != std::trunc(intercept))
    return mapped<float>(stored, scale);
  const double half = std::ldexp(1.0, static_cast<int>(image.bitsStored) - 1);
  const double one = scale(0) + slope * (image.isSigned ? -half : 0);
  const double other = scale(0) + slope * (image.isSigned ? half - 1 : 2 * half - 1);
  const double low = std::min(one, other), high = std::max(one, other);
  const auto fits = [&]<class U>(U) {
    return low >= static_cast<double>(std::numeric_limits<U>::min()) &&
           high <= static_cast<double>(std::numeric_limits<U>::max());
  };
  if (fits(std::uint8_t{})) return mapped<std::uint8_t>(stored, scale);
  if (low < 0 && fits(std::int16_t{})) return mapped<std::int16_t>(stored, scale);
  if (fits(std::uint16_t{})) return mapped<std::uint16_t>(stored, scale);
  return mapped<float>(stored, scale);
}

template <class T>
Voxels decodeVoxels(const Bytes& pixels, const DicomImage& image, const DicomPlane& plane) {
  return rescaled(storedValues<T>(pixels, image.bitsStored), image, plane);
}

Bytes unpacked(DicomBytes& file, const DicomImage& image, std::size_t frame,
               const Progress& progress) {
  switch (image.packing) {
    case DicomPacking::Native:
    case DicomPacking::NativeBigEndian:
      return nativePixels(file, image, frame);
    case DicomPacking::RunLength:
      return decodeRuns(image, joinedFragments(file, image, frame));
    default:
      return decodeDicomFrame(image, joinedFragments(file, image, frame), progress);
  }
}

}  // namespace

Voxels readDicomFrame(const DicomImage& image, std::size_t frame, const Progress& progress) {
  const DicomPlane& plane = image.perFrame.empty() ? image.plane : image.perFrame[frame];
  try {
    DicomBytes file(image.file);
    const Bytes pixels = unpacked(file, image, frame, progress);
    if (image.bitsAllocated == 8)
      return image.isSigned ? decodeVoxels<std::int8_t>(pixels, image, plane)
                            : decodeVoxels<std::uint8_t>(pixels, image, plane);
    if (image.bitsAllocated == 16)
      return image.isSigned ? decodeVoxels<std::int16_t>(pixels, image, plane)
                            : decodeVoxels<std::uint16_t>(pixels, image, plane);
    return image.isSigned ? decodeVoxels<std::int32_t>(pixels, image, plane)
                          : decodeVoxels<std::uint32_t>(pixels, image, plane);
  } catch (const Error& error) {
    throw Error(error.kind(), image.file.string() + ": " + error.what());
  }
}

}  // namespace lumen::convert
