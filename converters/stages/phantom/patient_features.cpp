// SPDX-License-Identifier: Apache-2.0
// Features that are added to a grown patient; declared in patient.h.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "converters/stages/phantom/patient.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kAneurysmTries = 400;
constexpr int kKissingTries = 60000;

// The balls of a straight sac: the largest ones on its axis that stay inside a neck and a sphere.
Path sacPath(const Vector3d& start, const Vector3d& out, double length, double neck, double sac,
             double step) {
  Path path;
  const int steps = static_cast<int>(std::ceil(length / step));
  for (int i = 0; i <= steps; ++i) {
    const double s = length * i / steps;
    path.push_back({start + s * out, std::max(neck, sac - (length - s))});
  }
  return path;
}

// The clearance of a path's points beyond `from` (an index) to everything but `except`, and their
// depth in the box.
double roomFor(const PatientTree& tree, const Path& path, std::size_t from, int except) {
  double room = std::numeric_limits<double>::infinity();
  for (std::size_t i = from; i < path.size(); i += 2) {
    const PathPoint& p = path[i];
    room = std::min(room, tree.grown.nearestBut(except, p.position, p.radius).clearance);
    room = std::min(room, tree.grown.depthInBox(p.position, p.radius));
    if (room < 0) break;
  }
  return room;
}

// The smallest radius of curvature of an evenly sampled path, measured over `reach` points on both
// sides.
double sharpestBend(const Path& path, std::size_t reach) {
  double sharpest = std::numeric_limits<double>::infinity();
  for (std::size_t i = reach; i + reach < path.size(); ++i) {
    const Vector3d a = path[i].position - path[i - reach].position;
    const Vector3d b = path[i + reach].position - path[i].position;
    const double turn = std::atan2(a.cross(b).norm(), a.dot(b));
    if (turn > 0) sharpest = std::min(sharpest, 0.5 * (a.norm() + b.norm()) / turn);
  }
  return sharpest;
}

// The elements of a kissing branch. Indices are into paths.
struct Kiss {
  int parent, host;
  std::size_t origin;       // on the parent
  std::size_t first, last;  // contact on the host
  double radius;
  Vector3d side;  // unit, across the host at `first`, towards the branch
};

bool pickKiss(PatientTree& tree, Kiss& kiss) {
  Random& random = tree.random;
  const auto count = static_cast<std::uint32_t>(tree.branches.size());
  kiss.parent = static_cast<int>(random.below(count));
  kiss.host = static_cast<int>(random.below(count));
  const GrownBranch& parent = tree.branches[static_cast<std::size_t>(kiss.parent)];
  const GrownBranch& host = tree.branches[static_cast<std::size_t>(kiss.host)];
  if (kiss.parent == kiss.host || kiss.host == 0 || parent.kind != formats::BranchKind::Vessel ||
      host.kind != formats::BranchKind::Vessel)
    return false;
  const std::optional<double> origin = tree.pickOrigin(kiss.parent);
  if (!origin) return false;
  kiss.origin = tree.indexAt(kiss.parent, *origin);
  const double length = tree.measureLength(kiss.host),
               begin = 2 + 4 * host.path.front().radius + 0.2 * tree.scale.contact;
  if (length < begin + tree.scale.contact + 2) return false;
  const double start = random.uniform(begin, length - tree.scale.contact - 1.9);
  kiss.first = tree.indexAt(kiss.host, start);
  kiss.last = tree.indexAt(kiss.host, start + tree.scale.contact);
  kiss.radius = std::max(tree.scale.smallestRadius,
                         random.uniform(0.5, 0.8) * parent.path[kiss.origin].radius);
  // of a similar width as its host, as anterior cerebral arteries are
  const double ratio = kiss.radius / host.path[kiss.first].radius;
  if (ratio < 0.5 || ratio > 1.5) return false;
  const double away = (host.path[kiss.first].position - parent.path[kiss.origin].position).norm();
  if (away < 8 * kiss.radius || away > 60 * kiss.radius) return false;
  const auto [u, v] = perpendiculars(tree.tangentAt(kiss.host, kiss.first));
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  kiss.side = std::cos(angle) * u + std::sin(angle) * v;
  return true;
}

