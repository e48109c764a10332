// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/vessel_distance.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "blob.h"
#include "converters/base/vectors.h"
#include "formats/case/topology.h"

namespace lumen::convert {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Radii along the tree within which libblob lets nodes blend.
constexpr double kNeighbourhood = 4;

/// Summed from x to z, as Eigen's own sum begins elsewhere.
double squaredLength(const Eigen::Vector3d& v) {
  return v.x() * v.x() + v.y() * v.y() + v.z() * v.z();
}

/// Squared distance from `p` to the box, and to its farthest corner.
std::pair<double, double> squaredRange(const Box3d& box, const Eigen::Vector3d& p) {
  return {squaredLength(box.gap(p)), squaredLength((p - box.low).cwiseMax(box.high - p))};
}

/// Points as libblob takes them: three doubles each.
const double (*coordinates(std::span<const Eigen::Vector3d> points))[3] {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  return reinterpret_cast<const double(*)[3]>(points.data());
}

}  // namespace

TreeRegion regionOfBranch(const formats::CenterlineTree& tree, std::uint32_t branch) {
  const formats::Neighbours neighbours(tree);
  std::vector<double> left(tree.nodeCount(), -1);  // path that a node may still go on, mm
  std::deque<std::uint32_t> next;
  const formats::Branch& own = tree.branches[branch];
  for (std::uint32_t n = own.firstNode; n < own.firstNode + own.nodeCount; ++n) {
    left[n] = kNeighbourhood * static_cast<double>(tree.radius[n]);
    next.push_back(n);
  }
  for (; !next.empty(); next.pop_front()) {
    const std::uint32_t at = next.front();
    for (const std::uint32_t to : neighbours.of(at)) {
      const Eigen::Vector3d edge = toEigen(tree.centre[at]) - toEigen(tree.centre[to]);
      const double rest = left[at] - std::hypot(edge.x(), edge.y(), edge.z());
      if (rest <= left[to] || rest < 0) continue;
      left[to] = rest;
      next.push_back(to);
    }
  }
  TreeRegion region;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if (left[n] >= 0) region.push_back(n);
  return region;
}

VesselDistance::VesselDistance(const formats::Case& source, bool exact)
    : m_tree(source.tree),
      m_model(openModels(source)),
      m_flags(exact ? BLOB_BLENDED | BLOB_DISTANCE_EXACT : BLOB_BLENDED) {
  for (const formats::Branch& branch : m_tree.branches) {
    Box3d box;
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
      box.add(toEigen(m_tree.centre[n]), kReachRadii * static_cast<double>(m_tree.radius[n]));
    m_reach.push_back(box);
  }
}

double VesselDistance::power(std::uint32_t node, const Eigen::Vector3d& p) const {
  const auto r = static_cast<double>(m_tree.radius[node]);
  return squaredLength(p - toEigen(m_tree.centre[node])) - r * r;
}

bool VesselDistance::hasNodeNear(std::uint32_t branch, const Box3d& box, double band) const {
  const formats::Branch& own = m_tree.branches[branch];
  for (std::uint32_t n = own.firstNode; n < own.firstNode + own.nodeCount; ++n) {
    const double reach = kReachRadii * static_cast<double>(m_tree.radius[n]) + band;
    if (squaredRange(box, toEigen(m_tree.centre[n])).first <= reach * reach) return true;
  }
  return false;
}

void VesselDistance::query(std::span<const Eigen::Vector3d> points, std::uint32_t* cursors,
                           std::span<WallDistance> answers, std::span<WallFoot> feet) const {
  std::vector<blob_sample> samples(points.size());
  blob_query_many(m_model.get(), m_flags, points.size(), coordinates(points), cursors,
                  samples.data());
  std::vector<std::size_t> outside;
  std::vector<Eigen::Vector3d> places;
  std::vector<std::uint32_t> nodes;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const blob_sample& sample = samples[i];
    answers[i] = {static_cast<float>(sample.distance), m_tree.branch[sample.node]};
    if (!feet.empty()) feet[i] = {Eigen::Vector3d(sample.normal), sample.node};
    if (sample.distance <= 0 || (m_flags & BLOB_DISTANCE_EXACT)) continue;
    outside.push_back(i);
    places.push_back(points[i]);
    nodes.push_back(sample.node);
  }
  samples.resize(outside.size());
  blob_query_many(m_model.get(), BLOB_BLENDED | BLOB_DISTANCE_EXACT, places.size(),
                  coordinates(places), nodes.data(), samples.data());
  for (std::size_t k = 0; k < outside.size(); ++k) {
    answers[outside[k]].distance = static_cast<float>(samples[k].distance);
    if (!feet.empty()) feet[outside[k]].normal = Eigen::Vector3d(samples[k].normal);
  }
}

