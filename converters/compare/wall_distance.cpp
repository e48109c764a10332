// SPDX-License-Identifier: Apache-2.0
#include "converters/compare/wall_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Core>
#include <tbb/parallel_for.h>

#include "converters/common/statistics.h"
#include "converters/common/tube_tree_distance.h"
#include "converters/common/vectors.h"
#include "formats/case/blobby.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::CenterlineTree;

constexpr int kNewtonSteps = 30;
constexpr int kBisections = 40;
constexpr int kRays = 64;
constexpr double kOnSurface = 1e-3;  // of the node's radius

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

// The surface of one node's model.
class NodeSurface {
public:
  NodeSurface(const formats::Case& value, std::uint32_t node)
      : m_models(*value.models),
        m_node(node),
        m_centre(toEigen(value.tree.centre[node])),
        m_radius(static_cast<double>(value.tree.radius[node])) {}

  // The point on the surface that Newton's method along the gradient reaches; false if it does not
  // converge.
  bool project(Vector3d& point) const {
    for (int i = 0; i < kNewtonSteps; ++i) {
      const formats::FieldValue value = at(point);
      const Vector3d gradient(value.gradient.x, value.gradient.y, value.gradient.z);
      const double slope = gradient.squaredNorm();
      if (!(slope > 1e-20)) return false;
      Vector3d step = gradient * ((m_models.isoLevel - value.f) / slope);
      if (step.norm() <= kOnSurface * m_radius) {
        point += step;
        return true;
      }
      // far from the wall the field is flat and the step too long
      if (step.norm() > 0.3 * m_radius) step *= 0.3 * m_radius / step.norm();
      point += step;
    }
    return false;
  }

  // The first point of the surface along a ray from the node's centre; false if there is none
  // within 4 radii.
  bool cast(const Vector3d& direction, Vector3d& point) const {
    const auto inside = [&](double t) {
      return at(m_centre + t * direction).f > m_models.isoLevel;
    };
    if (!inside(0)) return false;
    double low = 0, high = 0.125 * m_radius;
    while (inside(high)) {
      low = high;
      high += 0.125 * m_radius;
      if (high > 4 * m_radius) return false;
    }
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (inside(middle) ? low : high) = middle;
    }
    point = m_centre + 0.5 * (low + high) * direction;
    return true;
  }

private:
  [[nodiscard]] formats::FieldValue at(const Vector3d& p) const {
    return formats::evaluateField(m_models, m_node, {p.x(), p.y(), p.z()});
  }

  const formats::BlobbyModels& m_models;
  std::uint32_t m_node;
  Vector3d m_centre;
  double m_radius;
};

// The wall of the truth, and where it should not be looked at.
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
  std::vector<std::vector<std::uint32_t>> m_joined;  // for each branch, its parent and children
};

// The part of space in which a node's own model speaks.
class Cell {
public:
  Cell(const CenterlineTree& tree, const formats::Neighbours& neighbours, std::uint32_t node)
      : m_tree(tree), m_neighbours(neighbours.of(node)), m_node(node) {
    const formats::Branch& branch = tree.branches[tree.branch[node]];
    m_isFirst = node == branch.firstNode;
    m_isLast = node + 1 == branch.firstNode + branch.nodeCount;
  }

  [[nodiscard]] bool holds(const Vector3d& point) const {
    const double along =
        (point - toEigen(m_tree.centre[m_node])).dot(toEigen(m_tree.direction[m_node]));
    if ((m_isFirst && along < 0) || (m_isLast && along > 0)) return false;
    const double own = power(m_node, point);
    return std::none_of(m_neighbours.begin(), m_neighbours.end(),
                        [&](std::uint32_t n) { return power(n, point) < own; });
  }

private:
  [[nodiscard]] double power(std::uint32_t node, const Vector3d& point) const {
    const auto radius = static_cast<double>(m_tree.radius[node]);
    return (point - toEigen(m_tree.centre[node])).squaredNorm() - radius * radius;
  }

  const CenterlineTree& m_tree;
  std::span<const std::uint32_t> m_neighbours;
  std::uint32_t m_node;
  bool m_isFirst, m_isLast;
};

std::vector<Vector3d> surfaceSamples(const formats::Case& found, std::uint32_t node,
                                     const std::vector<Vector3d>& rays) {
  const NodeSurface surface(found, node);
  std::vector<Vector3d> samples;
  if (found.points && found.points->offset[node] < found.points->offset[node + 1]) {
    for (std::uint32_t p = found.points->offset[node]; p < found.points->offset[node + 1]; ++p) {
      Vector3d point = toEigen(found.points->position[p]);
      if (surface.project(point)) samples.push_back(point);
    }
    return samples;
  }
  Vector3d point;
  for (const Vector3d& ray : rays)
    if (surface.cast(ray, point)) samples.push_back(point);
  return samples;
}

std::optional<Quantiles> quantilesOf(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  return Quantiles{nearestRank(values, 0.5), nearestRank(values, 0.9), nearestRank(values, 1.0)};
}

}  // namespace

WallComparison compareWalls(const formats::Case& found, const CenterlineTree& truth,
                            Progress& progress) {
  const CenterlineTree& tree = found.tree;
  const TrueWall wall(truth);
  const formats::Neighbours neighbours(tree);
  const std::vector<Vector3d> rays = rayDirections();
  struct Sample {
    std::uint32_t branch;
    double distance;
  };
  std::vector<std::vector<Sample>> samples(tree.nodeCount());
  tbb::parallel_for(std::size_t{0}, tree.nodeCount(), [&](std::size_t n) {
    const auto node = static_cast<std::uint32_t>(n);
    progress.check();
    const Cell cell(tree, neighbours, node);
    for (const Vector3d& point : surfaceSamples(found, node, rays)) {
      if (!cell.holds(point)) continue;
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
  result.all = quantilesOf(std::move(all));
  for (std::vector<double>& values : each) result.branch.push_back(quantilesOf(std::move(values)));
  return result;
}

}  // namespace lumen::convert
