// SPDX-License-Identifier: Apache-2.0
// Synthetic cases whose models are rows of blobs.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "converters/stages/surface/patches/node_field.h"
#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen::test {

inline formats::Vec3f toVec3f(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Adds a vessel whose nodes lie on `path`, mm; it hangs on node `parent` unless that is kNoParent.
inline void addVessel(formats::Case& target, const std::string& label,
                      const std::vector<Eigen::Vector3d>& path, double radius, double height,
                      std::int32_t parent = formats::kNoParent) {
  formats::CenterlineTree& tree = target.tree;
  formats::Branch branch;
  branch.label = label;
  branch.parentNode = parent;
  branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
  branch.nodeCount = static_cast<std::uint32_t>(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector3d& before = path[i > 0 ? i - 1 : 0];
    const Eigen::Vector3d& after = path[std::min(i + 1, path.size() - 1)];
    const Eigen::Vector3d along =
        path.size() > 1 ? (after - before).normalized() : Eigen::Vector3d::UnitX();
    tree.parent.push_back(i == 0 ? parent : static_cast<std::int32_t>(tree.nodeCount()) - 1);
    tree.centre.push_back(toVec3f(path[i]));
    tree.direction.push_back(toVec3f(along));
    tree.radius.push_back(static_cast<float>(radius));
    tree.height.push_back(static_cast<float>(height));
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
  }
  tree.branches.push_back(branch);
}

inline std::vector<Eigen::Vector3d> straightPath(const Eigen::Vector3d& from,
                                                 const Eigen::Vector3d& step, int nodes) {
  std::vector<Eigen::Vector3d> path;
  for (int i = 0; i < nodes; ++i) path.push_back(from + i * step);
  return path;
}

/// The width of equal blobs `spacing` apart on a long straight line whose surface f = 0.1 mm runs
/// about `radius` from it.
inline double widthInRow(double radius, double spacing) {
  double low = 0, high = 2 * radius;
  for (int step = 0; step < 50; ++step) {
    const double width = 0.5 * (low + high);
    double f = 0;
    for (int i = -5; i <= 5; ++i) {
      const double d2 = (radius * radius + spacing * spacing * i * i) / (width * width);
      f += width / ((1 + 0.2 * d2) * (1 + 0.2 * d2));
    }
    (f > 0.1 ? high : low) = width;
  }
  return high;
}

/// Gives each node the blobs of all nodes within two edges: a blob on each of them, one halfway to
/// its child in its branch, and two beyond a branch's end, so that the wall stays straight there.
inline void addModels(formats::Case& target) {
  const formats::CenterlineTree& tree = target.tree;
  formats::BlobbyModels& models = target.models.emplace();
  const auto centreOf = [&](std::uint32_t node) {
    return Eigen::Vector3d(tree.centre[node].x, tree.centre[node].y, tree.centre[node].z);
  };
  const auto addBlobsOf = [&](std::uint32_t node) {
    const formats::Branch& branch = tree.branches[tree.branch[node]];
    const bool isFirst = node == branch.firstNode;
    const bool isLast = node + 1 == branch.firstNode + branch.nodeCount;
    const Eigen::Vector3d step =
        0.5 * (isLast ? Eigen::Vector3d(centreOf(node) - centreOf(node - 1))
                      : Eigen::Vector3d(centreOf(node + 1) - centreOf(node)));
    const double width = widthInRow(double{tree.radius[node]}, step.norm());
    for (int i = isFirst && branch.parentNode < 0 ? -2 : 0; i <= (isLast ? 2 : 1); ++i) {
      models.centre.push_back(toVec3f(centreOf(node) + i * step));
      models.width.push_back(static_cast<float>(width));
    }
  };
  const formats::Neighbours neighbours(tree);
  models.offset = {0};
  for (std::uint32_t node = 0; node < tree.nodeCount(); ++node) {
    for (const std::uint32_t other : neighbours.within(node, 2)) addBlobsOf(other);
    models.offset.push_back(static_cast<std::uint32_t>(models.centre.size()));
  }
}

/// `nodes` nodes 1 mm apart along x from the origin, radius 1 mm, voxels of 0.2 mm.
inline formats::Case tubeCase(int nodes) {
  formats::Case result;
  result.metadata.voxelSize = 0.2;
  addVessel(result, "tube", straightPath({0.03, 0.05, 0.07}, {1, 0, 0}, nodes), 1.0, 2.0);
  addModels(result);
  return result;
}

/// One blob whose surface has `radius`, as an aneurysm so that no end is cut.
inline formats::Case sphereCase(double radius, double width) {
  formats::Case result;
  result.metadata.voxelSize = 0.2;
  addVessel(result, "sphere", {{0.03, 0.05, 0.07}}, radius, 0.0);
  result.tree.branches[0].kind = formats::BranchKind::Aneurysm;
  formats::BlobbyModels& models = result.models.emplace();
  models.offset = {0, 1};
  models.centre = {result.tree.centre[0]};
  models.width = {static_cast<float>(width)};
  return result;
}

/// Distance from the axis of a tube along x through (0, 0.05, 0.07) mm.
inline double offAxis(const Eigen::Vector3d& p) {
  return std::hypot(p.y() - 0.05, p.z() - 0.07);
}

}  // namespace lumen::test
