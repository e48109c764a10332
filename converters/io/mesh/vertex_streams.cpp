// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/vertex_streams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "converters/base/error.h"
#include "formats/field/repeatable_math.h"

namespace lumen::convert {

namespace {

using Rgb = std::array<std::uint8_t, 3>;

// clang-format off
// Every sixteenth colour of viridis (N. Smith and S. van der Walt, 2015, for matplotlib; CC0),
// sRGB.
constexpr std::array<Rgb, 17> kViridis = {{
    {68, 1, 84},    {72, 24, 106},  {71, 45, 123},  {66, 64, 134},  {59, 82, 139},   {51, 99, 141},
    {44, 114, 142}, {38, 130, 142}, {33, 145, 140}, {31, 160, 136}, {40, 174, 128},  {63, 188, 115},
    {94, 201, 98},  {132, 212, 75}, {173, 220, 48}, {216, 226, 25}, {253, 231, 37}}};
// M. Okabe and K. Ito, Color Universal Design, 2008, without black, sRGB.
constexpr std::array<Rgb, 7> kHues = {{
    {230, 159, 0}, {86, 180, 233}, {0, 158, 115}, {240, 228, 66}, {0, 114, 178}, {213, 94, 0},
    {204, 121, 167}}};
// The same for systems of vessels, in the order of their values.
constexpr std::array<Rgb, formats::kVesselSystemCount> kSystemHues = {{
    {153, 153, 153}, {213, 94, 0}, {0, 114, 178}, {230, 159, 0}, {204, 121, 167}}};
// clang-format on

/// IEC 61966-2-1: from sRGB, 0 .. 255, to linear light.
std::uint16_t linear(double value) {
  const double s = value / 255;
  const double light = s <= 0.04045
                           ? s / 12.92
                           : field::repeatableExp(2.4 * field::repeatableLog((s + 0.055) / 1.055));
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(light, 0.0, 1.0)));
}

Color viridis(double share) {
  const double place = 16 * std::clamp(share, 0.0, 1.0);
  const std::size_t first = std::min<std::size_t>(15, static_cast<std::size_t>(place));
  const double t = place - static_cast<double>(first);
  Color color{0, 0, 0, 65535};
  for (std::size_t i = 0; i < 3; ++i)
    color[i] = linear((1 - t) * kViridis[first][i] + t * kViridis[first + 1][i]);
  return color;
}

// Position of a value between the ends of a scale. Radii use their logarithm: those of one tree
// differ by a factor of up to a hundred.
double shareOf(double value, const ColorScale& scale) {
  const double low = scale.low, high = scale.high;
  if (!(high > low)) return 0;
  if (scale.by != ColorBy::Radius || !(low > 0)) return (value - low) / (high - low);
  return field::repeatableLog(value / low) / field::repeatableLog(high / low);
}

Color hue(const Rgb& rgb) {
  return {linear(rgb[0]), linear(rgb[1]), linear(rgb[2]), 65535};
}

}  // namespace

ColorScale measureColorScale(const SurfaceMesh& surface, ColorBy by) {
  if (by == ColorBy::Confidence && surface.confidence.empty() && !surface.position.empty())
    throw invalidInput(
        "color confidence: the case has no inlier rates, which come with tracking; expected branch "
        "or radius");
  if (by == ColorBy::System && surface.systems.empty() && !surface.position.empty())
    throw invalidInput(
        "color system: the case states no system of its vessels, which comes with a label map; "
        "expected branch or radius");
  if (by != ColorBy::Radius || surface.radius.empty()) return {by, 0, 1};
  const auto [low, high] = std::minmax_element(surface.radius.begin(), surface.radius.end());
  return {by, *low, *high};
}

