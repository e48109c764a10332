// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/meshopt_codec.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <meshoptimizer.h>

namespace lumen::convert {
namespace {

// Limits of EXT_meshopt_compression.
constexpr int kVertexVersion = 0, kIndexVersion = 1;
// Integers of the exponential filter have 24 bits with their sign.
constexpr double kMostMantissa = (1 << 23) - 1;

/// The least exponent from `exponent` on for which all values fit into 24 bits.
int exponentFor(std::span<const float> values, int exponent) {
  double most = 0;
  for (const float v : values) most = std::max(most, std::abs(double{v}));
  while (std::isfinite(most) && std::ldexp(most, -exponent) > kMostMantissa) ++exponent;
  return exponent;
}

/// Rounds floats, and returns them in the filter's form: eight bits of exponent above 24 of an
/// integer.
std::vector<std::uint32_t> roundToExponent(std::vector<unsigned char>& bytes, int exponent) {
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  exponent = exponentFor(values, exponent);
  std::vector<std::uint32_t> words;
  words.reserve(values.size());
  for (float& v : values) {
    const auto mantissa = static_cast<std::int32_t>(std::lround(std::ldexp(double{v}, -exponent)));
    words.push_back(static_cast<std::uint32_t>(exponent) << 24 |
                    (static_cast<std::uint32_t>(mantissa) & 0xffffffU));
    v = static_cast<float>(std::ldexp(static_cast<double>(mantissa), exponent));
  }
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return words;
}

}  // namespace

void orderForDrawing(MeshPart& part) {
  std::vector<std::uint32_t> index, ordered(3 * part.triangle.size());
  index.reserve(ordered.size());
  for (const Triangle& t : part.triangle) index.insert(index.end(), t.begin(), t.end());
  meshopt_optimizeVertexCache(ordered.data(), index.data(), index.size(), part.vertex.size());
  std::vector<std::uint32_t> place(part.vertex.size());
  meshopt_optimizeVertexFetchRemap(place.data(), ordered.data(), ordered.size(),
                                   part.vertex.size());
  MeshPart result = part;
  for (std::size_t v = 0; v < place.size(); ++v) {
    result.vertex[place[v]] = part.vertex[v];
    result.normal[place[v]] = part.normal[v];
  }
  for (std::size_t i = 0; i < ordered.size(); ++i)
    result.triangle[i / 3][i % 3] = place[ordered[i]];
  part = std::move(result);
}

MeshoptStream encodeVertices(VertexStream& stream) {
  MeshoptStream result;
  result.isExponential = stream.componentType == kFloat;
  const std::size_t count = stream.bytes.size() / stream.stride;
  std::vector<std::uint32_t> words;
  const void* data = stream.bytes.data();
  if (result.isExponential) {
    words = roundToExponent(stream.bytes, stream.exponent);
    data = words.data();
  }
  meshopt_encodeVertexVersion(kVertexVersion);
  result.bytes.resize(meshopt_encodeVertexBufferBound(count, stream.stride));
  result.bytes.resize(meshopt_encodeVertexBuffer(result.bytes.data(), result.bytes.size(), data,
                                                 count, stream.stride));
  return result;
}

std::vector<unsigned char> encodeTriangles(std::span<const std::uint32_t> index,
                                           std::size_t vertices) {
  meshopt_encodeIndexVersion(kIndexVersion);
  std::vector<unsigned char> bytes(meshopt_encodeIndexBufferBound(index.size(), vertices));
  bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), index.data(), index.size()));
  return bytes;
}

}  // namespace lumen::convert
