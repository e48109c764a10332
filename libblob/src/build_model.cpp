// SPDX-License-Identifier: Apache-2.0
#include "build_model.h"

#include <algorithm>
#include <cmath>

#include "formats/field/neighbourhood.h"
#include "locate.h"
#include "neighbours.h"
#include "simd/backend.h"

namespace lumen::blob {
namespace {

using field::Neighbourhood;
using field::TreeView;

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

TreeView treeOf(const blob_model_def& def) {
  return {def.node_count, def.centre, def.radius, def.parent, def.link_count, def.link};
}

void extendReach(const blob_model_def& def, blob_model& model) {
  const blob_blobs& blobs = def.blobs;
  for (std::size_t i = 0; i < def.node_count; ++i) {
    const std::uint32_t begin = blobs.offset[i], end = blobs.offset[i + 1];
    for (std::uint32_t j = begin; j < end; ++j) {
      const double scale =
          field::blobScale(kernelOf(blobs.kernel), blobs.kernel_parameter, blobs.width[j]);
      const double reach = reachOfBlob(model.field, blobs.width[j], scale, end - begin);
      for (int axis = 0; axis < 3; ++axis) {
        const double x = blobs.centre[j][axis];
        model.reachLow[axis] = std::min(model.reachLow[axis], x - reach);
        model.reachHigh[axis] = std::max(model.reachHigh[axis], x + reach);
      }
    }
  }
}

// Appends the blobs of a node, relative to its centre.
FieldNode layOut(const blob_model_def& def, std::size_t node, std::vector<BlobBlock>& blocks) {
  const blob_blobs& blobs = def.blobs;
  const std::uint32_t begin = blobs.offset[node], end = blobs.offset[node + 1];
  const std::size_t first = blocks.size(), count = (end - begin + kLanes - 1) / kLanes;
  blocks.resize(first + count, BlobBlock{});
  for (std::uint32_t j = begin; j < end; ++j) {
    BlobBlock& block = blocks[first + (j - begin) / kLanes];
    const std::uint32_t lane = (j - begin) % kLanes;
    block.x[lane] = static_cast<float>(double{blobs.centre[j][0]} - double{def.centre[node][0]});
    block.y[lane] = static_cast<float>(double{blobs.centre[j][1]} - double{def.centre[node][1]});
    block.z[lane] = static_cast<float>(double{blobs.centre[j][2]} - double{def.centre[node][2]});
    block.a[lane] = static_cast<float>(
        field::blobScale(kernelOf(blobs.kernel), blobs.kernel_parameter, blobs.width[j]));
    block.w[lane] = blobs.width[j];
  }
  FieldNode result{};
  result.place[3] = def.radius[node];
  result.block = static_cast<std::uint32_t>(first);
  result.blockCount = static_cast<std::uint32_t>(count) & 0x7FFFFFFFU;
  result.isSimple = count == 1;
  return result;
}

// Lends nodes without blobs those of their lenders, which stay where they are.
void lendBlobs(const blob_model_def& def, const std::vector<std::uint32_t>& lender,
               std::vector<FieldNode>& nodes) {
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (lender[i] == i || lender[i] == BLOB_NOWHERE) continue;
    nodes[i] = nodes[lender[i]];
    nodes[i].place[3] = def.radius[i];
    nodes[i].isSimple = 0;
    for (int axis = 0; axis < 3; ++axis)
      nodes[i].place[axis] =
          static_cast<float>(double{def.centre[i][axis]} - double{def.centre[lender[i]][axis]});
  }
}

std::vector<FieldNode> buildField(const blob_model_def& def,
                                  const std::vector<std::uint32_t>& lender, Field& field) {
  const blob_blobs& blobs = def.blobs;
  field.kernel = blobs.kernel;
  field.kernelParameter = blobs.kernel_parameter;
  field.isoLevel = blobs.iso_level;
  field.transformedLevel = field::levelTransform(kernelOf(blobs.kernel), blobs.iso_level).h;
  std::vector<FieldNode> nodes;
  nodes.reserve(def.node_count);
  for (std::size_t i = 0; i < def.node_count; ++i) nodes.push_back(layOut(def, i, field.blocks));
  lendBlobs(def, lender, nodes);
  return nodes;
}

void buildNodes(const blob_model_def& def, blob_model& model) {
  model.nodes.resize(def.node_count);
  for (int axis = 0; axis < 3; ++axis) {
    model.low[axis] = std::numeric_limits<double>::infinity();
    model.high[axis] = -model.low[axis];
  }
  for (std::size_t i = 0; i < def.node_count; ++i) {
    NodeRecord& node = model.nodes[i];
    for (int axis = 0; axis < 3; ++axis) {
      node.centre[axis] = def.centre[i][axis];
      model.low[axis] = std::min(model.low[axis], node.centre[axis] - double{def.radius[i]});
      model.high[axis] = std::max(model.high[axis], node.centre[axis] + double{def.radius[i]});
    }
  }
  model.parent.assign(def.node_count, -1);
  if (def.parent != nullptr) std::copy_n(def.parent, def.node_count, model.parent.begin());
  for (std::size_t e = 0; e < def.link_count; ++e)
    model.links.push_back({def.link[e][0], def.link[e][1]});
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

std::unique_ptr<blob_model> buildModel(const blob_model_def& def) {
  auto model = std::make_unique<blob_model>();
  const TreeView tree = treeOf(def);
  const Neighbourhood edges = field::findEdges(tree);
  const Neighbourhood around = field::findNeighbourhood(tree, edges);
  buildNodes(def, *model);
  const std::vector<double> spacing = field::measureSpacings(tree, edges);
  addNeighbours(tree, around, spacing, model->nodes, model->neighbours);
  model->lender = field::findLenders(edges, def.blobs.offset);
  const std::vector<FieldNode> fields = buildField(def, model->lender, model->field);
  for (std::size_t i = 0; i < def.node_count; ++i) model->nodes[i].field = fields[i];
  model->blobCount = def.blobs.offset[def.node_count];
  std::copy_n(model->low, 3, model->reachLow);
  std::copy_n(model->high, 3, model->reachHigh);
  extendReach(def, *model);
  model->locate = buildLocateTree(model->nodes);
  model->simd = def.simd;
  model->backend = chooseBackend(def.blobs.kernel, model->simd);
  return model;
}

double reachOfBlob(const Field& field, double width, double scale, double count) noexcept {
  const double ratio = width * count / field.isoLevel;
  const double u =
      field::withKernel(kernelOf(field.kernel), [ratio](auto k) { return k.reach(ratio); });
  return u > 0 ? std::sqrt(u / scale) : 0.0;
}

std::size_t countBytes(const blob_model& model) noexcept {
  const auto bytes = [](const auto& values) { return values.size() * sizeof(values[0]); };
  std::size_t sum = sizeof model + bytes(model.nodes) + bytes(model.neighbours) +
                    bytes(model.field.blocks) + bytes(model.parent) + bytes(model.links) +
                    bytes(model.lender) + bytes(model.locate.leaves);
  for (const auto& level : model.locate.levels) sum += bytes(level);
  return sum;
}

}  // namespace lumen::blob
