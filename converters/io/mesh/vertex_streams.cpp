// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/vertex_streams.h"

#include <array>
#include <cstdint>
#include <cstring>

namespace lumen::convert {
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
