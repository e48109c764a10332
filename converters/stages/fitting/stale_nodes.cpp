// SPDX-License-Identifier: Apache-2.0
// staleNodes() of refit.h.
#include <algorithm>
#include <cstddef>

#include "converters/stages/fitting/fit.h"
#include "converters/stages/fitting/node_models.h"
#include "formats/case/node_origin.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

using formats::Vec3f;

constexpr std::uint32_t kNone = UINT32_MAX;

bool isOpposite(const Vec3f& a, const Vec3f& b) {
  return a.x == -b.x && a.y == -b.y && a.z == -b.z;
}

std::span<const Vec3f> pointsAt(const formats::Case& value, std::uint32_t node) {
  if (!value.points) return {};
  const auto& offset = value.points->offset;
  return std::span(value.points->position).subspan(offset[node], offset[node + 1] - offset[node]);
}

/// The parts of a case that determine generated points.
formats::Case withoutWalls(const formats::Case& value) {
  formats::Case bare;
  bare.tree = value.tree;
  if (value.points) bare.points = formats::PointSets{value.points->offset, {}};
  for (const formats::NodeArray& array : value.nodeArrays)
    if (array.name == formats::kOriginArray) bare.nodeArrays.push_back(array);
  return bare;
}

/// Two states of a case, node by node.
class Comparison {
public:
  Comparison(const formats::Case& before, const formats::Case& after,
             std::span<const std::uint32_t> nodeBefore)
      : m_before(before),
        m_after(after),
        m_nodeBefore(nodeBefore),
        m_reach(recordedFitOptions(after).neighbourhood),
        m_aroundBefore(before.tree),
        m_aroundAfter(after.tree) {
    // a ring around a node that is reversed is another, though the wall is the same
    formats::Case aligned = withoutWalls(before);
    for (std::uint32_t node = 0; node < nodeBefore.size(); ++node)
      if (const std::uint32_t was = nodeBefore[node];
          was != kNone && isOpposite(aligned.tree.direction[was], after.tree.direction[node]))
        aligned.tree.direction[was] = after.tree.direction[node];
    m_drawnBefore = pointsOfUnmeasured(aligned, m_aroundBefore);
    m_drawnAfter = pointsOfUnmeasured(withoutWalls(after), m_aroundAfter);
    for (std::uint32_t node = 0; node < nodeBefore.size(); ++node) {
      m_isSame.push_back(isSame(node));
      m_hasSameEdges.push_back(nodeBefore[node] != kNone &&
                               asBefore(m_aroundAfter.of(node)) ==
                                   sorted(m_aroundBefore.of(nodeBefore[node])));
    }
  }

  [[nodiscard]] bool isStale(std::uint32_t node) const {
    if (!m_isSame[node]) return true;
    const auto around = m_aroundAfter.within(node, m_reach);
    if (!std::all_of(around.begin(), around.end(), [&](std::uint32_t n) { return m_isSame[n]; }))
      return true;
    return !m_hasSameEdges[node] ||
           asBefore(around) != sorted(m_aroundBefore.within(m_nodeBefore[node], m_reach));
  }

private:
  using Nodes = std::vector<std::uint32_t>;

  static Nodes sorted(std::span<const std::uint32_t> nodes) {
    Nodes out(nodes.begin(), nodes.end());
    std::sort(out.begin(), out.end());
    return out;
  }
  [[nodiscard]] Nodes asBefore(std::span<const std::uint32_t> nodes) const {
    Nodes out;
    for (const std::uint32_t node : nodes) out.push_back(m_nodeBefore[node]);
    return sorted(out);
  }
  /// True if the node itself has the same wall as before.
  [[nodiscard]] bool isSame(std::uint32_t node) const {
    const std::uint32_t was = m_nodeBefore[node];
    if (was == kNone) return false;
    const auto& a = m_before.tree;
    const auto& b = m_after.tree;
    const auto kind = [](const formats::CenterlineTree& tree, std::uint32_t n) {
      return tree.branches[tree.branch[n]].kind;
    };
    return a.centre[was] == b.centre[node] && a.radius[was] == b.radius[node] &&
           (a.direction[was] == b.direction[node] ||
            isOpposite(a.direction[was], b.direction[node])) &&
           kind(a, was) == kind(b, node) &&
           std::ranges::equal(pointsAt(m_before, was), pointsAt(m_after, node)) &&
           m_drawnBefore[was] == m_drawnAfter[node];
  }

  const formats::Case& m_before;
  const formats::Case& m_after;
  std::span<const std::uint32_t> m_nodeBefore;
  int m_reach;
  formats::Neighbours m_aroundBefore, m_aroundAfter;
  std::vector<std::vector<Vec3f>> m_drawnBefore, m_drawnAfter;
  std::vector<bool> m_isSame, m_hasSameEdges;
};

}  // namespace

std::vector<std::uint32_t> staleNodes(const formats::Case& before, const formats::Case& after,
                                      std::span<const std::uint32_t> nodeBefore) {
  const Comparison comparison(before, after, nodeBefore);
  std::vector<std::uint32_t> stale;
  for (std::uint32_t node = 0; node < nodeBefore.size(); ++node)
    if (comparison.isStale(node)) stale.push_back(node);
  return stale;
}

}  // namespace lumen::convert