// From the host's axis at `first`, along it with the walls touching; a little of an approach before
// and of a departure after, over which the axes part quadratically.
Path contactPath(const PatientTree& tree, const Kiss& kiss) {
  const Path& host = tree.branches[static_cast<std::size_t>(kiss.host)].path;
  const auto ramp = static_cast<std::size_t>(2.5 / tree.step);
  const std::size_t from = kiss.first > ramp ? kiss.first - ramp : 0;
  const std::size_t to = std::min(host.size() - 1, kiss.last + ramp);
  const double bend = 0.5 / (1.6 * tightestBend(kiss.radius));
  Path path;
  Vector3d side = kiss.side;
  for (std::size_t i = from; i <= to; ++i) {
    const Vector3d tangent = tree.tangentAt(kiss.host, i);
    side = (side - side.dot(tangent) * tangent).normalized();
    const double beyond = tree.step * (i < kiss.first  ? static_cast<double>(kiss.first - i)
                                       : i > kiss.last ? static_cast<double>(i - kiss.last)
                                                       : 0.0);
    const double apart = host[i].radius + kiss.radius + bend * beyond * beyond;
    path.push_back({host[i].position + apart * side, kiss.radius});
  }
  return path;
}

// A cubic from the parent's axis to the beginning of the contact. Empty if it would leave the
// parent at an angle outside of 35 to 80 degrees.
Path approachPath(const PatientTree& tree, const Kiss& kiss, const Path& contact) {
  const Path& parent = tree.branches[static_cast<std::size_t>(kiss.parent)].path;
  const Vector3d from = parent[kiss.origin].position, to = contact.front().position;
  const Vector3d arrival = (contact[1].position - contact[0].position).normalized();
  const double away = (to - from).norm();
  // aim at a point ahead of the contact, so that the curve comes in along it
  Vector3d departure = (to - 0.35 * away * arrival - from).normalized();
  const double angle =
      std::acos(std::clamp(departure.dot(tree.tangentAt(kiss.parent, kiss.origin)), -1.0, 1.0));
  if (angle < 0.61 || angle > 1.4) return {};
  const Vector3d t0 = away * departure, t1 = away * arrival;
  const Path fine = sampleCurve(
      [&](double t) -> Vector3d {
        const double t2 = t * t, t3 = t2 * t;
        return (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * t0 + (3 * t2 - 2 * t3) * to +
               (t3 - t2) * t1;
      },
      [&](double) { return kiss.radius; });
  return resamplePath(fine, tree.step);
}

// From the parent outwards: in the parent's lumen at first, then a gap away from it for good.
bool leavesParent(const PatientTree& tree, const Kiss& kiss, const Path& path) {
  const double parentRadius =
      tree.branches[static_cast<std::size_t>(kiss.parent)].path[kiss.origin].radius;
  const double reach =
      1.7 * (parentRadius + kiss.radius + tree.scale.gap) / 0.57 + 2 * tree.frame.voxel;
  bool left = false;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool clear =
        tree.grown.nearestOnBranch(kiss.parent, path[i].position, kiss.radius).clearance >=
        tree.grown.gap();
    if (left && !clear) return false;
    if (!clear && static_cast<double>(i) * tree.step > reach) return false;
    left = left || clear;
  }
  return left;
}

// Everything but parent and host is a gap away; the host is not entered.
bool fits(const PatientTree& tree, const Kiss& kiss, const Path& path) {
  for (std::size_t i = 0; i < path.size(); i += 2) {
    const Vector3d& p = path[i].position;
    if (tree.grown.depthInBox(p, kiss.radius) < 0) return false;
    for (std::size_t b = 0; b < tree.branches.size(); ++b) {
      const int branch = static_cast<int>(b);
      if (branch == kiss.parent) continue;
      const double clearance = tree.grown.nearestOnBranch(branch, p, kiss.radius).clearance;
      if (clearance < (branch == kiss.host ? -0.02 * kiss.radius : tree.grown.gap())) return false;
    }
  }
  return true;
}

