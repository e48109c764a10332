// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/measure/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "converters/base/vectors.h"
#include "converters/geometry/icosphere.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/fitting/fit.h"

namespace lumen::convert::test {

using Eigen::Vector3d;

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kBlobs = 40;     // of a cylinder, to either side of its node
constexpr double kStep = 0.2;  // between them, in widths
constexpr double kLevel = 0.1;

Vector3d directionAt(const Tube& tube, double s) {
  constexpr double kDifference = 1e-4;
  return (tube.position(s + kDifference) - tube.position(s - kDifference)).normalized();
}

/// Value of a row of blobs of this width beside its middle.
double fieldOfRow(double width, double distance) {
  constexpr double kParameter = 0.2;
  double sum = 0;
  for (int i = -kBlobs; i <= kBlobs; ++i) {
    const double x = std::pow(distance / width, 2) + std::pow(kStep * i, 2);
    sum += width / std::pow(1 + kParameter * x, 2);
  }
  return sum;
}

/// The width of blobs whose row has a surface at a distance.
double widthFor(double radius) {
  double low = 1e-3 * radius, high = radius;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (fieldOfRow(middle, radius) > kLevel ? high : low) = middle;
  }
  return high;
}

/// Radius in the middle of a node's power cell, which lies off the node where the radius changes.
double radiusOfCell(const Tube& tube, const formats::Branch& branch, std::uint32_t node) {
  constexpr double kDifference = 1e-4;
  const double s = tube.length * (node - branch.firstNode) / (branch.nodeCount - 1);
  const double slope =
      (tube.radius(s + kDifference) - tube.radius(s - kDifference)) / (2 * kDifference);
  return tube.radius(s - tube.radius(s) * slope);
}

}  // namespace

formats::Case treeOf(const std::vector<Tube>& tubes, double spacing) {
  formats::Case value;
  formats::CenterlineTree& tree = value.tree;
  for (const Tube& tube : tubes) {
    const auto index = static_cast<std::uint32_t>(tree.branches.size());
    const int steps = static_cast<int>(std::lround(tube.length / spacing));
    formats::Branch branch;
    branch.label = tube.label;
    branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
    branch.nodeCount = static_cast<std::uint32_t>(steps + 1);
    if (tube.parent >= 0) {
      const formats::Branch& from = tree.branches[static_cast<std::size_t>(tube.parent)];
      const Tube& parent = tubes[static_cast<std::size_t>(tube.parent)];
      branch.parentNode = static_cast<std::int32_t>(from.firstNode) +
                          static_cast<std::int32_t>(
                              std::lround(tube.parentAlong / parent.length * (from.nodeCount - 1)));
    }
    for (int i = 0; i <= steps; ++i) {
      const double s = tube.length * i / steps;
      tree.parent.push_back(i > 0 ? static_cast<std::int32_t>(tree.nodeCount()) - 1
                                  : branch.parentNode);
      tree.centre.push_back(toVec3f(tube.position(s)));
      tree.direction.push_back(toVec3f(directionAt(tube, s)));
      tree.radius.push_back(static_cast<float>(tube.radius(s)));
      tree.height.push_back(static_cast<float>(tube.length / steps));
      tree.branch.push_back(index);
    }
    tree.branches.push_back(branch);
  }
  return value;
}

formats::Case caseOf(const std::vector<Tube>& tubes, double spacing) {
  formats::Case value = treeOf(tubes, spacing);
  formats::BlobbyModels models;
  models.isoLevel = kLevel;
  models.offset.push_back(0);
  for (std::size_t n = 0; n < value.tree.nodeCount(); ++n) {
    const Vector3d centre = toEigen(value.tree.centre[n]);
    const Vector3d along = toEigen(value.tree.direction[n]);
    const std::uint32_t branch = value.tree.branch[n];
    const double width = widthFor(
        radiusOfCell(tubes[branch], value.tree.branches[branch], static_cast<std::uint32_t>(n)));
    for (int i = -kBlobs; i <= kBlobs; ++i) {
      models.centre.push_back(toVec3f(centre + i * kStep * width * along));
      models.width.push_back(static_cast<float>(width));
    }
    models.offset.push_back(static_cast<std::uint32_t>(models.centre.size()));
  }
  value.models = models;
  return value;
}

