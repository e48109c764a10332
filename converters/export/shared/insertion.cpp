// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/insertion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/geometry/mesh_edges.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

/// The edges that a group shares with the wall, as the triangles of the group have them.
struct Rim {
  std::vector<std::array<Eigen::Vector3d, 2>> edges;

  [[nodiscard]] Eigen::Vector3d middle() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double length = 0;
    for (const auto& [a, b] : edges) {
      sum += 0.5 * (b - a).norm() * (a + b);
      length += (b - a).norm();
    }
    return length > 0 ? Eigen::Vector3d(sum / length) : sum;
  }
  /// The normal of the area within the rim, times the area; by Stokes, so for rims that are not
  /// flat too.
  [[nodiscard]] Eigen::Vector3d vectorArea() const {
    const Eigen::Vector3d m = middle();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& [a, b] : edges) sum += 0.5 * (a - m).cross(b - m);
    return sum;
  }
};

Eigen::Vector3d pointOf(const SurfaceMesh& mesh, std::uint32_t vertex) {
  return toEigen(mesh.position[vertex]);
}

std::vector<Rim> findRims(const SurfaceMesh& mesh) {
  std::vector<Rim> rims(mesh.groups.size());
  const std::vector<EdgeUse> uses = edgeUses(mesh.triangle);
  forEachEdge(uses, [&](std::span<const EdgeUse> edge) {
    const bool meetsWall = std::any_of(edge.begin(), edge.end(), [&](const EdgeUse& use) {
      return mesh.group[use.side / 3] == 0;
    });
    if (!meetsWall) return;
    for (const EdgeUse& use : edge)
      if (const std::uint32_t group = mesh.group[use.side / 3]; group != 0)
        rims[group].edges.push_back({pointOf(mesh, startOf(mesh.triangle, use.side)),
                                     pointOf(mesh, endOf(mesh.triangle, use.side))});
  });
  return rims;
}

/// The mean normal of a group's faces, times their area.
Eigen::Vector3d faceArea(const SurfaceMesh& mesh, std::uint32_t group) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    if (mesh.group[t] != group) continue;
    const Eigen::Vector3d a = pointOf(mesh, mesh.triangle[t][0]);
    sum += 0.5 *
           (pointOf(mesh, mesh.triangle[t][1]) - a).cross(pointOf(mesh, mesh.triangle[t][2]) - a);
  }
  return sum;
}

NamedEnd endAt(const formats::CenterlineTree& tree, std::uint32_t node, bool isInlet) {
  NamedEnd end;
  end.kind = isInlet ? FaceKind::Inlet : FaceKind::Outlet;
  end.position = toEigen(tree.centre[node]);
  end.direction = (isInlet ? -1 : 1) * toEigen(tree.direction[node]);
  end.radius = tree.radius[node];
  return end;
}

bool isJoined(const formats::CenterlineTree& tree, std::uint32_t node) {
  const auto holds = [node](const auto& link) { return link[0] == node || link[1] == node; };
  return std::any_of(tree.links.begin(), tree.links.end(), holds) ||
         std::any_of(tree.branches.begin(), tree.branches.end(), [node](const auto& branch) {
           return branch.parentNode == static_cast<std::int32_t>(node);
         });
}

}  // namespace

std::vector<NamedEnd> findEnds(const SurfaceMesh& mesh) {
  const std::vector<Rim> rims = findRims(mesh);
  std::vector<NamedEnd> ends;
  for (std::uint32_t g = 0; g < mesh.groups.size(); ++g) {
    if (mesh.groups[g].kind == FaceKind::Wall || rims[g].edges.empty()) continue;
    const Eigen::Vector3d area = rims[g].vectorArea();
    NamedEnd end{mesh.groups[g].name, mesh.groups[g].kind, rims[g].middle(), area.normalized(),
                 std::sqrt(area.norm() / std::numbers::pi)};
    // the ring of a thick wall runs the other way round its inner rim
    if (faceArea(mesh, g).dot(end.direction) < 0) end.direction = -end.direction;
    ends.push_back(std::move(end));
  }
  return ends;
}

std::vector<NamedEnd> findEnds(const formats::CenterlineTree& tree) {
  const auto isRoot = [](const formats::Branch& branch) {
    return branch.kind == formats::BranchKind::Vessel && branch.nodeCount > 0 &&
           branch.parentNode < 0;
  };
  const bool isForest = std::count_if(tree.branches.begin(), tree.branches.end(), isRoot) > 1;
  std::vector<NamedEnd> ends;
  for (const formats::Branch& branch : tree.branches) {
    if (branch.kind == formats::BranchKind::Aneurysm || branch.nodeCount == 0) continue;
    const std::uint32_t first = branch.firstNode, last = first + branch.nodeCount - 1;
    if (isRoot(branch) && !isJoined(tree, first)) {
      ends.push_back(endAt(tree, first, true));
      ends.back().name = isForest ? "inlet-" + branch.label : "inlet";
    }
    if (!isJoined(tree, last)) {
      ends.push_back(endAt(tree, last, false));
      ends.back().name = "outlet-" + branch.label;
    }
  }
  return ends;
}

