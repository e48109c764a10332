// SPDX-License-Identifier: Apache-2.0
#include "build_model.h"

#include <algorithm>
#include <cmath>

#include "formats/field/neighbourhood.h"
#include "locate.h"
#include "simd/backend.h"

namespace lumen::blob {
namespace {

using field::Neighbourhood;
using field::TreeView;

TreeView treeOf(const blob_model_def& def) {
  return {def.node_count, def.centre, def.radius, def.parent, def.link_count, def.link};
}

// A radius: where f > T, one of the model's `count` blobs is nearer than this, as one exceeds T /
// count.
double reachOfBlob(const blob_blobs& blobs, double width, double count) {
  const field::Kernel kernel = kernelOf(blobs.kernel);
  const double ratio = width * count / blobs.iso_level;
  const double u = field::withKernel(kernel, [ratio](auto k) { return k.reach(ratio); });
  return u > 0 ? std::sqrt(u / field::blobScale(kernel, blobs.kernel_parameter, width)) : 0.0;
}

void extendReach(const blob_model_def& def, blob_model& model) {
  const blob_blobs& blobs = def.blobs;
  for (std::size_t i = 0; i < def.node_count; ++i) {
    const std::uint32_t begin = blobs.offset[i], end = blobs.offset[i + 1];
    for (std::uint32_t j = begin; j < end; ++j) {
      const double reach = reachOfBlob(blobs, blobs.width[j], end - begin);
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

std::vector<FieldNode> buildField(const blob_model_def& def, const Neighbourhood& edges,
                                  Field& field) {
  const blob_blobs& blobs = def.blobs;
  field.kernel = blobs.kernel;
  field.kernelParameter = blobs.kernel_parameter;
  field.isoLevel = blobs.iso_level;
  field.transformedLevel = field::levelTransform(kernelOf(blobs.kernel), blobs.iso_level).h;
  std::vector<FieldNode> nodes;
  nodes.reserve(def.node_count);
  for (std::size_t i = 0; i < def.node_count; ++i) nodes.push_back(layOut(def, i, field.blocks));
  lendBlobs(def, field::findLenders(edges, blobs.offset), nodes);
  return nodes;
}

// A neighbour of a node, as a lane of a block, and the distance from the node at which it begins to
// blend.
struct Neighbour {
  float nx, ny, nz, c, inverseTau;
  std::uint32_t node;
  double begin;  // mm
};

// The distance from a node's centre within which, rounding included, the node beats a neighbour by
// tau: p_k - p_i >= c - |n| |x|.
double beginOfBlending(const double* offset, double c, double tau) {
  constexpr double kRounding = 1e-5;
  const double slope =
      2.0 * std::sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
  const double margin = c - tau - kRounding * (std::abs(c) + tau);
  if (!(margin > 0)) return 0;
  return slope > 0 ? margin / (slope * (1.0 + kRounding)) : kFarthestMm;
}

Neighbour makeNeighbour(const blob_model_def& def, std::uint32_t i, std::uint32_t k, bool isEdge,
                        double spacing) {
  double offset[3], square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    offset[axis] = double{def.centre[k][axis]} - double{def.centre[i][axis]};
    square += offset[axis] * offset[axis];
  }
  const double ri = def.radius[i], rk = def.radius[k], c = square - rk * rk + ri * ri;
  const double tau = field::blendingWidth(treeOf(def), i, k, isEdge, spacing);
  return {static_cast<float>(-2.0 * offset[0]), static_cast<float>(-2.0 * offset[1]),
          static_cast<float>(-2.0 * offset[2]), static_cast<float>(c),
          static_cast<float>(1.0 / tau),        k,
          beginOfBlending(offset, c, tau)};
}

void setLane(const Neighbour& neighbour, std::size_t lane, NeighbourBlock& block) {
  block.nx[lane] = neighbour.nx;
  block.ny[lane] = neighbour.ny;
  block.nz[lane] = neighbour.nz;
  block.c[lane] = neighbour.c;
  block.inverseTau[lane] = neighbour.inverseTau;
  block.node[lane] = neighbour.node;
}

void addNeighbours(const blob_model_def& def, const Neighbourhood& around,
                   const std::vector<double>& spacing, std::uint32_t i, blob_model& model) {
  std::vector<Neighbour> sorted;
  for (std::uint32_t e = around.offset[i]; e < around.offset[i + 1]; ++e)
    sorted.push_back(makeNeighbour(def, i, around.node[e], around.isEdge[e],
                                   0.5 * (spacing[i] + spacing[around.node[e]])));
  std::sort(sorted.begin(), sorted.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.begin != b.begin ? a.begin < b.begin : a.node < b.node;
  });
  const std::size_t first = model.neighbours.size(),
                    count = std::max<std::size_t>(1, (sorted.size() + kLanes - 1) / kLanes);
  NeighbourBlock empty{};
  std::fill_n(empty.c, kLanes, kNeverLess);
  std::fill_n(empty.inverseTau, kLanes, 1.0f);
  std::fill_n(empty.node, kLanes, BLOB_NOWHERE);
  model.neighbours.resize(first + count, empty);
  for (std::size_t e = 0; e < sorted.size(); ++e)
    setLane(sorted[e], e % kLanes, model.neighbours[first + e / kLanes]);
  const double quiet = count > 1 ? sorted[kLanes].begin : kFarthestMm;
  model.nodes[i].centre[3] = quiet * quiet;
  model.nodes[i].firstNeighbours = static_cast<std::uint32_t>(first);
  model.nodes[i].neighbourBlocks = static_cast<std::uint32_t>(count);
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
}

}  // namespace

std::unique_ptr<blob_model> buildModel(const blob_model_def& def) {
  auto model = std::make_unique<blob_model>();
  const TreeView tree = treeOf(def);
  const Neighbourhood edges = field::findEdges(tree);
  const Neighbourhood around = field::findNeighbourhood(tree, edges);
  buildNodes(def, *model);
  const std::vector<double> spacing = field::measureSpacings(tree, edges);
  for (std::uint32_t i = 0; i < def.node_count; ++i) addNeighbours(def, around, spacing, i, *model);
  const std::vector<FieldNode> fields = buildField(def, edges, model->field);
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

std::size_t countBytes(const blob_model& model) noexcept {
  const auto bytes = [](const auto& values) { return values.size() * sizeof(values[0]); };
  std::size_t sum = sizeof model + bytes(model.nodes) + bytes(model.neighbours) +
                    bytes(model.field.blocks) + bytes(model.parent) + bytes(model.locate.leaves);
  for (const auto& level : model.locate.levels) sum += bytes(level);
  return sum;
}

}  // namespace lumen::blob