void addPoints(formats::Case& value, double voxel,
               const std::function<double(std::size_t)>& offset) {
  constexpr int kAround = 24;
  value.metadata.voxelSize = voxel;
  formats::PointSets points;
  points.offset.push_back(0);
  for (std::size_t n = 0; n < value.tree.nodeCount(); ++n) {
    const auto [u, v] = planeBasis(toEigen(value.tree.direction[n]));
    for (int i = 0; i < kAround; ++i) {
      const double angle = kTurn * i / kAround;
      const double radius = double{value.tree.radius[n]} + offset(points.position.size());
      points.position.push_back(toVec3f(toEigen(value.tree.centre[n]) +
                                        radius * (std::cos(angle) * u + std::sin(angle) * v)));
    }
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
  }
  value.points = points;
}

Tube straightTube(const Vector3d& from, const Vector3d& along, double length, double radius) {
  Tube tube;
  const Vector3d unit = along.normalized();
  tube.position = [=](double s) -> Vector3d { return from + s * unit; };
  tube.radius = [=](double) { return radius; };
  tube.length = length;
  return tube;
}

Tube helixTube(double helixRadius, double rise, double turns, double radius) {
  Tube tube;
  const double speed = std::hypot(helixRadius, rise);
  tube.position = [=](double s) {
    const double a = s / speed;
    return Vector3d(helixRadius * std::cos(a), helixRadius * std::sin(a), rise * a);
  };
  tube.radius = [=](double) { return radius; };
  tube.length = kTurn * turns * speed;
  return tube;
}

Tube arcTube(double bend, double angle, double radius) {
  Tube tube = helixTube(bend, 0, angle / kTurn, radius);
  return tube;
}

using Eigen::Vector3d;

namespace {

constexpr double kFarthest = 2.4;  // radii

// Distance along a ray from inside to the wall, mm.
double reach(const TubeTreeDistance& wall, const Vector3d& from, const Vector3d& along) {
  double t = 0;
  for (int i = 0; i < 200; ++i) {
    const double depth = -wall.nearest(from + t * along).distance;
    if (depth < 1e-6) break;
    t += depth;
  }
  return t;
}

}  // namespace

formats::Case caseOfDesign(const Design& design, double spacing, double voxel) {
  const formats::CenterlineTree& all = design.tree;
  const TubeTreeDistance wall(all);
  formats::Case value;
  value.metadata.voxelSize = voxel;
  formats::CenterlineTree& tree = value.tree;
  std::vector<std::int32_t> kept(all.nodeCount(), formats::kNoParent);
  for (std::uint32_t b = 0; b < all.branches.size(); ++b) {
    formats::Branch branch = all.branches[b];
    const std::uint32_t first = branch.firstNode, last = first + branch.nodeCount - 1;
    branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
    std::int32_t before = branch.parentNode == formats::kNoParent
                              ? formats::kNoParent
                              : kept[static_cast<std::size_t>(branch.parentNode)];
    branch.parentNode = before;
    double since = 1e9, widest = 0;
    for (std::uint32_t n = first; n <= last; ++n)
      widest = std::max(widest, static_cast<double>(all.radius[n]));
    for (std::uint32_t n = first; n <= last; ++n) {
      // centres of a sac lie beyond its neck
      if (branch.kind == formats::BranchKind::Aneurysm &&
          static_cast<double>(all.radius[n]) < 0.75 * widest)
        continue;
      since += static_cast<double>(all.height[n]);
      if (since >= spacing * static_cast<double>(all.radius[n]) || n == last) {
        since = 0;
        tree.parent.push_back(before);
        before = static_cast<std::int32_t>(tree.nodeCount());
        tree.centre.push_back(all.centre[n]);
        tree.direction.push_back(all.direction[n]);
        tree.radius.push_back(all.radius[n]);
        tree.height.push_back(static_cast<float>(spacing) * all.radius[n]);
        tree.branch.push_back(b);
      }
      kept[n] = before;
    }
    branch.nodeCount = static_cast<std::uint32_t>(tree.nodeCount()) - branch.firstNode;
    tree.branches.push_back(branch);
  }
  value.points.emplace().offset.push_back(0);
  const std::vector<Vector3d> rays = icosphere(3);
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    for (const Vector3d& ray : rays) {
      const double t = reach(wall, toEigen(tree.centre[n]), ray);
      // a wall of another branch is seen through the neck
      if (wall.nearest(toEigen(tree.centre[n]) + t * ray).branch == tree.branch[n] &&
          t < kFarthest * static_cast<double>(tree.radius[n]))
        value.points->position.push_back(toVec3f(toEigen(tree.centre[n]) + t * ray));
    }
    value.points->offset.push_back(static_cast<std::uint32_t>(value.points->position.size()));
  }
  FitOptions options;
  Progress progress;
  fit(value, options, progress);
  return value;
}

}  // namespace lumen::convert::test
