// SPDX-License-Identifier: Apache-2.0
// A random tree that resembles the arteries of one side of the brain. Synthetic: no patient's data
// went in.
#include "converters/stages/phantom/patient.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/number_text.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kAttempts = 40;  // trees
constexpr int kTriesPerBranch = 150;
constexpr int kLargeBranches = 6;  // children of the root that come before the kissing pair
constexpr double kDegree = std::numbers::pi / 180;

std::string numbered(std::size_t number) {
  const std::string digits = std::to_string(number);
  return (digits.size() < 2 ? "b0" : "b") + digits;
}

// The stem: in through the face z = 0, up, then over to one side, tapering all the way.
bool growRoot(PatientTree& tree) {
  const double e = tree.frame.extent;
  GrowthRequest request;
  request.start = Vector3d(0.47 * e, 0.5 * e, 0);
  request.direction = Vector3d::UnitZ();
  request.target = Vector3d(0.8 * e, 0.45 * e, 0.85 * e);
  request.startRadius = tree.scale.rootRadius;
  request.endRadius = 0.35 * tree.scale.rootRadius;
  request.length = 1.35 * e;
  request.straight = 2 * request.startRadius;
  request.tortuosity = 0.75;
  GrownBranch root;
  root.label = "root";
  root.path = grow(request, tree.grown, tree.step, tree.random);
  if (pathLength(root.path) < 0.9 * e) return false;
  tree.add(std::move(root));
  return true;
}

// The emptiest of some random points ahead.
Vector3d pickTarget(PatientTree& tree, const Vector3d& from, const Vector3d& tangent,
                    double length) {
  Vector3d best = from + length * tangent;
  double emptiest = -1;
  for (int i = 0; i < 16; ++i) {
    const Vector3d point = tree.randomPoint();
    const Vector3d to = point - from;
    if (to.norm() < 0.5 * length || to.dot(tangent) < -0.2 * to.norm()) continue;
    const double room = tree.grown.nearestBut(-1, point, 0).clearance;
    if (room > emptiest) {
      emptiest = room;
      best = point;
    }
  }
  return best;
}

bool growChild(PatientTree& tree, int parent, double lowRatio, double highRatio) {
  const std::optional<double> origin = tree.pickOrigin(parent);
  if (!origin) return false;
  const std::size_t index = tree.indexAt(parent, *origin);
  const PathPoint from = tree.branches[static_cast<std::size_t>(parent)].path[index];
  const Vector3d tangent = tree.tangentAt(parent, index);
  Random& random = tree.random;

  GrowthRequest request;
  request.parent = parent;
  request.start = from.position;
  request.startRadius =
      std::max(tree.scale.smallestRadius, random.uniform(lowRatio, highRatio) * from.radius);
  if (request.startRadius > 0.85 * from.radius) return false;
  request.endRadius =
      std::max(tree.scale.smallestRadius, random.uniform(0.35, 0.65) * request.startRadius);
  request.length = request.startRadius * random.uniform(40, 70) * std::pow(tree.scale.length, 0.7);
  request.target = pickTarget(tree, from.position, tangent, request.length);
  // leave towards the target, at an angle of its own
  const double angle = random.uniform(38, 76) * kDegree;
  Vector3d side = request.target - from.position;
  side = (side - side.dot(tangent) * tangent).normalized();
  side = Eigen::AngleAxisd(random.uniform(-40, 40) * kDegree, tangent) * side;
  request.direction = std::cos(angle) * tangent + std::sin(angle) * side;
  const double reach = (from.radius + request.startRadius + tree.scale.gap) / std::sin(angle);
  request.straight = 0.9 * reach;
  request.freeLength = 1.5 * reach + 2 * tree.frame.voxel;

  GrownBranch child;
  child.path = grow(request, tree.grown, tree.step, random);
  if (pathLength(child.path) <
      std::max(0.35 * request.length, request.freeLength + 8 * request.startRadius))
    return false;
  child.parent = parent;
  child.label = numbered(tree.branches.size() - 1);
  tree.branches[static_cast<std::size_t>(parent)].origins.push_back(*origin);
  tree.add(std::move(child));
  return true;
}

// Long wide branches have more children.
int pickParent(PatientTree& tree) {
  std::vector<double> weights;
  double sum = 0;
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const GrownBranch& branch = tree.branches[b];
    const double radius = branch.path[branch.path.size() / 2].radius;
    const bool bears = branch.kind == formats::BranchKind::Vessel &&
                       0.8 * branch.path.front().radius > tree.scale.smallestRadius;
    weights.push_back(bears ? tree.measureLength(static_cast<int>(b)) * std::sqrt(radius) /
                                  static_cast<double>(1 + branch.origins.size())
                            : 0.0);
    sum += weights.back();
  }
  double left = tree.random.uniform() * sum;
  for (std::size_t b = 0; b < weights.size(); ++b) {
    left -= weights[b];
    if (left < 0 && weights[b] > 0) return static_cast<int>(b);
  }
  return 0;
}

