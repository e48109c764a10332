// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/vessel_at_click.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "converters/base/random.h"
#include "converters/base/statistics.h"
#include "converters/stages/tracking/branch_start.h"
#include "converters/stages/tracking/cylinders/smoothing.h"

namespace lumen::convert {

namespace {

/// Places for comparison, and the share of them that may stand out: vessels fill less of a volume.
constexpr std::size_t kLightPlaces = 200;
constexpr double kOutstanding = 0.1;
/// Multiple of the contrast of those places: noise alone reaches it, and stays below twice of it.
constexpr double kClear = 2;
/// Stream of the random numbers; those of the branches count up from 0.
constexpr std::uint64_t kLightStream = ~std::uint64_t{1};

Eigen::Vector3d smoothingOf(const VolumeGeometry& geometry) {
  const double most = BsplineVolume::kMostSmoothing * geometry.spacing.minCoeff();
  return Eigen::Vector3d::Constant(std::min(geometry.voxelSize(), most));
}

}  // namespace

ClickLight::ClickLight(const Volume& volume, const TrackOptions& options, const Progress& progress)
    : m_spline(volume, smoothingOf(volume.geometry)), m_options(options), m_progress(progress) {
  Random random(options.seed, kLightStream);
  const Eigen::Vector3d last = volume.geometry.cells().high().cast<double>();
  std::vector<double> contrasts;
  for (std::size_t i = 0; i < kLightPlaces; ++i) {
    Eigen::Vector3d index;
    for (int a = 0; a < 3; ++a) index[a] = random.uniform() * last[a];
    SeedBranch place;
    place.points.push_back({volume.geometry.worldFromIndex(index), {}});
    contrasts.push_back(contrastAt(place));
  }
  m_usual = lowerQuantile(contrasts, 1 - kOutstanding);
}

double ClickLight::contrastAt(const SeedBranch& seed) const {
  return contrastAtClicks(m_spline, {seed}, m_options, m_progress);
}

std::size_t ClickLight::countInVessels(const std::vector<SeedBranch>& seeds) const {
  return static_cast<std::size_t>(
      std::count_if(seeds.begin(), seeds.end(),
                    [&](const SeedBranch& seed) { return contrastAt(seed) > kClear * m_usual; }));
}

namespace {

using Eigen::Vector3d;

/// Largest distance of the wall from a click that is on the vessel, in voxels. The brightest place
/// within it is tried, too: people click on the rims of thin vessels.
constexpr double kAsideVoxels = 2;
/// Trial radii, as tracks begin with. Wide ones, whose rays are long, are tried where no narrow one
/// is sure.
constexpr double kNarrowVoxels[] = {1.25, 1.875, 2.8125, 4.21875, 6.328125};
constexpr double kWideVoxels[] = {9.4921875, 14.23828125, 21.357421875};
/// An accepted cylinder whose wall is seen by this share of the rays is no part of a wider vessel's.
constexpr double kOwnWallShare = 0.25;

/// The search for the vessel under one click.
class Search {
public:
  Search(const TrackContext& context, const Vector3d& click)
      : m_context(context),
        m_click(click),
        m_voxel(context.volume.geometry().voxelSize()),
        m_run(context, Random(context.options.seed)) {}

  /// Looks for cylinders from a place whose lumen the click is in, or nearly.
  void from(const Vector3d& place, std::span<const double> radii) {
    for (const double voxels : radii) {
      if (m_isSure) return;
      BranchStart start = startAtClick(m_run, {place, voxels * m_voxel}, Vector3d::UnitZ(), false);
      if (start.nodes.empty()) {
        if (isNearer(start.best, m_failure)) m_failure = std::move(start.best);
        continue;
      }
      TrackedNode& node = start.nodes[0];
      if (!holdsClick(node) || (m_best && node.inlierRate <= m_best->inlierRate)) continue;
      m_best = std::move(node);
      m_isSure = m_best->inlierRate >= m_context.options.inlierRate && seen() > kSeenWallShare;
    }
  }
  /// The share of the rays that see the wall of the best cylinder so far.
  [[nodiscard]] double seen() const {
    return m_best ? static_cast<double>(m_best->points.size()) /
                        static_cast<double>(m_context.rays.size())
                  : 0;
  }
  /// The best cylinder so far.
  [[nodiscard]] const std::optional<TrackedNode>& found() const { return m_best; }

  /// The brightest place around the click.
  [[nodiscard]] Vector3d brightest() const {
    const VolumeGeometry& geometry = m_context.volume.geometry();
    Vector3d best = m_click;
    std::optional<double> highest;
    for (double x = -kAsideVoxels; x <= kAsideVoxels; ++x)
      for (double y = -kAsideVoxels; y <= kAsideVoxels; ++y)
        for (double z = -kAsideVoxels; z <= kAsideVoxels; ++z) {
          const Vector3d place = m_click + m_voxel * Vector3d(x, y, z);
          const Vector3d index = geometry.indexFromWorld(place);
          if (Vector3d(x, y, z).norm() > kAsideVoxels || !geometry.containsIndex(index)) continue;
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
    return (onAxis(node) - m_click).norm() <= node.radius + kAsideVoxels * m_voxel;
  }

  const TrackContext& m_context;
  Vector3d m_click;
  double m_voxel;
  TrackRun m_run;
  std::optional<TrackedNode> m_best;
  bool m_isSure = false;
  NodeFit m_failure;
};

}  // namespace

VesselAtClick vesselAtClick(const TrackingVolume& volume, const Vector3d& click) {
  const Progress silent;
  const TrackContext context(volume.spline(), volume.options(), volume.noiseFloor(), silent);
  Search search(context, click);
  VesselAtClick vessel;
  vessel.position = click;
  search.from(click, kNarrowVoxels);
  if (!search.found()) search.from(search.brightest(), kNarrowVoxels);
  if (search.seen() < kOwnWallShare) search.from(click, kWideVoxels);
  if (!search.found()) {
    vessel.reason = search.failure();
    return vessel;
  }
  const TrackedNode& node = *search.found();
  vessel.found = true;
  vessel.position = search.onAxis(node);
  vessel.direction = node.direction;
  TrackedBranch branch;
  branch.nodes.push_back(node);
  if (volume.wallShape()) correctWalls(branch, formats::BranchKind::Vessel, *volume.wallShape());
  vessel.radius = branch.nodes[0].radius;
  return vessel;
}

}  // namespace lumen::convert
