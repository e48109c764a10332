// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/sac_walls.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/stages/tracking/lumen_paths.h"
#include "converters/stages/tracking/sac_region.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::NodeOrigin;

/// Distances from its axis, in radii, at which a tube has no lumen any more.
constexpr double kAroundTubeRadii[] = {1.25, 1.5};
/// Share of the directions around an axis: where the lumen continues in more of them, there is no
/// tube.
constexpr double kOpenShare = 1.0 / 3.0;
constexpr int kDirections = 24;
/// Depth in the lumen beyond which a point is on no wall, in voxels.
constexpr double kWithinVoxels = 1.75;
/// About the most wall points of a sac. They are a voxel apart, as nearer ones add nothing; those of
/// a large sac are farther apart.
constexpr double kMostPoints = 4000;

/// One sac: the aneurysms that make it up, and the vessels that open into it, as positions in the
/// seeds' order.
struct Sac {
  std::vector<std::size_t> parts, vessels;
};

/// A piece of a vessel between two of its nodes.
struct VesselPiece {
  Vector3d start, chord;
  double radius, change;

  [[nodiscard]] bool holds(const Vector3d& p) const {
    const double length2 = chord.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - start).dot(chord) / length2, 0.0, 1.0) : 0.0;
    return (p - start - t * chord).norm() < radius + t * change;
  }
};

/// The new aneurysms that are joined to one another, with their vessels, for each that is joined to
/// none.
std::vector<Sac> findSacs(const TrackedTree& tree) {
  const std::vector<TrackedBranch>& all = tree.branches;
  const auto isVessel = [&](int i) { return i >= 0 && tree.isVessel(static_cast<std::size_t>(i)); };
  const auto isAneurysm = [&](int i) {
    return i >= static_cast<int>(tree.known) && !isVessel(i) &&
           !all[static_cast<std::size_t>(i)].nodes.empty();
  };
  const auto findHead = [&](int i) {
    while (isAneurysm(all[static_cast<std::size_t>(i)].parentBranch))
      i = all[static_cast<std::size_t>(i)].parentBranch;
    return static_cast<std::size_t>(i);
  };
  std::vector<Sac> sacAtHead(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int self = static_cast<int>(i), parent = all[i].parentBranch;
    if (isAneurysm(self)) {
      sacAtHead[findHead(self)].parts.push_back(i);
      if (isVessel(parent)) sacAtHead[i].vessels.push_back(static_cast<std::size_t>(parent));
    } else if (isAneurysm(parent)) {
      sacAtHead[findHead(parent)].vessels.push_back(i);
    }
  }
  std::erase_if(sacAtHead, [](const Sac& sac) { return sac.parts.empty(); });
  return sacAtHead;
}

/// True if the lumen ends all around a node, but for a third.
bool isTube(const TrackContext& context, double wallLevel, const TrackedNode& node) {
  const double sign = context.options.dark ? -1 : 1;
  const VolumeGeometry& geometry = context.volume.geometry();
  const auto [u, v] = planeBasis(node.direction);
  int open = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const Vector3d outward = node.radius * (std::cos(angle) * u + std::sin(angle) * v);
    open += std::all_of(std::begin(kAroundTubeRadii), std::end(kAroundTubeRadii), [&](double r) {
      const Vector3d at = geometry.indexFromWorld(node.centre + r * outward);
      return sign * (static_cast<double>(context.volume.sample(at)) - wallLevel) > 0;
    });
  }
  return open <= kOpenShare * kDirections;
}

/// The pieces of vessels near a sac that bound it. Vessels that open into it bound it only where
/// they are measured tubes; their nodes near the sac are added to `mouth`.
std::vector<VesselPiece> findBounds(const TrackContext& context, double wallLevel, const Sac& sac,
                                    std::span<const SacBall> balls, std::vector<TrackedBranch>& all,
                                    std::vector<TrackedNode*>& mouth) {
  std::vector<VesselPiece> pieces;
  const auto isFar = [&](const TrackedNode& node) {
    return std::none_of(balls.begin(), balls.end(), [&](const SacBall& ball) {
      return (node.centre - ball.centre).norm() <
             kSacReach * ball.radius + node.radius + node.height;
    });
  };
  const auto isIn = [](const std::vector<std::size_t>& list, std::size_t i) {
    return std::find(list.begin(), list.end(), i) != list.end();
  };
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (isIn(sac.parts, b)) continue;
    const bool mayOpen = isIn(sac.vessels, b);
    std::vector<TrackedNode>& nodes = all[b].nodes;
    const TrackedNode* last = nullptr;
    for (TrackedNode& node : nodes) {
      if (isFar(node)) {
        last = nullptr;
        continue;
      }
      const bool bounds =
          !mayOpen || (node.origin == NodeOrigin::Measured && isTube(context, wallLevel, node));
      if (mayOpen) mouth.push_back(&node);
      if (bounds && last)
        pieces.push_back(
            {last->centre, node.centre - last->centre, last->radius, node.radius - last->radius});
      else if (bounds)
        pieces.push_back({node.centre, Vector3d::Zero(), node.radius, 0});
      last = bounds ? &node : nullptr;
    }
  }
  return pieces;
}

