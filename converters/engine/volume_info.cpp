// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/volume_info.h"

#include <algorithm>
#include <sstream>
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

template <std::size_t N>
std::string joined(const std::array<double, N>& values, std::size_t first, std::size_t count) {
  std::string text;
  for (std::size_t i = first; i < first + count; ++i)
    text.append(i > first ? "  " : "").append(shownNumber(values[i]));
  return text;
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
  }
  json["stored_type"] = header.storedType;
  json["encoding"] = header.encoding;
  json["voxel_bytes"] = header.voxelBytes;
  json["stored_bytes"] = header.storedBytes;
  return json;
}

std::string volumeInfoText(const VolumeInfo& info) {
  const convert::VolumeHeader& header = info.header;
  const auto s = convert::describeGeometry(header.geometry);
  std::ostringstream text;
  text << "size        " << s.size[0] << " x " << s.size[1] << " x " << s.size[2] << " voxels\n"
       << "spacing     " << joined(s.spacing, 0, 3) << " mm\n"
       << "origin      " << joined(s.origin, 0, 3) << " mm, LPS\n"
       << "direction   " << joined(s.direction, 0, 3) << "\n"
       << "            " << joined(s.direction, 3, 3) << "\n"
       << "            " << joined(s.direction, 6, 3) << "\n"
       << "stored      " << header.storedType << ", " << header.encoding << ": "
       << header.voxelBytes << " bytes of voxels in " << header.storedBytes << " bytes\n";
  if (info.values)
    text << "pixel type  " << info.values->pixelType << "\n"
         << "values      " << shownNumber(info.values->min) << " to "
         << shownNumber(info.values->max) << "\n"
         << "sha256      " << info.values->sha256 << "\n";
  else
    text << "values      not read; --voxels reads them\n";
  return text.str();
}

}  // namespace lumen::engine
