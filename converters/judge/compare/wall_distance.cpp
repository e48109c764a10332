// SPDX-License-Identifier: Apache-2.0
// Declared in compare.h.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Core>
#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/geometry/surface_projection.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/compare/compare.h"
#include "formats/case/case_field.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::CenterlineTree;

constexpr int kBisections = 40;
constexpr int kRays = 64;
constexpr double kRayStep = 0.125;  // relative to the radius: no wall of a lumen is thinner
constexpr double kRayReach = 4;     // radii: a surface farther out is another vessel's

// Unit vectors spread evenly over the sphere along a golden spiral.
std::vector<Vector3d> rayDirections() {
  std::vector<Vector3d> directions;
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kRays; ++i) {
    const double z = 1 - (2 * i + 1.0) / kRays, r = std::sqrt(1 - z * z);
    directions.emplace_back(r * std::cos(turn * i), r * std::sin(turn * i), z);
  }
  return directions;
}

// The surface of the found case around one node.
class NodeSurface {
public:
  NodeSurface(const formats::CenterlineTree& tree, const field::BlendedField& surface,
              std::uint32_t node)
      : m_surface(surface),
        m_node(node),
        m_centre(toEigen(tree.centre[node])),
        m_radius(static_cast<double>(tree.radius[node])) {}

  // The point of the surface reached along the gradient; empty if there is none or it lies outside
  // of the node's own power cell.
  [[nodiscard]] std::optional<Vector3d> project(const Vector3d& point) const {
    const auto found = projectOnSurface(m_surface, point, m_node, m_radius);
    if (!found || found->node != m_node) return std::nullopt;
    return found->position;
  }

  // The first point of the surface along a ray from the node's centre; empty if there is none
  // within 4 radii, or not in the node's own power cell.
  [[nodiscard]] std::optional<Vector3d> cast(const Vector3d& direction) const {
    const auto inside = [&](double t) { return isInside(m_centre + t * direction); };
    if (!inside(0)) return std::nullopt;
    double low = 0, high = kRayStep * m_radius;
    while (inside(high)) {
      low = high;
      high += kRayStep * m_radius;
      if (high > kRayReach * m_radius) return std::nullopt;
    }
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (inside(middle) ? low : high) = middle;
    }
    const Vector3d point = m_centre + 0.5 * (low + high) * direction;
    if (follow(point) != m_node) return std::nullopt;
    return point;
  }

private:
  [[nodiscard]] std::uint32_t follow(const Vector3d& p) const {
    return m_surface.follow({p.x(), p.y(), p.z()}, m_node);
  }
  [[nodiscard]] bool isInside(const Vector3d& p) const {
    return m_surface.blended({p.x(), p.y(), p.z()}, follow(p)).value > m_surface.level();
  }

  const field::BlendedField& m_surface;
  std::uint32_t m_node;
  Vector3d m_centre;
  double m_radius;
};

// The wall of the truth, and its excluded places.
class TrueWall {
public:
  explicit TrueWall(const CenterlineTree& truth)
      : m_truth(truth), m_all(truth), m_joined(truth.branches.size()) {
    for (std::uint32_t b = 0; b < truth.branches.size(); ++b) {
      m_branch.emplace_back(truth, b);
      if (truth.branches[b].parentNode == formats::kNoParent) continue;
      const std::uint32_t parent =
          truth.branch[static_cast<std::size_t>(truth.branches[b].parentNode)];
      m_joined[b].push_back(parent);
      m_joined[parent].push_back(b);
    }
  }

  [[nodiscard]] WallHit nearest(const Vector3d& point) const { return m_all.nearest(point); }