// Continues from the end of the contact, away from the host.
Path departurePath(PatientTree& tree, const Kiss& kiss, const Path& contact) {
  GrowthRequest request;
  const std::size_t n = contact.size();
  request.parent = kiss.host;
  request.start = contact[n - 1].position;
  request.direction = (contact[n - 1].position - contact[n - 2].position).normalized();
  const Path& host = tree.branches[static_cast<std::size_t>(kiss.host)].path;
  const Vector3d near = host[std::min(host.size() - 1, kiss.last)].position;
  request.target =
      request.start + 30 * (request.start - near).normalized() + 30 * request.direction;
  request.startRadius = kiss.radius;
  request.endRadius = std::max(tree.scale.smallestRadius, 0.6 * kiss.radius);
  request.length = 22 * kiss.radius;
  request.freeLength = 7 * kiss.radius + 4;
  request.tortuosity = 0.2;
  return grow(request, tree.grown, tree.step, tree.random);
}

}  // namespace

bool addAneurysm(PatientTree& tree, int parent) {
  const double length = tree.measureLength(parent);
  for (int i = 0; i < kAneurysmTries; ++i) {
    const double arc = tree.random.uniform(0.3, 0.7) * length;
    const std::size_t at = tree.indexAt(parent, arc),
                      reach = static_cast<std::size_t>(2 / tree.step);
    const Path& path = tree.branches[static_cast<std::size_t>(parent)].path;
    if (at < reach || at + reach >= path.size()) continue;
    const Vector3d bend =
        path[at - reach].position + path[at + reach].position - 2 * path[at].position;
    const Vector3d tangent = tree.tangentAt(parent, at);
    // strong bends first, any bend in the end
    const double curvature = bend.norm() / 4;
    if (curvature * tightestBend(path[at].radius) <
        0.6 * (1 - static_cast<double>(i) / kAneurysmTries))
      continue;
    Vector3d out = -bend + 1e-9 * perpendiculars(tangent).first;
    out = (out - out.dot(tangent) * tangent).normalized();
    const double radius = path[at].radius, sac = 1.5 * radius, neck = 0.55 * radius;
    GrownBranch branch;
    branch.path =
        sacPath(path[at].position, out, radius + 0.35 * radius + sac, neck, sac, tree.step);
    branch.label = "aneurysm";
    branch.kind = formats::BranchKind::Aneurysm;
    branch.parent = parent;
    // the sphere touches nothing, its own parent included, and stays in the box
    const Path sphere(1, branch.path.back());
    if (roomFor(tree, sphere, 0, -1) < 0.3 * radius) continue;
    tree.branches[static_cast<std::size_t>(parent)].origins.push_back(arc);
    tree.add(std::move(branch));
    return true;
  }
  return false;
}

bool addKissingBranch(PatientTree& tree, const std::string& label) {
  const auto half = static_cast<std::size_t>(0.5 / tree.step) + 1;
  for (int i = 0; i < kKissingTries; ++i) {
    Kiss kiss;
    if (!pickKiss(tree, kiss)) continue;
    const Path contact = contactPath(tree, kiss);
    Path path = approachPath(tree, kiss, contact);
    if (path.empty()) continue;
    path.insert(path.end(), contact.begin() + 1, contact.end());
    if (sharpestBend(path, half) < 2.5 * kiss.radius || !fits(tree, kiss, path) ||
        !leavesParent(tree, kiss, path))
      continue;
    const Path rest = departurePath(tree, kiss, contact);
    if (pathLength(rest) < 6 * kiss.radius + 3) continue;
    // the part behind the contact also keeps clear of the parent, which the walk did not know
    path.insert(path.end(), rest.begin() + 1, rest.end());
    if (!leavesParent(tree, kiss, path)) continue;
    GrownBranch branch;
    branch.label = label;
    branch.parent = kiss.parent;
    branch.path = resamplePath(path, tree.step);
    tree.branches[static_cast<std::size_t>(kiss.parent)].origins.push_back(
        tree.step * static_cast<double>(kiss.origin));
    tree.kissing = tree.branches[static_cast<std::size_t>(kiss.host)].label + " " + label;
    tree.add(std::move(branch));
    return true;
  }
  return false;
}

}  // namespace lumen::convert