void VesselDistance::takeLess(std::span<const Eigen::Vector3d> points,
                              const std::vector<std::size_t>& chosen,
                              std::vector<std::uint32_t>& cursors, std::span<WallDistance> answers,
                              std::span<WallFoot> feet) const {
  if (chosen.empty()) return;
  std::vector<Eigen::Vector3d> places;
  for (const std::size_t i : chosen) places.push_back(points[i]);
  std::vector<WallDistance> found(places.size());
  std::vector<WallFoot> footOf(feet.empty() ? 0 : places.size());
  query(places, cursors.data(), found, footOf);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    if (found[k].distance >= answers[chosen[k]].distance) continue;
    answers[chosen[k]] = found[k];
    if (!feet.empty()) feet[chosen[k]] = footOf[k];
  }
}

void VesselDistance::askBranch(std::uint32_t branch, std::span<const Eigen::Vector3d> points,
                               const Box3d& box, std::span<WallDistance> answers,
                               std::span<WallFoot> feet) const {
  TreeRegion near;
  const formats::Branch& own = m_tree.branches[branch];
  for (std::uint32_t n = own.firstNode; n < own.firstNode + own.nodeCount; ++n) {
    const double reach = kReachRadii * static_cast<double>(m_tree.radius[n]);
    if (squaredRange(box, toEigen(m_tree.centre[n])).first < reach * reach) near.push_back(n);
  }
  std::vector<std::size_t> chosen;
  std::vector<std::uint32_t> cursors;
  for (std::size_t i = 0; !near.empty() && i < points.size(); ++i) {
    if (answers[i].branch == branch) continue;
    const std::uint32_t node =
        *std::min_element(near.begin(), near.end(), [&](std::uint32_t a, std::uint32_t b) {
          return power(a, points[i]) < power(b, points[i]);
        });
    const auto r = static_cast<double>(m_tree.radius[node]);
    if (power(node, points[i]) >= (kReachRadii * kReachRadii - 1) * r * r) continue;
    chosen.push_back(i);
    cursors.push_back(node);
  }
  takeLess(points, chosen, cursors, answers, feet);
}

namespace {

Box3d boundingBox(std::span<const Eigen::Vector3d> points) {
  Box3d box;
  for (const Eigen::Vector3d& p : points) box.add(p);
  return box;
}

}  // namespace

void VesselDistance::ofAll(std::span<const Eigen::Vector3d> points, double band,
                           std::span<WallDistance> answers, std::span<WallFoot> feet) const {
  if (points.empty()) return;
  const Box3d box = boundingBox(points);
  bool isNear = false;
  std::vector<std::uint32_t> branches;
  for (std::uint32_t b = 0; b < m_reach.size(); ++b) {
    const Box3d& reach = m_reach[b];
    const double gap =
        std::max((reach.low - box.high).maxCoeff(), (box.low - reach.high).maxCoeff());
    isNear = isNear || (std::max(gap, 0.0) <= band && hasNodeNear(b, box, band));
    if (gap <= 0) branches.push_back(b);
  }
  if (!isNear) {
    std::fill(answers.begin(), answers.end(), WallDistance{static_cast<float>(band), 0});
    return;
  }
  query(points, nullptr, answers, feet);
  for (const std::uint32_t b : branches) askBranch(b, points, box, answers, feet);
}

void VesselDistance::ofRegion(const TreeRegion& region, std::span<const Eigen::Vector3d> points,
                              double band, std::span<WallDistance> answers,
                              std::span<WallFoot> feet) const {
  if (points.empty()) return;
  const Box3d box = boundingBox(points);
  bool isNear = false;
  double least = kInfinite;  // no node of least power has more, anywhere in the box
  std::vector<double> lowest;
  for (const std::uint32_t n : region) {
    const auto [near, far] = squaredRange(box, toEigen(m_tree.centre[n]));
    const auto r = static_cast<double>(m_tree.radius[n]);
    isNear = isNear || std::sqrt(near) <= kReachRadii * r + band;
    least = std::min(least, far - r * r);
    lowest.push_back(near - r * r);
  }
  if (!isNear) {
    std::fill(answers.begin(), answers.end(), WallDistance{static_cast<float>(band), 0});
    return;
  }
  TreeRegion candidates;
  for (std::size_t k = 0; k < region.size(); ++k)
    if (lowest[k] <= least) candidates.push_back(region[k]);
  std::vector<std::uint32_t> cursors;
  for (const Eigen::Vector3d& p : points)
    cursors.push_back(*std::min_element(
        candidates.begin(), candidates.end(),
        [&](std::uint32_t a, std::uint32_t b) { return power(a, p) < power(b, p); }));
  query(points, cursors.data(), answers, feet);
}

}  // namespace lumen::convert
