// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/posing.h"

#include "converters/base/vectors.h"
#include "formats/case/motion.h"

namespace lumen::convert {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// The neighbours of each node along its vessel: its parent, and the child that goes on straightest; the
// node itself where it has none.
struct Chain {
  std::vector<std::uint32_t> before, after;

  // The node to which steps along `next` lead from a node until they are at least a radius long: between
  // nodes that lie close together a direction is little but their errors.
  static std::uint32_t aRadiusOn(const formats::CenterlineTree& tree,
                                 const std::vector<std::uint32_t>& next, std::uint32_t from) {
    double way = 0;
    std::uint32_t at = from;
    while (way < double{tree.radius[from]} && next[at] != at) {
      way += (toEigen(tree.centre[next[at]]) - toEigen(tree.centre[at])).norm();
      at = next[at];
    }
    return at;
  }

  explicit Chain(const formats::CenterlineTree& tree) {
    std::vector<double> straightest(tree.nodeCount(), -2.0);
    for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
      before.push_back(i);
      after.push_back(i);
    }
    for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
      if (tree.parent[i] < 0) continue;
      const auto parent = static_cast<std::uint32_t>(tree.parent[i]);
      before[i] = parent;
      const Vector3d step = toEigen(tree.centre[i]) - toEigen(tree.centre[parent]);
      const double length = step.norm();
      const double cosine = length > 0 ? step.dot(toEigen(tree.direction[parent])) / length : -1;
      // the vessel itself goes on, whichever way it turns
      const double rank = cosine + (tree.branch[i] == tree.branch[parent] ? 3 : 0);
      if (rank <= straightest[parent]) continue;
      straightest[parent] = rank;
      after[parent] = i;
    }
  }
};

std::vector<field::NodePose> exactly(const std::vector<formats::Pose>& poses) {
  std::vector<field::NodePose> exact;
  exact.reserve(poses.size());
  for (const formats::Pose& pose : poses) exact.push_back(formats::nodePoseOf(pose));
  return exact;
}

}  // namespace

Quaterniond rotationOf(const formats::Pose& pose) {
  const auto& q = pose.rotation;
  return Quaterniond(q[3], q[0], q[1], q[2]).normalized();
}

formats::Pose poseOf(const Vector3d& centre, const Quaterniond& rotation, double factor) {
  formats::Pose pose;
  pose.centre = toVec3f(centre);
  const Eigen::Vector4f q = rotation.normalized().coeffs().cast<float>();
  pose.rotation = {q[0], q[1], q[2], q[3]};
  pose.factor = static_cast<float>(factor);
  return pose;
}

formats::CenterlineTree posedTree(const formats::CenterlineTree& rest,
                                  const std::vector<formats::Pose>& poses) {
  formats::CenterlineTree tree = rest;
  formats::carryTree(exactly(poses), tree);
  return tree;
}

formats::Case posedWalls(const formats::Case& rest, const std::vector<formats::Pose>& poses) {
  formats::Case posed;
  posed.metadata = rest.metadata;
  posed.nodeArrays = rest.nodeArrays;
  posed.tree = posedTree(rest.tree, poses);
  posed.points = rest.points;
  if (posed.points)
    formats::carryOwned(rest.tree, exactly(poses), posed.points->offset, posed.points->position);
  return posed;
}

std::vector<formats::Pose> posesFromCentres(const formats::CenterlineTree& rest,
                                            const std::vector<Vector3d>& centres,
                                            const std::vector<double>& factors) {
  const Chain chain(rest);
  std::vector<formats::Pose> poses;
  for (std::uint32_t i = 0; i < rest.nodeCount(); ++i) {
    const std::uint32_t a = Chain::aRadiusOn(rest, chain.before, i),
                        b = Chain::aRadiusOn(rest, chain.after, i);
    const Vector3d before = toEigen(rest.centre[b]) - toEigen(rest.centre[a]);
    const Vector3d now = centres[b] - centres[a];
    const Quaterniond turn = before.norm() > 0 && now.norm() > 0
                                 ? Quaterniond::FromTwoVectors(before, now)
                                 : Quaterniond::Identity();
    poses.push_back(poseOf(centres[i], turn, factors[i]));
  }
  return poses;
}

}  // namespace lumen::convert
