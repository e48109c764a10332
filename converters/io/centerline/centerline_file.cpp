// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/centerline_file.h"

#include <algorithm>
#include <tuple>

namespace lumen::convert {
namespace {

using Index = std::int32_t;

// Children of each point after points at the place of their parent were merged with it.
struct Merged {
  explicit Merged(const CenterlineFile& file);

  [[nodiscard]] Index parentOf(Index point) const { return parent[std::size_t(point)]; }
  /// The child of `point` that continues the same vessel.
  [[nodiscard]] Index next(Index point) const;

  const std::vector<CenterlinePoint>& points;
  std::vector<Index> parent;               // among the remaining points
  std::vector<Index> first, last, beside;  // children in the order of the file
  std::vector<Index> roots;
};

Merged::Merged(const CenterlineFile& file)
    : points(file.points),
      parent(points.size(), kNoPoint),
      first(parent),
      last(parent),
      beside(parent) {
  std::vector<Index> same(points.size());  // the point with which each is merged
  for (std::size_t i = 0; i < points.size(); ++i) {
    same[i] = static_cast<Index>(i);
    if (points[i].parent == kNoPoint) {
      roots.push_back(static_cast<Index>(i));
      continue;
    }
    const Index on = same[static_cast<std::size_t>(points[i].parent)];
    const auto p = static_cast<std::size_t>(on);
    if (points[p].position == points[i].position) {
      same[i] = on;
      continue;
    }
    parent[i] = on;
    (first[p] == kNoPoint ? first[p] : beside[static_cast<std::size_t>(last[p])]) = same[i];
    last[p] = same[i];
  }
}

Index Merged::next(Index point) const {
  const CenterlinePoint& here = points[static_cast<std::size_t>(point)];
  const Index before = parentOf(point);
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  if (before != kNoPoint) along = here.position - points[static_cast<std::size_t>(before)].position;
  Index best = kNoPoint;
  using Score = std::tuple<bool, double, double>;  // same vessel, radius, cosine of the turn
  Score score;
  for (Index c = first[static_cast<std::size_t>(point)]; c != kNoPoint;
       c = beside[static_cast<std::size_t>(c)]) {
    const CenterlinePoint& child = points[static_cast<std::size_t>(c)];
    if (here.vessel != kNoVessel && child.vessel != here.vessel) continue;
    const Score scored{child.vessel == here.vessel, child.radius,
                       along.dot((child.position - here.position).normalized())};
    if (best == kNoPoint || scored > score) {
      best = c;
      score = scored;
    }
  }
  return best;
}

}  // namespace

std::size_t CenterlineFile::radiiMissing() const {
  return static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [](const CenterlinePoint& p) { return !(p.radius > 0); }));
}

std::vector<CenterlineChain> centerlineChains(const CenterlineFile& file) {
  const Merged merged(file);
  std::vector<CenterlineChain> chains;
  struct Start {
    Index point, parent;
    std::size_t sample;
  };
  for (const Index root : merged.roots) {
    std::vector<Start> open{{root, -1, 0}};
    while (!open.empty()) {
      const Start start = open.back();
      open.pop_back();
      const auto index = static_cast<Index>(chains.size());
      chains.push_back({{}, start.parent, start.sample});
      std::vector<Start> found;
      for (Index at = start.point; at != kNoPoint;) {
        chains.back().points.push_back(at);
        const Index next = merged.next(at);
        for (Index c = merged.first[static_cast<std::size_t>(at)]; c != kNoPoint;
             c = merged.beside[static_cast<std::size_t>(c)])
          if (c != next) found.push_back({c, index, chains.back().points.size() - 1});
        at = next;
      }
      open.insert(open.end(), found.rbegin(), found.rend());
    }
  }
  return chains;
}

}  // namespace lumen::convert
