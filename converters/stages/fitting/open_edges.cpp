// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/open_edges.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "formats/case/blobby.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"

namespace lumen::convert {
namespace {

/// Width of the passage that an opening makes, as a share of the edge's lesser radius. A wider one
/// moves the wall.
constexpr double kPassageRadii = 0.4;
/// Excess of the field over the iso-level where it was too low, as a share of the level.
constexpr double kExcess = 0.1;
/// The most turns. An opening may be incomplete where other nodes answer than at its middle; the
/// next turn adds these. Where a vessel begins along another one, whose nodes answer at first, each
/// turn opens one edge, and the same nodes answer on the next.
constexpr int kMostTurns = 256;

struct NewBlob {
  formats::Vec3f centre;
  float width;
};
using NewBlobs = std::map<std::uint32_t, std::vector<NewBlob>>;  ///< by the node that gets them

/// A place where an edge is closed, and the deficit of the field there, mm.
struct Lack {
  formats::ClosedPlace at;
  double amount;
};

/// The nodes whose blobs contribute to the field at a place.
std::vector<std::uint32_t> ownersAt(const field::BlendedField& field,
                                    const formats::ClosedPlace& closed) {
  const double p[3] = {closed.place.x, closed.place.y, closed.place.z};
  std::vector<std::uint32_t> owners;
  field::visitActiveNodes(closed.cursor, [&](std::uint32_t k, field::ActiveNodes& active) {
    const bool blends = field::blendWeight<1>(field, k, p, active).value > 0;
    if (blends) owners.push_back(field.lender(k));
    return blends;
  });
  if (owners.empty()) owners.push_back(field.lender(closed.cursor));
  std::erase(owners, field::kNowhere);
  return owners;
}

/// The lesser radius of the edge that leads to a node, mm; of a root, its own.
double radiusAlong(const formats::CenterlineTree& tree, std::uint32_t node) {
  if (tree.parent[node] == formats::kNoParent) return double{tree.radius[node]};
  return double{
      std::min(tree.radius[node], tree.radius[static_cast<std::size_t>(tree.parent[node])])};
}

/// Opens one edge: adds a blob where the field lacks most, which adds as much all over a passage of
/// that radius, and repeats this for the places beyond its reach.
void openEdge(const field::BlendedField& field, const formats::BlobbyModels& models,
              std::vector<Lack> lacks, double radius, NewBlobs& added) {
  std::stable_sort(lacks.begin(), lacks.end(),
                   [](const Lack& a, const Lack& b) { return a.amount > b.amount; });
  while (!lacks.empty()) {
    const field::Vec c = lacks.front().at.place;
    const NewBlob blob{{static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)},
                       static_cast<float>(formats::widthForRadius(
                           models.kernel, models.kernelParameter, radius, lacks.front().amount))};
    std::set<std::uint32_t> owners;
    std::erase_if(lacks, [&](const Lack& lack) {
      const field::Vec& p = lack.at.place;
      if (std::hypot(p.x - c.x, p.y - c.y, p.z - c.z) > radius) return false;
      for (const std::uint32_t owner : ownersAt(field, lack.at)) owners.insert(owner);
      return true;
    });
    for (const std::uint32_t owner : owners) added[owner].push_back(blob);
  }
}

using MayOpen = std::function<bool(std::uint32_t)>;

/// The blobs that open the closed edges.
NewBlobs findOpenings(const formats::Case& value, const MayOpen& mayOpen) {
  const field::BlendedField field = formats::caseField(value);
  std::map<std::uint32_t, std::vector<Lack>> closed;  // by the edge's farther end
  formats::findClosedPlaces(value.tree, field, [&](const formats::ClosedPlace& at) {
    if (mayOpen && !mayOpen(at.node)) return false;
    const double f = field.blended(at.place, at.cursor).value;
    closed[at.node].push_back({at, (1 + kExcess) * field.level() - f});
    return true;
  });
  NewBlobs added;
  for (auto& [node, lacks] : closed)
    openEdge(field, *value.models, std::move(lacks), kPassageRadii * radiusAlong(value.tree, node),
             added);
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

void openEdges(formats::Case& target, const MayOpen& mayOpen) {
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const NewBlobs added = findOpenings(target, mayOpen);
    if (added.empty()) return;
    target.models = withBlobs(*target.models, added);
  }
}

}  // namespace lumen::convert