  [[nodiscard]] bool isAwayFromEndsAndJunctions(const Vector3d& point, const WallHit& hit) const {
    const formats::Branch& branch = m_truth.branches[hit.branch];
    const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
    const std::uint32_t next = std::min(hit.node + 1, last);
    const Vector3d a = toEigen(m_truth.centre[hit.node]), b = toEigen(m_truth.centre[next]);
    const Vector3d foot = a + hit.along * (b - a);
    const auto from = static_cast<double>(m_truth.radius[hit.node]);
    const double radius = from + hit.along * (static_cast<double>(m_truth.radius[next]) - from);
    for (const std::uint32_t end : {branch.firstNode, last})
      // an aneurysm's last node is the centre of its sac, not an open end
      if ((branch.kind == formats::BranchKind::Vessel || end != last) &&
          (foot - toEigen(m_truth.centre[end])).norm() <= radius)
        return false;
    return std::none_of(
        m_joined[hit.branch].begin(), m_joined[hit.branch].end(),
        [&](std::uint32_t other) { return m_branch[other].nearest(point).distance <= radius; });
  }

private:
  const CenterlineTree& m_truth;
  TubeTreeDistance m_all;
  std::vector<TubeTreeDistance> m_branch;
  std::vector<std::vector<std::uint32_t>> m_joined;  // parent and children of each branch
};

// Whether a point lies beyond the first or the last node of the node's branch.
bool isBeyondEnds(const CenterlineTree& tree, std::uint32_t node, const Vector3d& point) {
  const formats::Branch& branch = tree.branches[tree.branch[node]];
  const double along = (point - toEigen(tree.centre[node])).dot(toEigen(tree.direction[node]));
  const bool isFirst = node == branch.firstNode;
  const bool isLast = node + 1 == branch.firstNode + branch.nodeCount;
  return (isFirst && along < 0) || (isLast && along > 0);
}

std::vector<Vector3d> surfaceSamples(const formats::Case& found, const field::BlendedField& field,
                                     std::uint32_t node, const std::vector<Vector3d>& rays) {
  const NodeSurface surface(found.tree, field, node);
  std::vector<Vector3d> samples;
  const auto add = [&](const std::optional<Vector3d>& point) {
    if (point && !isBeyondEnds(found.tree, node, *point)) samples.push_back(*point);
  };
  if (found.points && found.points->offset[node] < found.points->offset[node + 1]) {
    for (std::uint32_t p = found.points->offset[node]; p < found.points->offset[node + 1]; ++p)
      add(surface.project(toEigen(found.points->position[p])));
    return samples;
  }
  for (const Vector3d& ray : rays) add(surface.cast(ray));
  return samples;
}

std::optional<Quantiles> computeQuantiles(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  return Quantiles{nearestRank(values, 0.5), nearestRank(values, 0.9), nearestRank(values, 1.0)};
}

}  // namespace

WallComparison compareWalls(const formats::Case& found, const CenterlineTree& truth,
                            Progress& progress) {
  const CenterlineTree& tree = found.tree;
  const TrueWall wall(truth);
  const field::BlendedField field = formats::caseField(found);
  const std::vector<Vector3d> rays = rayDirections();
  struct Sample {
    std::uint32_t branch;
    double distance;
  };
  std::vector<std::vector<Sample>> samples(tree.nodeCount());
  tbb::parallel_for(std::size_t{0}, tree.nodeCount(), [&](std::size_t n) {
    const auto node = static_cast<std::uint32_t>(n);
    progress.check();
    for (const Vector3d& point : surfaceSamples(found, field, node, rays)) {
      const WallHit hit = wall.nearest(point);
      if (wall.isAwayFromEndsAndJunctions(point, hit))
        samples[n].push_back({hit.branch, std::abs(hit.distance)});
    }
    progress.advance();
  });
  std::vector<double> all;
  std::vector<std::vector<double>> each(truth.branches.size());
  for (const std::vector<Sample>& node : samples)
    for (const Sample& sample : node) {
      all.push_back(sample.distance);
      each[sample.branch].push_back(sample.distance);
    }
  WallComparison result;
  result.all = computeQuantiles(std::move(all));
  for (std::vector<double>& values : each)
    result.branch.push_back(computeQuantiles(std::move(values)));
  return result;
}

}  // namespace lumen::convert
