// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_file.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "converters/base/error.h"
#include "converters/io/volume/dicom/dicom_values.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr DicomSyntax kExplicit{.explicitVr = true, .bigEndian = false};
// clang-format off
constexpr std::array<DicomTransfer, 13> kTransfers = {{
    {"1.2.840.10008.1.2", {.explicitVr = false, .bigEndian = false}, DicomPacking::Native},
    {"1.2.840.10008.1.2.1", kExplicit, DicomPacking::Native},
    {"1.2.840.10008.1.2.1.99", kExplicit, DicomPacking::Native, true},
    {"1.2.840.10008.1.2.2", {.explicitVr = true, .bigEndian = true}, DicomPacking::NativeBigEndian},
    {"1.2.840.10008.1.2.4.50", kExplicit, DicomPacking::Jpeg},
    {"1.2.840.10008.1.2.4.51", kExplicit, DicomPacking::Jpeg},
    {"1.2.840.10008.1.2.4.57", kExplicit, DicomPacking::Jpeg},
    {"1.2.840.10008.1.2.4.70", kExplicit, DicomPacking::Jpeg},
    {"1.2.840.10008.1.2.4.80", kExplicit, DicomPacking::JpegLs},
    {"1.2.840.10008.1.2.4.81", kExplicit, DicomPacking::JpegLs},
    {"1.2.840.10008.1.2.4.90", kExplicit, DicomPacking::Jpeg2000},
    {"1.2.840.10008.1.2.4.91", kExplicit, DicomPacking::Jpeg2000},
    {"1.2.840.10008.1.2.5", kExplicit, DicomPacking::RunLength}}};
// clang-format on

}  // namespace

DicomBeginning readDicomBeginning(DicomBytes& bytes) {
  constexpr std::uint64_t kMarkEnd = 132;
  std::array<std::byte, 4> mark{};
  if (bytes.size() >= kMarkEnd) bytes.read(kMarkEnd - mark.size(), mark);
  if (std::memcmp(mark.data(), "DICM", mark.size()) == 0) return {true, kMarkEnd, true, true, true};
  std::array<std::byte, 8> head{};
  if (bytes.size() < head.size()) return {};
  bytes.read(0, head);
  const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(head[i]); };
  const bool isGroup = (byte(0) == 2 || byte(0) == 8) && byte(1) == 0;
  if (!isGroup || byte(2) >= 0x20 || byte(3) != 0) return {};
  const std::array vr = {static_cast<char>(head[4]), static_cast<char>(head[5])};
  return {true, 0, byte(0) == 2, false, isRepresentation(vr)};
}

const DicomTransfer& findTransfer(const std::string& uid) {
  const auto* const found =
      std::find_if(kTransfers.begin(), kTransfers.end(),
                   [&](const DicomTransfer& syntax) { return uid == syntax.uid; });
  if (found == kTransfers.end())
    throw unsupported("its transfer syntax is \"" + formats::printable(uid) +
                      "\"; expected plain or deflated pixels, JPEG, JPEG-LS, JPEG 2000 or RLE; "
                      "GDCM's gdcmconv and DCMTK's dcmconv unpack others");
  return *found;
}

DicomMeta readDicomMeta(DicomBytes& bytes, const DicomBeginning& beginning) {
  if (!beginning.hasMeta)
    return {beginning.explicitVr ? "1.2.840.10008.1.2.1" : "1.2.840.10008.1.2", {}, beginning.at};
  DicomValues values;
  DicomMeta meta;
  meta.end =
      walkDicomMeta(bytes, beginning.at, [&](const DicomElement& element, const DicomPlace& place) {
        if (place.path.empty()) addDicomValue(bytes, element, values);
      });
  const DicomReader reader(values, false);
  meta.transferSyntax = reader.text(0x00020010);
  meta.storage = reader.text(0x00020002);
  return meta;
}

}  // namespace lumen::convert
