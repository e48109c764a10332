// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/snap.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "converters/stages/tracking/branch_start.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Voxels: how far the wall may be from a click that is on the vessel, and around a click among which
/// the brightest place is tried, too: people click on the rims of thin vessels.
constexpr double kAside = 2;
/// Voxels: trial radii, as tracks begin with. Wide ones, whose rays are long, are tried where nothing
/// narrow is sure.
constexpr double kNarrow[] = {1.25, 1.875, 2.8125, 4.21875, 6.328125};
constexpr double kWide[] = {9.4921875, 14.23828125, 21.357421875};
/// Of the rays: a cylinder whose wall more of them see is sure, if it is accepted, too; and one whose wall
/// so many see is no part of a wider vessel's.
constexpr double kSeenWall = 0.5, kOwnWall = 0.25;
/// Of random numbers: those of the first seed.
constexpr std::uint64_t kStream = 0;

/// The search for the vessel under one click.
class Search {
public:
  Search(const TrackContext& context, const Vector3d& click)
      : m_context(context),
        m_click(click),
        m_voxel(context.volume.geometry().voxelSize()),
        m_random(context.options.seed, kStream),
        m_workspace(context) {}

  /// Looks for cylinders from a place whose lumen the click is in, or nearly.
  void from(const Vector3d& place, std::span<const double> radii) {
    for (const double voxels : radii) {
      if (m_isSure) return;
      BranchStart start = startAtClick(m_context, {place, voxels * m_voxel}, Vector3d::UnitZ(),
                                       false, m_random, m_workspace);
      if (start.nodes.empty()) {
        if (isNearer(start.best, m_failure)) m_failure = std::move(start.best);
        continue;
      }
      TrackedNode& node = start.nodes[0];
      if (!holdsClick(node) || (m_best && node.inlierRate <= m_best->inlierRate)) continue;
      m_best = std::move(node);
      m_isSure = m_best->inlierRate >= m_context.options.inlierRate && seen() > kSeenWall;
    }
  }
  /// Of the rays: those that see the wall of the best so far.
  [[nodiscard]] double seen() const {
    return m_best ? static_cast<double>(m_best->points.size()) /
                        static_cast<double>(m_context.rays.size())
                  : 0;
  }
  /// The best so far.
  [[nodiscard]] const std::optional<TrackedNode>& found() const { return m_best; }

  /// The brightest place around the click.
  [[nodiscard]] Vector3d brightest() const {
    const VolumeGeometry& geometry = m_context.volume.geometry();
    Vector3d best = m_click;
    std::optional<double> highest;
    for (double x = -kAside; x <= kAside; ++x)
      for (double y = -kAside; y <= kAside; ++y)
        for (double z = -kAside; z <= kAside; ++z) {
          const Vector3d place = m_click + m_voxel * Vector3d(x, y, z);
          const Vector3d index = geometry.indexFromWorld(place);
          if (Vector3d(x, y, z).norm() > kAside || !geometry.containsIndex(index)) continue;
          const double value =
              (m_context.options.dark ? -1.0 : 1.0) * double{m_context.volume.sample(index)};
          if (highest && value <= *highest) continue;
          highest = value;
          best = place;
        }
    return best;
  }

  /// The place on a node's axis, within its height, that is nearest to the click.
  [[nodiscard]] Vector3d onAxis(const TrackedNode& node) const {
    const double along = (m_click - node.centre).dot(node.direction), half = 0.5 * node.height;
    return node.centre + std::clamp(along, -half, half) * node.direction;
  }

  [[nodiscard]] std::string failure() const {
    return m_failure.stage == FitStage::OutsideVolume &&
                   m_context.volume.geometry().containsWorld(m_click)
               ? "what fits there is another vessel's"
               : failureText(m_context, m_failure);
  }

private:
  [[nodiscard]] bool holdsClick(const TrackedNode& node) const {
    return (onAxis(node) - m_click).norm() <= node.radius + kAside * m_voxel;
  }

  const TrackContext& m_context;
  Vector3d m_click;
  double m_voxel;
  Random m_random;
  TrackWorkspace m_workspace;
  std::optional<TrackedNode> m_best;
  bool m_isSure = false;
  NodeFit m_failure;
};

}  // namespace

Snap snapToVessel(const TrackingVolume& volume, const Vector3d& click) {
  const Progress silent;
  const TrackContext context(volume.spline(), volume.options(), volume.noiseFloor(), silent);
  Search search(context, click);
  Snap snap;
  snap.position = click;
  search.from(click, kNarrow);
  if (!search.found()) search.from(search.brightest(), kNarrow);
  if (search.seen() < kOwnWall) search.from(click, kWide);
  if (!search.found()) {
    snap.reason = search.failure();
    return snap;
  }
  const TrackedNode& node = *search.found();
  snap.found = true;
  snap.position = search.onAxis(node);
  snap.direction = node.direction;
  TrackedBranch branch;
  branch.nodes.push_back(node);
  if (volume.wallShape()) correctWalls(branch, formats::BranchKind::Vessel, *volume.wallShape());
  snap.radius = branch.nodes[0].radius;
  return snap;
}

}  // namespace lumen::convert
