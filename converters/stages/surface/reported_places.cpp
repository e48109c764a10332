// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/reported_places.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/vectors.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {

std::vector<Overlap> findOverlaps(const CaseSurface& surface, const SeparatedField& field) {
  const std::size_t count = surface.mesh.position.size();
  std::vector<SeparatedSample> samples(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    if (field.mayTouch(surface.node[v]))
      samples[v] = field.at(surface.mesh.position[v], surface.node[v]);
  });
  const std::vector<std::uint32_t>& branch = field.source().tree.branch;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Overlap> found;
  for (std::size_t v = 0; v < count; ++v) {
    // walls that only come near each other are moved by less than the gap
    const double depth = -samples[v].wall;
    if (!samples[v].isSeparated || depth <= field.options().gap) continue;
    const std::pair<std::uint32_t, std::uint32_t> pair =
        std::minmax(branch[samples[v].node], branch[samples[v].other]);
    Overlap& overlap = found[pair];
    if (depth > overlap.depth) overlap = {pair.first, pair.second, depth, surface.mesh.position[v]};
  }
  std::vector<Overlap> overlaps;
  for (const auto& [pair, overlap] : found) overlaps.push_back(overlap);
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& a, const Overlap& b) { return a.depth > b.depth; });
  return overlaps;
}

namespace {

constexpr double kLeastLengthRadii = 4;  // radii: shorter ones lie within a parent's lumen
constexpr double kNearRadii = 2;

// Nodes first .. last - 1 of one branch.
struct BareStretch {
  std::uint32_t first, last;
  double length;  // mm
};

std::vector<BareStretch> withoutVertices(const formats::CenterlineTree& tree,
                                         const formats::Branch& branch,
                                         const std::vector<bool>& hasVertex) {
  std::vector<BareStretch> found;
  const std::uint32_t end = branch.firstNode + branch.nodeCount;
  for (std::uint32_t i = branch.firstNode; i < end; ++i) {
    if (hasVertex[i]) continue;
    BareStretch stretch{i, i, 0};
    for (; stretch.last < end && !hasVertex[stretch.last]; ++stretch.last)
      if (stretch.last > i)
        stretch.length +=
            (toEigen(tree.centre[stretch.last]) - toEigen(tree.centre[stretch.last - 1])).norm();
    const double radius = tree.radius[(stretch.first + stretch.last) / 2];
    if (stretch.length > kLeastLengthRadii * radius) found.push_back(stretch);
    i = stretch.last;
  }
  return found;
}

/// "(1, 2.5, 3)", each number with as many digits as read back the same.
std::string exactPlace(const formats::Vec3f& p) {
  std::string text = "(";
  text.append(formats::shortText(p.x)).append(", ").append(formats::shortText(p.y));
  return text.append(", ").append(formats::shortText(p.z)).append(")");
}

}  // namespace

std::vector<std::string> stretchesWithoutWall(const CaseSurface& surface,
                                              const formats::CenterlineTree& tree) {
  std::vector<bool> hasVertex(tree.nodeCount(), false);
  for (const std::uint32_t node : surface.node) hasVertex[node] = true;
  std::vector<std::string> sentences;
  for (const formats::Branch& branch : tree.branches)
    for (const BareStretch& stretch : withoutVertices(tree, branch, hasVertex)) {
      const std::uint32_t middle = (stretch.first + stretch.last) / 2;
      const Eigen::Vector3d centre = toEigen(tree.centre[middle]);
      const double near = kNearRadii * tree.radius[middle];
      if (std::any_of(surface.mesh.position.begin(), surface.mesh.position.end(),
                      [&](const Eigen::Vector3d& p) { return (p - centre).norm() < near; }))
        continue;
      sentences.push_back("the surface leaves out " +
                          formats::shortText(static_cast<float>(stretch.length)) +
                          " mm of branch " + formats::printable(branch.label) + ", from " +
                          exactPlace(tree.centre[stretch.first]) + " to " +
                          exactPlace(tree.centre[stretch.last - 1]));
    }
  return sentences;
}

}  // namespace lumen::convert