/// Wall points of a region whose strength is at least the required one, evenly spread.
std::vector<Vector3d> chooseWallPoints(const TrackContext& context, const SacRegion& region) {
  const SacWall wall = measureSacWall(context, region);
  std::vector<Vector3d> strong;
  if (wall.points.empty()) return strong;
  const double strongest = *std::max_element(wall.strength.begin(), wall.strength.end());
  for (std::size_t i = 0; i < wall.points.size(); ++i)
    if (wall.strength[i] >= context.options.aneurysmGradient * strongest)
      strong.push_back(wall.points[i]);
  const double voxel = context.volume.geometry().voxelSize();
  const double even = std::sqrt(static_cast<double>(strong.size()) / kMostPoints);
  return thinnedOut(strong, std::max(1.0, even) * voxel);
}

/// Drops points that are deeper in a region's lumen than any wall.
void dropWithin(const VolumeGeometry& geometry, const SacRegion& region, TrackedNode& node) {
  std::erase_if(node.points, [&](const formats::Vec3f& p) {
    const auto depth = region.depthAt(geometry.indexFromWorld(toEigen(p)));
    return depth && *depth > kWithinVoxels * geometry.voxelSize();
  });
}

/// Adds each point to the node of least power.
void shareOut(const std::vector<Vector3d>& points, std::span<TrackedNode* const> owners) {
  for (const Vector3d& p : points) {
    const auto power = [&](const TrackedNode* node) {
      return (p - node->centre).squaredNorm() - node->radius * node->radius;
    };
    TrackedNode* best = owners[0];
    for (TrackedNode* node : owners)
      if (power(node) < power(best)) best = node;
    best->points.push_back(toVec3f(p));
  }
}

/// Inserts a node into one of a sac's chains, behind its first node, where the chain gets longer by
/// the least and stays in the lumen; nowhere if no chain can be left and reached again.
void insertNode(const TrackContext& context, const SacRegion& region, TrackedNode node,
                const Sac& sac, std::vector<TrackedBranch>& all) {
  std::vector<TrackedNode>* chain = nullptr;
  std::size_t at = 0;
  double least = std::numeric_limits<double>::infinity();
  const VolumeGeometry& geometry = context.volume.geometry();
  const auto isInside = [&](const TrackedNode& other) {
    return isStraightPathInside(geometry, region, node.centre, other.centre);
  };
  for (const std::size_t part : sac.parts) {
    std::vector<TrackedNode>& nodes = all[part].nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const bool isLast = i + 1 == nodes.size();
      double longer = (node.centre - nodes[i].centre).norm();
      if (!isLast)
        longer += (nodes[i + 1].centre - node.centre).norm() -
                  (nodes[i + 1].centre - nodes[i].centre).norm();
      if (longer >= least || !isInside(nodes[i]) || (!isLast && !isInside(nodes[i + 1]))) continue;
      least = longer;
      chain = &nodes;
      at = i + 1;
    }
  }
  if (chain) chain->insert(chain->begin() + static_cast<std::ptrdiff_t>(at), std::move(node));
}

/// Gives a sac nodes for lobes that no click is near to.
void addCentres(const TrackContext& context, const SacRegion& region,
                const std::vector<Vector3d>& wall, std::span<const SacBall> nodes, double least,
                const Sac& sac, std::vector<TrackedBranch>& all) {
  TrackRun run(context, Random(context.options.seed));
  for (const SacBall& ball : furtherCentres(context, region, wall, nodes, least)) {
    auto node = sacNodeAt(run, {ball.centre, ball.radius});
    if (!node) continue;
    node->radius = ball.radius;
    insertNode(context, region, std::move(*node), sac, all);
  }
  for (const std::size_t i : sac.parts)
    if (all[i].nodes.size() > 1) alignWithChain(all[i].nodes);
}

void capture(const TrackContext& context, const Sac& sac, std::vector<TrackedBranch>& all) {
  std::vector<TrackedNode> clicked;
  std::vector<SacBall> balls;
  for (const std::size_t i : sac.parts)
    for (const TrackedNode& node : all[i].nodes) {
      clicked.push_back(node);
      balls.push_back({node.centre, node.radius});
    }
  const double wallLevel = measureLevels(context.volume, clicked).wall;
  std::vector<TrackedNode*> owners;
  const std::vector<VesselPiece> pieces = findBounds(context, wallLevel, sac, balls, all, owners);
  const auto region = growSac(context, wallLevel, balls, [&](const Vector3d& p) {
    return std::any_of(pieces.begin(), pieces.end(),
                       [&](const VesselPiece& x) { return x.holds(p); });
  });
  if (!region) return;
  const std::vector<Vector3d> points = chooseWallPoints(context, *region);
  if (points.empty()) return;
  const double least = leastPassage(balls);
  for (const TrackedNode* node : owners) balls.push_back({node->centre, node->radius});
  addCentres(context, *region, points, balls, least, sac, all);
  for (const std::size_t i : sac.parts)
    for (TrackedNode& node : all[i].nodes) {
      node.points.clear();
      owners.push_back(&node);
    }
  for (const std::size_t i : sac.vessels)
    for (TrackedNode& node : all[i].nodes) dropWithin(context.volume.geometry(), *region, node);
  shareOut(points, owners);
}

}  // namespace

void captureSacs(const TrackContext& context, TrackedTree& tree) {
  for (const Sac& sac : findSacs(tree)) capture(context, sac, tree.branches);
}

}  // namespace lumen::convert
