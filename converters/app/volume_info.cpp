// SPDX-License-Identifier: Apache-2.0
#include "converters/app/volume_info.h"

#include <algorithm>
#include <sstream>
#include <type_traits>

#include "converters/volume/read_volume.h"
#include "converters/volume/write_volume.h"

namespace lumen::app {

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
  std::ostringstream text;
  for (std::size_t i = first; i < first + count; ++i) text << (i > first ? "  " : "") << values[i];
  return text.str();
}

std::string shortNumber(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

VolumeInfo describeVolume(const convert::Volume& volume, Progress& progress) {
  progress.begin("hashing", 0);
  VolumeInfo info;
  info.source = convert::describeSource(volume);
  progress.check();
  std::visit(
      [&](const auto& voxels) {
        const auto [low, high] = std::minmax_element(voxels.begin(), voxels.end());
        info.pixelType = pixelTypeName<std::decay_t<decltype(*low)>>();
        info.min = static_cast<double>(*low);
        info.max = static_cast<double>(*high);
      },
      volume.voxels);
  progress.end();
  return info;
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
  Json json = sourceVolumeJson(info.source);
  json["pixel_type"] = info.pixelType;
  json["min"] = jsonNumber(info.min);
  json["max"] = jsonNumber(info.max);
  return json;
}

std::string volumeInfoText(const VolumeInfo& info) {
  const auto& s = info.source;
  std::ostringstream size;
  size << s.size[0] << " x " << s.size[1] << " x " << s.size[2] << " voxels";
  std::ostringstream text;
  text << "size        " << size.str() << "\n"
       << "spacing     " << joined(s.spacing, 0, 3) << " mm\n"
       << "origin      " << joined(s.origin, 0, 3) << " mm, LPS\n"
       << "direction   " << joined(s.direction, 0, 3) << "\n"
       << "            " << joined(s.direction, 3, 3) << "\n"
       << "            " << joined(s.direction, 6, 3) << "\n"
       << "pixel type  " << info.pixelType << "\n"
       << "values      " << shortNumber(info.min) << " to " << shortNumber(info.max) << "\n"
       << "sha256      " << s.sha256 << "\n";
  return text.str();
}

}  // namespace lumen::app
