// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/volume_info.h"

#include <algorithm>
#include <span>
#include <type_traits>

#include "converters/base/shown_text.h"
#include "converters/io/volume/read_volume.h"
#include "converters/io/volume/write_volume.h"

namespace lumen::engine {

namespace {

template <class T>
std::string pixelTypeName() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return "uint8";
  if constexpr (std::is_same_v<T, std::int16_t>) return "int16";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "uint16";
  return "float32";
}

/// Three numbers from `first` on, two spaces apart.
std::string threeOf(std::span<const double> values, std::size_t first = 0) {
  return joinedNumbers(values.subspan(first, 3), "  ");
}

}  // namespace

VolumeInfo describeVolume(const convert::VolumeHeader& header, const convert::Volume& volume,
                          Progress& progress) {
  progress.begin("hashing", 0);
  VolumeInfo::Values values;
  values.sha256 = convert::describeSource(volume).sha256;
  progress.check();
  std::visit(
      [&](const auto& voxels) {
        const auto [low, high] = std::minmax_element(voxels.begin(), voxels.end());
        values.pixelType = pixelTypeName<std::decay_t<decltype(*low)>>();
        values.min = static_cast<double>(*low);
        values.max = static_cast<double>(*high);
      },
      volume.voxels);
  progress.end();
  return {header, values};
}

Json sourceVolumeJson(const formats::SourceVolume& source) {
  Json json;
  json["size"] = source.size;
  json["spacing_mm"] = source.spacing;
  json["origin_mm"] = source.origin;
  json["direction"] = source.direction;
  json["sha256"] = source.sha256;
  return json;
}

Json volumeInfoJson(const VolumeInfo& info) {
  const convert::VolumeHeader& header = info.header;
  Json json = sourceVolumeJson(convert::describeGeometry(header.geometry));
  json.erase("sha256");
  if (info.values) {
    json["sha256"] = info.values->sha256;
    json["pixel_type"] = info.values->pixelType;
    json["min"] = jsonNumber(info.values->min);
    json["max"] = jsonNumber(info.values->max);
    json["labels"] = labelsJson(info.values->labels);
  }
  json["placed_by"] = header.placedBy.empty() ? Json(nullptr) : Json(header.placedBy);
  json["resampled"] = header.resampled.empty() ? Json(nullptr) : Json(header.resampled);
  json["stored_type"] = header.storedType;
  json["encoding"] = header.encoding;
  json["voxel_bytes"] = header.voxelBytes;
  json["stored_bytes"] = header.storedBytes;
  return json;
}

std::string volumeInfoText(const VolumeInfo& info) {
  const convert::VolumeHeader& header = info.header;
  const auto s = convert::describeGeometry(header.geometry);
  Lines lines(kNarrowColumn);
  lines.add("size", joinedNumbers(s.size, " x ") + " voxels");
  lines.add("spacing", threeOf(s.spacing) + " mm");
  lines.add("origin", threeOf(s.origin) + " mm, LPS");
  lines.add("direction", threeOf(s.direction));
  lines.add("", threeOf(s.direction, 3));
  lines.add("", threeOf(s.direction, 6));
  if (!header.placedBy.empty()) lines.add("placed by", header.placedBy);
  lines.add("stored", header.storedType + ", " + header.encoding + ": " +
                          std::to_string(header.voxelBytes) + " bytes of voxels in " +
                          std::to_string(header.storedBytes) + " bytes");
  if (!info.values) return lines.add("values", "not read; --voxels reads them").text();
  lines.add("pixel type", info.values->pixelType);
  lines.add("values", shownNumber(info.values->min) + " to " + shownNumber(info.values->max));
  return lines.add("sha256", info.values->sha256).text() + labelLines(info.values->labels);
}

}  // namespace lumen::engine
