// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/rungs.h"

#include <algorithm>
#include <span>
#include <vector>

namespace lumen::convert {
namespace {

/// Lumens meet if their axes are no farther apart than this many times both radii, which may be wrong
/// by a tenth.
constexpr double kMeeting = 1.1;

/// Whether a vessel goes on through a node, besides the way to a neighbour: two of its arms lead away
/// from one another by more than a right angle, as those of a fork seldom do. Its width shows nothing,
/// as cylinders are too wide where another vessel touches.
bool goesOn(const NodeGraph& graph, std::uint32_t node, std::uint32_t besides) {
  std::vector<Eigen::Vector3d> arms;
  for (const std::uint32_t next : graph.beside(node))
    if (next != besides)
      if (const auto arm = graph.armInto(node, next)) arms.push_back(arm->direction);
  for (std::size_t i = 0; i < arms.size(); ++i)
    for (std::size_t k = i + 1; k < arms.size(); ++k)
      if (arms[i].dot(arms[k]) < 0) return true;
  return false;
}

/// The nodes of a way from one place to another, both included.
using Stretch = std::span<const std::uint32_t>;

/// Whether all nodes of a stretch touch the vessel that goes on through its first.
bool touchesAlong(const NodeGraph& graph, Stretch stretch) {
  const std::vector<std::uint32_t> vessel = graph.throughBesides(stretch[0], stretch[1]);
  const double wide = graph.radius(stretch.back());
  return std::all_of(stretch.begin(), stretch.end(), [&](std::uint32_t node) {
    return std::any_of(vessel.begin(), vessel.end(), [&](std::uint32_t near) {
      return (graph.position(node) - graph.position(near)).norm() <=
             kMeeting * (graph.radius(near) + wide);
    });
  });
}

/// A stretch that an aneurysm hangs on is none, as it would lose its place.
bool isRung(const NodeGraph& graph, Stretch stretch) {
  if (std::any_of(stretch.begin(), stretch.end(),
                  [&](std::uint32_t node) { return graph.hasAneurysm(node); }))
    return false;
  const std::vector<std::uint32_t> back(stretch.rbegin(), stretch.rend());
  return goesOn(graph, stretch[0], stretch[1]) && goesOn(graph, back[0], back[1]) &&
         (touchesAlong(graph, stretch) || touchesAlong(graph, back));
}

/// The shortest rung on a way; empty if it has none.
Stretch rungOn(const NodeGraph& graph, Stretch way) {
  Stretch best;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    if (!graph.isFork(way[i])) continue;
    std::size_t k = i + 1;
    while (k + 1 < way.size() && !graph.isFork(way[k])) ++k;
    const Stretch stretch = way.subspan(i, k - i + 1);
    const bool isShorter = best.empty() || stretch.size() < best.size();
    if (isShorter && graph.isFork(way[k]) && isRung(graph, stretch)) best = stretch;
  }
  return best;
}

}  // namespace

void cutRungs(NodeGraph& graph) {
  for (const auto& [a, b] : graph.takeLinks()) {
    const std::vector<std::uint32_t> way = graph.way(a, b);
    if (way.size() < 3) {  // no loop, or an edge already
      graph.link(a, b);
      continue;
    }
    graph.connect(a, b);
    const Stretch rung = rungOn(graph, way);
    if (rung.empty()) {
      graph.cut(a, b);
      graph.link(a, b);
    } else if (rung.size() == 2) {
      graph.cut(rung[0], rung[1]);
    } else {
      graph.drop(rung.subspan(1, rung.size() - 2));
    }
  }
}

}  // namespace lumen::convert