std::vector<Color> vertexColors(const SurfaceMesh& surface, const ColorScale& scale) {
  std::vector<Color> colors;
  colors.reserve(surface.position.size());
  if (scale.by == ColorBy::Branch)
    for (const std::uint32_t branch : surface.branch)
      colors.push_back(hue(kHues[branch % kHues.size()]));
  if (scale.by == ColorBy::System)
    for (const std::uint32_t branch : surface.branch)
      colors.push_back(hue(kSystemHues[static_cast<std::size_t>(surface.systems[branch])]));
  if (!hasRange(scale.by)) return colors;
  const std::span<const float> values =
      scale.by == ColorBy::Radius ? surface.radius : surface.confidence;
  for (const float value : values) colors.push_back(viridis(shareOf(double{value}, scale)));
  return colors;
}

std::array<double, 3> systemColor(formats::VesselSystem system) {
  const Rgb& rgb = kSystemHues[static_cast<std::size_t>(system)];
  return {rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0};
}

std::string systemColorHex(formats::VesselSystem system) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string text = "#";
  for (const std::uint8_t byte : kSystemHues[static_cast<std::size_t>(system)]) {
    text += kDigits[byte / 16];
    text += kDigits[byte % 16];
  }
  return text;
}

const char* colorMapName(ColorBy by) {
  if (by == ColorBy::System)
    return "Okabe-Ito: artery vermilion, vein blue, true-lumen orange, false-lumen purple; unknown "
           "grey";
  return by == ColorBy::Branch ? "Okabe-Ito without black, by index modulo 7" : "viridis";
}

namespace {

// A micrometre is far below the resolution of a volume; normals must be of unit length within
// 0.0005.
constexpr int kLengthExponent = -10, kNormalExponent = -12, kShareExponent = -10;
constexpr std::size_t kMostBranches = 65536;

/// `valueOf(part, i)` returns the value of vertex i of a part.
template <class ValueOf>
VertexStream fillStream(VertexStream stream, std::span<const MeshPart> parts, ValueOf valueOf) {
  for (const MeshPart& part : parts)
    for (std::size_t i = 0; i < part.vertex.size(); ++i) {
      const auto value = valueOf(part, i);
      const std::size_t at = stream.bytes.size();
      stream.bytes.resize(at + stream.stride);
      std::memcpy(stream.bytes.data() + at, &value, sizeof value);
    }
  return stream;
}

}  // namespace

std::vector<VertexStream> vertexStreams(const SurfaceMesh& surface, std::span<const MeshPart> parts,
                                        const ColorScale& scale) {
  const auto of = [&](const auto& values) {
    return [&values](const MeshPart& part, std::size_t i) { return values[part.vertex[i]]; };
  };
  const auto lengthStream = [](const char* name, std::size_t components) {
    return VertexStream{name, kFloat, components, false, 4 * components, kLengthExponent};
  };
  std::vector<VertexStream> streams;
  streams.push_back(fillStream(lengthStream("POSITION", 3), parts, of(surface.position)));
  streams.push_back(fillStream({"NORMAL", kFloat, 3, false, 12, kNormalExponent}, parts,
                               [](const MeshPart& part, std::size_t i) { return part.normal[i]; }));
  streams.push_back(fillStream(lengthStream("_RADIUS", 1), parts, of(surface.radius)));
  if (surface.labels.size() <= kMostBranches)
    streams.push_back(fillStream({"_BRANCH", kUnsignedShort, 1, false, 4, 0}, parts,
                                 [&](const MeshPart& part, std::size_t i) {
                                   return static_cast<std::uint16_t>(
                                       surface.branch[part.vertex[i]]);
                                 }));
  if (!surface.confidence.empty())
    streams.push_back(fillStream({"_CONFIDENCE", kFloat, 1, false, 4, kShareExponent}, parts,
                                 of(surface.confidence)));
  if (scale.by != ColorBy::None)
    streams.push_back(fillStream({"COLOR_0", kUnsignedShort, 4, true, 8, 0}, parts,
                                 of(vertexColors(surface, scale))));
  return streams;
}

}  // namespace lumen::convert