// Grows until `wanted` branches are there; false if the tries run out.
bool fill(PatientTree& tree, std::size_t wanted, bool fromRoot, Progress& progress) {
  int tries = 0;
  while (tree.branches.size() < wanted) {
    progress.check();
    if (++tries > kTriesPerBranch * static_cast<int>(wanted)) return false;
    if (fromRoot)
      growChild(tree, 0, 0.62, 0.85);
    else
      growChild(tree, pickParent(tree), 0.5, 0.85);
  }
  return true;
}

bool build(PatientTree& tree, Progress& progress) {
  const auto wanted = static_cast<std::size_t>(tree.scale.branches);
  if (!growRoot(tree) || !addAneurysm(tree, 0)) return false;
  const std::size_t large = std::min<std::size_t>(kLargeBranches, wanted / 4);
  if (!fill(tree, tree.branches.size() + large, true, progress)) return false;
  if (!addKissingBranch(tree, numbered(tree.branches.size() - 1))) return false;
  return fill(tree, wanted, false, progress);
}

Design asDesign(const PatientTree& tree) {
  TreeBuilder builder(tree.frame);
  for (const GrownBranch& branch : tree.branches)
    builder.add(branch.label, branch.parent < 0 ? formats::kNoParent : branch.parent, branch.path,
                branch.kind);
  builder.design().notes["kissing"] = tree.kissing;
  return builder.design();
}

}  // namespace

PatientScale::PatientScale(const Frame& frame)
    : rootRadius(std::min(2.2, frame.extent / 23)),
      smallestRadius(std::min(rootRadius / 3, std::max(0.25, 1.25 * frame.voxel))),
      length(std::clamp(frame.extent / 102.4, 0.2, 1.5)),
      margin(5 * frame.voxel),
      gap(2.5 * frame.voxel),
      contact(std::min(11.0, 0.22 * frame.extent)),
      branches(std::clamp(static_cast<int>(40 * frame.extent / 45), 8, 40)) {}

PatientTree::PatientTree(const Frame& f, std::uint64_t seed, std::uint64_t attempt)
    : frame(f),
      scale(f),
      step(f.nodeSpacing()),
      random(seed, attempt),
      grown(scale.gap, Vector3d::Constant(scale.margin),
            Vector3d::Constant(f.extent - scale.margin)) {}

int PatientTree::add(GrownBranch branch) {
  const int index = static_cast<int>(branches.size());
  grown.add(branch.path, index);
  branches.push_back(std::move(branch));
  return index;
}

std::size_t PatientTree::indexAt(int branch, double arc) const {
  const Path& path = branches[static_cast<std::size_t>(branch)].path;
  return std::min(path.size() - 1,
                  static_cast<std::size_t>(std::lround(std::max(0.0, arc) / step)));
}

Vector3d PatientTree::tangentAt(int branch, std::size_t index) const {
  const Path& path = branches[static_cast<std::size_t>(branch)].path;
  const std::size_t before = index == 0 ? 0 : index - 1,
                    after = std::min(index + 1, path.size() - 1);
  return (path[after].position - path[before].position).normalized();
}

double PatientTree::measureLength(int branch) const {
  return step * static_cast<double>(branches[static_cast<std::size_t>(branch)].path.size() - 1);
}

std::optional<double> PatientTree::pickOrigin(int branch) {
  const GrownBranch& from = branches[static_cast<std::size_t>(branch)];
  const double first = 6 * from.path.front().radius,
               last = measureLength(branch) - 4 * from.path.back().radius;
  if (last <= first) return std::nullopt;
  const double arc = random.uniform(first, last);
  const double apart = 4.5 * from.path[indexAt(branch, arc)].radius;
  for (const double other : from.origins)
    if (std::abs(other - arc) < apart) return std::nullopt;
  return arc;
}

Vector3d PatientTree::randomPoint() {
  const double low = 2 * scale.margin, high = frame.extent - 2 * scale.margin;
  const double x = random.uniform(low, high), y = random.uniform(low, high);
  return {x, y, random.uniform(low, high)};
}

Design designPatient(const Frame& frame, std::uint64_t seed, Progress& progress) {
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    PatientTree tree(frame, seed, attempt);
    if (build(tree, progress)) return asDesign(tree);
  }
  throw failed("phantom patient: found no tree for seed " + std::to_string(seed) + " in " +
               fixedText(frame.extent, 6) + " mm; try another seed or a larger volume");
}

}  // namespace lumen::convert
