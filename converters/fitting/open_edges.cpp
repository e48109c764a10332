// SPDX-License-Identifier: Apache-2.0
#include "converters/fitting/open_edges.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <vector>

#include "formats/case/blobby.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"

namespace lumen::convert {
namespace {

using formats::ClosedPlace;

/// Of the edge's lesser radius: how wide the opening is, by turns.
constexpr double kOpening[] = {0.4, 0.5, 0.6, 0.75, 0.9};

struct NewBlob {
  formats::Vec3f centre;
  float width;
};

/// The nodes that have a say at a place.
std::vector<std::uint32_t> blendingNodes(const field::BlendedField& field,
                                         const ClosedPlace& closed) {
  const double p[3] = {closed.place.x, closed.place.y, closed.place.z};
  std::vector<std::uint32_t> nodes;
  field::visitActiveNodes(closed.cursor, [&](std::uint32_t k, field::ActiveNodes& active) {
    const bool blends = field::weightOf<1>(field, k, p, active).value > 0;
    if (blends) nodes.push_back(field.lender(k));
    return blends;
  });
  if (nodes.empty()) nodes.push_back(field.lender(closed.cursor));
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void addBlobs(const std::map<std::uint32_t, std::vector<NewBlob>>& added,
              formats::BlobbyModels& models) {
  formats::BlobbyModels out = models;
  out.offset.assign(1, 0);
  out.centre.clear();
  out.width.clear();
  for (std::uint32_t node = 0; node + 1 < models.offset.size(); ++node) {
    for (std::uint32_t b = models.offset[node]; b < models.offset[node + 1]; ++b) {
      out.centre.push_back(models.centre[b]);
      out.width.push_back(models.width[b]);
    }
    if (const auto found = added.find(node); found != added.end())
      for (const NewBlob& blob : found->second) {
        out.centre.push_back(blob.centre);
        out.width.push_back(blob.width);
      }
    out.offset.push_back(static_cast<std::uint32_t>(out.centre.size()));
  }
  models = std::move(out);
}

}  // namespace

std::size_t openEdges(formats::Case& target) {
  const formats::CenterlineTree& tree = target.tree;
  std::size_t closedEdges = 0;
  for (const double opening : kOpening) {
    const field::BlendedField field = formats::blendedFieldOf(target);
    const auto closed = formats::closedPlacesOf(tree, field);
    std::map<std::uint32_t, std::vector<NewBlob>> added;
    closedEdges = 0;
    for (std::uint32_t node = 0; node < closed.size(); ++node) {
      if (closed[node].empty()) continue;
      ++closedEdges;
      const auto parent = static_cast<std::uint32_t>(std::max(tree.parent[node], 0));
      const double radius = tree.parent[node] < 0
                                ? double{tree.radius[node]}
                                : double{std::min(tree.radius[node], tree.radius[parent])};
      const double width =
          formats::widthForRadius(target.models->kernel, target.models->kernelParameter,
                                  opening * radius, target.models->isoLevel);
      // one in the middle of each half radius that is closed
      const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(4 * opening));
      for (std::size_t i = std::min(stride, closed[node].size() - 1) / 2; i < closed[node].size(); i += stride) {
        const ClosedPlace& place = closed[node][i];
        const NewBlob blob{{static_cast<float>(place.place.x), static_cast<float>(place.place.y),
                            static_cast<float>(place.place.z)},
                           static_cast<float>(width)};
        for (const std::uint32_t k : blendingNodes(field, place))
          if (k != field::kNowhere) added[k].push_back(blob);
      }
    }
    std::fprintf(stderr, "opening %.2f: %zu closed edges, %zu nodes changed\n", opening, closedEdges, added.size());
    if (closedEdges == 0) return 0;
    addBlobs(added, *target.models);
  }
  return closedEdges;
}

}  // namespace lumen::convert