namespace {

using formats::BranchKind;
using formats::CenterlineTree;

Eigen::Vector3d centreOf(const CenterlineTree& tree, std::uint32_t node) {
  const formats::Vec3f& c = tree.centre[node];
  return {c.x, c.y, c.z};
}

std::string labelsOf(const CenterlineTree& tree) {
  constexpr std::size_t kNamed = 20;
  std::string text;
  for (std::size_t b = 0; b < std::min(tree.branches.size(), kNamed); ++b)
    text += (b == 0 ? "" : ", ") + formats::printable(tree.branches[b].label);
  const std::size_t more = tree.branches.size() - std::min(tree.branches.size(), kNamed);
  return more == 0 ? text : text + " and " + std::to_string(more) + " more";
}

std::uint32_t branchToEnter(const CenterlineTree& tree, const std::string& label,
                            const FieldWord& word) {
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    const bool isRoot =
        branch.parentNode == formats::kNoParent && branch.kind == BranchKind::Vessel;
    if (branch.nodeCount > 0 && (label.empty() ? isRoot : branch.label == label)) return b;
  }
  if (label.empty()) throw invalidInput("this case has no vessel that an instrument could enter");
  throw Error(ErrorKind::Usage, word("insert") + " " + formats::printable(label) +
                                    ": no branch has this label; there is " + labelsOf(tree));
}

/// The nodes from the first one of a branch on, each followed by its widest child in a vessel.
std::vector<std::uint32_t> widestPath(const CenterlineTree& tree, std::uint32_t first) {
  std::vector<std::optional<std::uint32_t>> widest(tree.nodeCount());
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    const std::int32_t parent = tree.parent[n];
    if (parent < 0) continue;
    const bool isSac = tree.branches[tree.branch[n]].kind == BranchKind::Aneurysm;
    if (isSac && tree.branch[n] != tree.branch[static_cast<std::uint32_t>(parent)]) continue;
    auto& best = widest[static_cast<std::uint32_t>(parent)];
    if (!best || tree.radius[n] > tree.radius[*best]) best = n;
  }
  std::vector<std::uint32_t> path = {first};
  while (widest[path.back()]) path.push_back(*widest[path.back()]);
  return path;
}

}  // namespace

Insertion findInsertion(const CenterlineTree& tree, const std::string& label, double clearance,
                        const FieldWord& word) {
  Insertion result;
  result.branch = branchToEnter(tree, label, word);
  result.path = widestPath(tree, tree.branches[result.branch].firstNode);
  const auto& path = result.path;
  std::vector<double> along = {0};
  for (std::size_t k = 1; k < path.size(); ++k)
    along.push_back(along.back() + (centreOf(tree, path[k]) - centreOf(tree, path[k - 1])).norm());
  // a vessel ends in front of an instrument, a sac is filled from its inside
  const bool isSac = tree.branches[result.branch].kind == BranchKind::Aneurysm;
  const double end = along.back() + (isSac ? clearance : -tree.radius[path.back()]);

  std::size_t k = 0;
  while (k < path.size() &&
         (along[k] < clearance || along[k] + clearance > end || tree.radius[path[k]] < clearance))
    ++k;
  if (k == path.size())
    throw invalidInput("branch " + formats::printable(tree.branches[result.branch].label) +
                       ": an instrument that is inserted there needs a lumen of " +
                       fixedText(clearance, 2) + " mm radius and some length, and there is none; " +
                       word("insert") + " names another branch, " + word("instrument") +
                       " a thinner instrument");
  result.node = path[k];
  result.position = centreOf(tree, path[k]);
  result.radius = tree.radius[path[k]];
  result.pathLength = end - along[k];

  // nodes may jitter sideways by a tenth of a radius, so the direction is taken over a whole one
  std::size_t ahead = k;
  while (ahead + 1 < path.size() && along[ahead] - along[k] < result.radius) ++ahead;
  const Eigen::Vector3d step = centreOf(tree, path[ahead]) - result.position;
  if (step.norm() > 0) result.direction = step.normalized();
  return result;
}

Eigen::Quaterniond turnTo(const Eigen::Vector3d& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), direction);
}

}  // namespace lumen::convert
