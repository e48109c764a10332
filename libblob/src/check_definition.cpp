// SPDX-License-Identifier: Apache-2.0
#include "check_definition.h"

#include "model.h"

namespace lumen::blob {
namespace {

// The ranges of blob_model_def: with these, no float in a query overflows within kFarthestMm of a
// node.
constexpr double kMaxCoordinate = 1e6, kMinLength = 1e-5, kMaxLength = 1e3;
constexpr double kMinParameter = 1e-4, kMaxParameter = 1e4;
constexpr double kMinLevel = 1e-6, kMaxLevel = 1e3;

bool within(double value, double low, double high) noexcept {
  return value >= low && value <= high;  // false for NaN
}

bool arePositions(const float (*positions)[3], std::size_t count) noexcept {
  for (std::size_t i = 0; i < count; ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (!within(positions[i][axis], -kMaxCoordinate, kMaxCoordinate)) return false;
  return true;
}

bool areLengths(const float* lengths, std::size_t count) noexcept {
  for (std::size_t i = 0; i < count; ++i)
    if (!within(lengths[i], kMinLength, kMaxLength)) return false;
  return true;
}

blob_status checkOffsets(const std::uint32_t* offset, std::size_t nodeCount) noexcept {
  if (offset[0] != 0) return BLOB_ERROR_TOPOLOGY;
  for (std::size_t i = 0; i < nodeCount; ++i)
    if (offset[i + 1] < offset[i]) return BLOB_ERROR_TOPOLOGY;
  return offset[nodeCount] > BLOB_MAX_BLOBS ? BLOB_ERROR_LIMIT : BLOB_OK;
}

blob_status checkBlobs(const blob_blobs& blobs, std::size_t nodeCount) noexcept {
  if (blobs.offset == nullptr) return BLOB_ERROR_ARGUMENT;
  const int kernel = codeOf(blobs.kernel);
  if (kernel < 0 || kernel >= static_cast<int>(field::kKernelCount)) return BLOB_ERROR_KERNEL;
  if (field::hasParameter(kernelOf(blobs.kernel)) &&
      !within(blobs.kernel_parameter, kMinParameter, kMaxParameter))
    return BLOB_ERROR_RANGE;
  if (!within(blobs.iso_level, kMinLevel, kMaxLevel)) return BLOB_ERROR_RANGE;
  if (const blob_status status = checkOffsets(blobs.offset, nodeCount); status != BLOB_OK)
    return status;
  const std::size_t count = blobs.offset[nodeCount];
  if (count == 0) return BLOB_OK;
  if (blobs.centre == nullptr || blobs.width == nullptr) return BLOB_ERROR_ARGUMENT;
  const bool legal = arePositions(blobs.centre, count) && areLengths(blobs.width, count);
  return legal ? BLOB_OK : BLOB_ERROR_RANGE;
}

blob_status checkTree(const blob_model_def& def) noexcept {
  const auto count = static_cast<std::int64_t>(def.node_count);
  if (def.parent != nullptr)
    for (std::int64_t i = 0; i < count; ++i)
      if (def.parent[i] < -1 || def.parent[i] >= count || def.parent[i] == i)
        return BLOB_ERROR_TOPOLOGY;
  for (std::size_t i = 0; i < def.link_count; ++i)
    if (def.link[i][0] >= count || def.link[i][1] >= count) return BLOB_ERROR_TOPOLOGY;
  return BLOB_OK;
}

}  // namespace

blob_status checkDefinition(const blob_model_def& def) noexcept {
  if (def.node_count == 0) return BLOB_ERROR_EMPTY;
  if (def.node_count > BLOB_MAX_NODES || def.link_count > BLOB_MAX_LINKS) return BLOB_ERROR_LIMIT;
  if (def.centre == nullptr || def.radius == nullptr) return BLOB_ERROR_ARGUMENT;
  if (def.link_count > 0 && def.link == nullptr) return BLOB_ERROR_ARGUMENT;
  if (!arePositions(def.centre, def.node_count) || !areLengths(def.radius, def.node_count))
    return BLOB_ERROR_RANGE;
  if (const blob_status status = checkTree(def); status != BLOB_OK) return status;
  return checkBlobs(def.blobs, def.node_count);
}

}  // namespace lumen::blob
