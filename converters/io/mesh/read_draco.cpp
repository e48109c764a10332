// SPDX-License-Identifier: Apache-2.0
// Declared in mesh_readers.h.
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include <draco/compression/decode.h>

#include "converters/base/isolated_call.h"
#include "converters/io/mesh/read_mesh.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kMostPerByte = 64;
constexpr std::size_t kMemoryEach = 1024;  // bytes for a point or triangle while it is decoded
constexpr std::size_t kMemory = std::size_t{64} << 20;
constexpr unsigned kSeconds = 60;

bool decodeInto(std::string_view bytes, std::uint32_t id, DecodedDraco& decoded) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  auto status = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!status.ok()) return false;
  const std::unique_ptr<draco::Mesh> mesh = std::move(status).value();
  const draco::PointAttribute* positions = mesh->GetAttributeByUniqueId(id);
  if (positions == nullptr || mesh->num_points() != decoded.position.size() ||
      mesh->num_faces() != decoded.triangle.size())
    return false;
  for (draco::PointIndex i(0); i < mesh->num_points(); ++i)
    if (!positions->ConvertValue<float, 3>(positions->mapped_index(i),
                                           decoded.position[i.value()].data()))
      return false;
  for (std::uint32_t f = 0; f < decoded.triangle.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c)
      decoded.triangle[f][c] = mesh->face(draco::FaceIndex(f))[c].value();
  return true;
}

}  // namespace

DecodedDraco decodeDracoMesh(std::string_view bytes, std::uint32_t position, std::size_t points,
                             std::size_t triangles) {
  const std::size_t most = kMostPerByte * bytes.size();
  if (points == 0 || triangles == 0 || points > most || triangles > most) return {};
  DecodedDraco decoded;
  decoded.position.resize(points);
  decoded.triangle.resize(triangles);
  const std::size_t pointBytes = points * sizeof(decoded.position[0]);
  const std::size_t triangleBytes = triangles * sizeof(Triangle);
  std::vector<std::byte> out(pointBytes + triangleBytes);
  const auto fill = [&](std::span<std::byte> to) {
    if (!decodeInto(bytes, position, decoded)) return false;
    std::memcpy(to.data(), decoded.position.data(), pointBytes);
    std::memcpy(to.data() + pointBytes, decoded.triangle.data(), triangleBytes);
    return true;
  };
  const std::size_t memory = kMemory + kMemoryEach * (points + triangles);
  if (callIsolated(out, memory, kSeconds, fill, Progress()) != IsolatedEnd::Done) return {};
  std::memcpy(decoded.position.data(), out.data(), pointBytes);
  std::memcpy(decoded.triangle.data(), out.data() + pointBytes, triangleBytes);
  return decoded;
}

}  // namespace lumen::convert
