// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom_codec.h"

#include <optional>
#include <span>
#include <string>

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

}  // namespace lumen::convert
