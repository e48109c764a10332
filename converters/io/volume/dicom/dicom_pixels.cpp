// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_pixels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gdcmDataElement.h>
#include <gdcmFragment.h>
#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>

#include "converters/base/error.h"
#include "converters/base/isolated_call.h"

namespace lumen::convert {

namespace {

// Limits of decoders: twenty times the pixels, and time at a tenth of the slowest usual rate.
constexpr std::size_t kSpareMemory = 64 << 20, kMemoryPerByte = 20;
constexpr std::size_t kSpareSeconds = 2, kBytesPerSecond = 1 << 20;

/// Properties of an image in a compressed stream.
struct StreamHeader {
  std::size_t columns = 0, rows = 0, components = 0, bits = 0;
};

class StreamBytes {
public:
  explicit StreamBytes(const std::vector<std::byte>& bytes) : m_bytes(bytes) {}
  [[nodiscard]] bool has(std::size_t at, std::size_t count) const {
    return at <= m_bytes.size() && m_bytes.size() - at >= count;
  }
  [[nodiscard]] std::size_t big(std::size_t at, std::size_t count) const {
    std::size_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
      value = value << 8U | std::to_integer<std::size_t>(m_bytes[at + i]);
    return value;
  }

private:
  const std::vector<std::byte>& m_bytes;
};

/// Properties of a JPEG or JPEG-LS stream, from the first frame header (ITU-T T.81, B.2.2).
std::optional<StreamHeader> jpegHeader(const StreamBytes& s) {
  constexpr std::size_t kStart = 0xffd8, kScan = 0xffda;
  if (!s.has(0, 4) || s.big(0, 2) != kStart) return std::nullopt;
  std::size_t at = 2;
  while (s.has(at, 4) && s.big(at, 1) == 0xff) {
    const std::size_t marker = s.big(at, 2), length = s.big(at + 2, 2);
    const bool tables = marker == 0xffc4 || marker == 0xffc8 || marker == 0xffcc;
    const bool frame = (marker >= 0xffc0 && marker <= 0xffcf && !tables) || marker == 0xfff7;
    if (marker == kScan || length < 2 || !s.has(at + 2, length)) return std::nullopt;
    if (frame && length >= 8)
      return StreamHeader{s.big(at + 7, 2), s.big(at + 5, 2), s.big(at + 9, 1), s.big(at + 4, 1)};
    at += 2 + length;
  }
  return std::nullopt;
}

/// Properties of a JPEG 2000 stream, from the image and tile sizes, which come first (ITU-T T.800,
/// A.5.1). At most as many tiles as their index counts, and an image that begins at the grid's
/// origin.
std::optional<StreamHeader> jpeg2000Header(const StreamBytes& s) {
  constexpr std::size_t kStartAndSizes = 0xff4fff51, kMaxTiles = 65535;
  if (!s.has(0, 45) || s.big(0, 4) != kStartAndSizes) return std::nullopt;
  const std::size_t width = s.big(8, 4), height = s.big(12, 4);
  const std::size_t tileWidth = s.big(24, 4), tileHeight = s.big(28, 4);
  const bool atOrigin = s.big(16, 8) == 0 && s.big(32, 8) == 0;
  if (!atOrigin || tileWidth == 0 || tileHeight == 0) return std::nullopt;
  const std::size_t across = (width + tileWidth - 1) / tileWidth;
  const std::size_t down = (height + tileHeight - 1) / tileHeight;
  if (across * down > kMaxTiles || s.big(43, 2) != 0x0101) return std::nullopt;  // not subsampled
  return StreamHeader{width, height, s.big(40, 2), (s.big(42, 1) & 0x7fU) + 1};
}

void checkStream(const DicomImage& image, const std::vector<std::byte>& stream) {
  const StreamBytes bytes(stream);
  const auto header =
      image.packing == DicomPacking::Jpeg2000 ? jpeg2000Header(bytes) : jpegHeader(bytes);
  if (!header) throw invalidInput("damaged: its compressed pixels have no sound header");
  const bool wide = header->bits > 8;
  if (header->columns == image.columns && header->rows == image.rows && header->components == 1 &&
      wide == (image.bitsAllocated == 16) && header->bits <= 16 && image.bitsAllocated <= 16)
    return;
  throw invalidInput("its compressed pixels are " + std::to_string(header->columns) + " x " +
                     std::to_string(header->rows) + " with " + std::to_string(header->components) +
                     " components of " + std::to_string(header->bits) +
                     " bits; expected, by its elements, " + std::to_string(image.columns) + " x " +
                     std::to_string(image.rows) + ", 1 of at most " +
                     std::to_string(image.bitsAllocated));
}

gdcm::DataElement pixelElement(const std::vector<std::byte>& stream) {
  gdcm::Fragment fragment;
  fragment.SetByteValue(reinterpret_cast<const char*>(stream.data()),
                        gdcm::VL(static_cast<std::uint32_t>(stream.size())));
  const gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
  fragments->AddFragment(fragment);
  gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
  pixels.SetVLToUndefined();
  pixels.SetVR(gdcm::VR::OB);
  pixels.SetValue(*fragments);
  return pixels;
}

/// Decodes a stream; false if GDCM refuses it. Runs only in a process of its own.
bool decode(const DicomImage& image, const std::vector<std::byte>& stream,
            std::span<std::byte> pixels) {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
  const auto bits = static_cast<unsigned short>(image.bitsAllocated);
  const auto stored = static_cast<unsigned short>(image.bitsStored);
  gdcm::Image decoder;
  decoder.SetNumberOfDimensions(2);
  decoder.SetDimension(0, static_cast<unsigned>(image.columns));
  decoder.SetDimension(1, static_cast<unsigned>(image.rows));
  decoder.SetPixelFormat(gdcm::PixelFormat(1, bits, stored, static_cast<unsigned short>(stored - 1),
                                           image.isSigned ? 1 : 0));
  decoder.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  decoder.SetTransferSyntax(gdcm::TransferSyntax::GetTSType(image.transferSyntax.c_str()));
  decoder.SetDataElement(pixelElement(stream));
  return decoder.GetBufferLength() == pixels.size() &&
         decoder.GetBuffer(reinterpret_cast<char*>(pixels.data()));
}

}  // namespace

std::vector<std::byte> decodeDicomFrame(const DicomImage& image,
                                        const std::vector<std::byte>& stream,
                                        const Progress& progress) {
  checkStream(image, stream);
  std::vector<std::byte> pixels(image.frameBytes());
  const std::size_t memory = kSpareMemory + kMemoryPerByte * (pixels.size() + stream.size());
  const auto seconds = static_cast<unsigned>(kSpareSeconds + pixels.size() / kBytesPerSecond);
  const IsolatedEnd end = callIsolated(
      pixels, memory, seconds, [&](std::span<std::byte> out) { return decode(image, stream, out); },
      progress);
  if (end != IsolatedEnd::Done)
    throw invalidInput(std::string("damaged: its compressed pixels ") +
                       (end == IsolatedEnd::Refused ? "cannot be decoded" : "stop the decoder") +
                       "; copy the file again");
  return pixels;
}

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

/// The fragments of a frame, by the table of offsets where frames have several.
std::span<const DicomExtent> fragmentsOf(DicomBytes& file, const DicomImage& image,
                                         std::size_t frame) {
  const std::span<const DicomExtent> all = image.pixels.fragments;
  if (image.frames == 1) return all;
  if (all.size() == image.frames) return all.subspan(frame, 1);
  const Bytes table = bytesAt(file, image.pixels.offsets);
  constexpr std::uint64_t kHead = 8;  // of a fragment, from which offsets count
  const auto indexAt = [&](std::size_t n) {
    if (n == image.frames) return all.size();
    const std::uint64_t at = all[0].at + little32(table, 4 * n);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].at == at) return i;
    throw invalidInput("damaged: its table of offsets (7fe0,0010) has " +
                       std::to_string(little32(table, 4 * n)) + " for frame " +
                       std::to_string(n + 1) + "; expected the place of a fragment, which is " +
                       std::to_string(kHead) + " bytes before its content");
  };
  const std::size_t first = indexAt(frame), end = indexAt(frame + 1);
  if (end <= first) throw invalidInput("damaged: its table of offsets (7fe0,0010) does not ascend");
  return all.subspan(first, end - first);
}

