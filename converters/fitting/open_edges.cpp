// SPDX-License-Identifier: Apache-2.0
#include "converters/fitting/open_edges.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "formats/case/blobby.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"

namespace lumen::convert {
namespace {

using formats::ClosedPlace;

/// Of the edge's lesser radius: how wide the opening is, by turns, and how far apart its blobs are.
constexpr double kOpening[] = {0.4, 0.5, 0.6, 0.75, 0.9};
constexpr double kApart = 0.5;

struct NewBlob {
  formats::Vec3f centre;
  float width;
};
using NewBlobs = std::map<std::uint32_t, std::vector<NewBlob>>;  ///< by the node that gets them

/// The nodes whose blobs have a say at a place.
std::vector<std::uint32_t> ownersAt(const field::BlendedField& field, const ClosedPlace& closed) {
  const double p[3] = {closed.place.x, closed.place.y, closed.place.z};
  std::vector<std::uint32_t> owners;
  field::visitActiveNodes(closed.cursor, [&](std::uint32_t k, field::ActiveNodes& active) {
    const bool blends = field::weightOf<1>(field, k, p, active).value > 0;
    if (blends) owners.push_back(field.lender(k));
    return blends;
  });
  if (owners.empty()) owners.push_back(field.lender(closed.cursor));
  std::sort(owners.begin(), owners.end());
  owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
  std::erase(owners, field::kNowhere);
  return owners;
}

/// The lesser radius of the edge that leads to a node, mm; of a root, its own.
double radiusAlong(const formats::CenterlineTree& tree, std::uint32_t node) {
  if (tree.parent[node] == formats::kNoParent) return double{tree.radius[node]};
  return double{
      std::min(tree.radius[node], tree.radius[static_cast<std::size_t>(tree.parent[node])])};
}

/// Blobs in a row along the closed places of one edge, whose own surface has that radius.
void openEdge(const field::BlendedField& field, const formats::BlobbyModels& models,
              std::span<const ClosedPlace> closed, double radius, NewBlobs& added) {
  const double width =
      formats::widthForRadius(models.kernel, models.kernelParameter, radius, models.isoLevel);
  const field::Vec* last = nullptr;
  for (const ClosedPlace& at : closed) {
    const field::Vec& p = at.place;
    if (last && std::hypot(p.x - last->x, p.y - last->y, p.z - last->z) < kApart * radius) continue;
    last = &p;
    const NewBlob blob{{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
                       static_cast<float>(width)};
    for (const std::uint32_t owner : ownersAt(field, at)) added[owner].push_back(blob);
  }
}

/// Of every closed edge, the blobs that open it by that share of its radius.
NewBlobs openingsOf(const formats::Case& value, double opening) {
  const field::BlendedField field = formats::blendedFieldOf(value);
  std::vector<ClosedPlace> closed;  // in node order
  formats::findClosedPlaces(value.tree, field, [&closed](const ClosedPlace& place) {
    closed.push_back(place);
    return true;
  });
  NewBlobs added;
  for (auto first = closed.begin(); first != closed.end();) {
    const std::uint32_t node = first->node;
    const auto last = std::find_if(first, closed.end(),
                                   [node](const ClosedPlace& place) { return place.node != node; });
    openEdge(field, *value.models, {first, last}, opening * radiusAlong(value.tree, node), added);
    first = last;
  }
  return added;
}

formats::BlobbyModels withBlobs(const formats::BlobbyModels& models, const NewBlobs& added) {
  formats::BlobbyModels out = models;
  out.offset.assign(1, 0);
  out.centre.clear();
  out.width.clear();
  for (std::uint32_t node = 0; node + 1 < models.offset.size(); ++node) {
    const auto first = static_cast<std::ptrdiff_t>(models.offset[node]);
    const auto last = static_cast<std::ptrdiff_t>(models.offset[node + 1]);
    out.centre.insert(out.centre.end(), models.centre.begin() + first,
                      models.centre.begin() + last);
    out.width.insert(out.width.end(), models.width.begin() + first, models.width.begin() + last);
    if (const auto found = added.find(node); found != added.end())
      for (const NewBlob& blob : found->second) {
        out.centre.push_back(blob.centre);
        out.width.push_back(blob.width);
      }
    out.offset.push_back(static_cast<std::uint32_t>(out.centre.size()));
  }
  return out;
}

}  // namespace

void openEdges(formats::Case& target) {
  for (const double opening : kOpening) {
    const NewBlobs added = openingsOf(target, opening);
    if (added.empty()) return;
    target.models = withBlobs(*target.models, added);
  }
}

}  // namespace lumen::convert