Bytes joinedFragments(DicomBytes& file, const DicomImage& image, std::size_t frame) {
  Bytes stream;
  for (const DicomExtent& fragment : fragmentsOf(file, image, frame)) {
    const Bytes part = bytesAt(file, fragment);
    stream.insert(stream.end(), part.begin(), part.end());
  }
  return stream;
}

/// The bits of a frame, each as a byte; the first is the lowest of its byte.
Bytes bitsOf(DicomBytes& file, const DicomImage& image, std::size_t frame) {
  const std::uint64_t count = image.columns * image.rows, first = frame * count;
  // words of two bytes, of which big-endian ones have the second byte first
  const bool isSwapped =
      image.packing == DicomPacking::NativeBigEndian && image.pixels.vr != std::array{'O', 'B'};
  const std::uint64_t begin = first / 16 * 2, wanted = (first + count + 15) / 16 * 2;
  const std::uint64_t end = std::min<std::uint64_t>(wanted, image.pixels.value.length);
  Bytes packed = bytesAt(file, {image.pixels.value.at + begin, end - begin});
  packed.resize(wanted - begin);
  Bytes bits(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t bit = first + i - 8 * begin;
    bits[i] = packed[isSwapped ? bit / 8 ^ 1U : bit / 8] >> (bit % 8) & std::byte{1};
  }
  return bits;
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
std::vector<T> storedValues(const Bytes& pixels, const DicomImage& image) {
  std::vector<T> values(pixels.size() / sizeof(T));
  std::memcpy(values.data(), pixels.data(), pixels.size());
  const auto unused = static_cast<unsigned>(8 * sizeof(T) - image.bitsStored);
  if (unused == 0 || image.bitsAllocated == 1) return values;
  const auto above = static_cast<unsigned>(8 * sizeof(T) - 1 - image.highBit);
  using U = std::make_unsigned_t<T>;
  for (T& value : values) {
    const auto up = static_cast<U>(static_cast<std::uint64_t>(static_cast<U>(value)) << above);
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
  return rescaled(storedValues<T>(pixels, image), image, plane);
}

Bytes unpacked(DicomBytes& file, const DicomImage& image, std::size_t frame,
               const Progress& progress) {
  switch (image.packing) {
    case DicomPacking::Native:
    case DicomPacking::NativeBigEndian:
      if (image.bitsAllocated == 1) return bitsOf(file, image, frame);
      return nativePixels(file, image, frame);
    case DicomPacking::RunLength:
      return decodeRuns(image, joinedFragments(file, image, frame));
    default:
      return decodeDicomFrame(image, joinedFragments(file, image, frame), progress);
  }
}

}  // namespace

Voxels readDicomFrame(const DicomImage& image, std::size_t frame, const Progress& progress) {
  const DicomPlane& plane = image.planeOf(frame);
  try {
    DicomBytes file(image.file);
    if (image.deflatedFrom) file.inflateFrom(*image.deflatedFrom);
    const Bytes pixels = unpacked(file, image, frame, progress);
    if (image.bitsAllocated <= 8)
      return image.isSigned ? decodeVoxels<std::int8_t>(pixels, image, plane)
                            : decodeVoxels<std::uint8_t>(pixels, image, plane);
    if (image.bitsAllocated == 16)
      return image.isSigned ? decodeVoxels<std::int16_t>(pixels, image, plane)
                            : decodeVoxels<std::uint16_t>(pixels, image, plane);
    return image.isSigned ? decodeVoxels<std::int32_t>(pixels, image, plane)
                          : decodeVoxels<std::uint32_t>(pixels, image, plane);
  } catch (const Error& error) {
    throw Error(error.kind(), image.file.path().string() + ": " + error.what());
  }
}

}  // namespace lumen::convert
