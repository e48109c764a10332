// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/tracking_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_text.h"
#include "converters/base/warning.h"
#include "converters/stages/tracking/cylinders/tracked_tree.h"
#include "converters/voxels/grid_geometry.h"
#include "converters/voxels/image_region.h"

namespace lumen::convert {
namespace {

/// The variance of a box is the square of its edge over this.
constexpr double kEdgesToVariance = 12.0;

/// The largest ratio of two edges of a voxel: beyond it, rays of a vessel's size cross nothing
/// along the one axis and thousands of voxels along the other.
constexpr double kLargestEdgeRatio = 1000.0;

void checkVoxels(const Eigen::Vector3d& spacing, const FieldWord& word) {
  const double uneven = spacing.maxCoeff() / spacing.minCoeff();
  if (uneven <= kLargestEdgeRatio) return;
  throw invalidInput("the volume's voxels are " + spacingText(spacing) + " mm, one edge " +
                     shownNumber(uneven, 3) + " times another; expected at most " +
                     shownNumber(kLargestEdgeRatio) + " times: if the spacing is wrong, " +
                     word("spacing") + " states it, else resample");
}

/// Vessels have the other sign than stated if their contrast is this many times as large with it.
constexpr double kOtherSignContrasts = 4.0;

/// Throws where a volume and options cannot serve, and warns of clicks on the other sign.
void checkAndWarn(const Volume& volume, const std::vector<SeedBranch>& seeds,
                  const TrackOptions& options, Progress& progress) {
  options.check(volume.geometry.spacing.minCoeff());
  checkVoxels(volume.geometry.spacing, options.word);
  const Eigen::Vector3d& spacing = volume.geometry.spacing;
  const double most = BsplineVolume::kMostSmoothing * spacing.minCoeff();
  const BsplineVolume spline(
      volume, Eigen::Vector3d::Constant(std::min(volume.geometry.voxelSize(), most)));
  TrackOptions other = options;
  other.dark = !options.dark;
  const double contrast = contrastAtClicks(spline, seeds, options, progress);
  if (contrastAtClicks(spline, seeds, other, progress) <= kOtherSignContrasts * contrast) return;
  warn(progress,
       {WarningCode::SeedsContrast,
        options.dark
            ? "most seeds lie where it is brighter than around them, but " + options.word("dark") +
                  " tracks dark vessels: leave it out if vessels are bright"
            : "most seeds lie where it is darker than around them: if vessels are dark, add " +
                  options.word("dark")});
}

TrackOptions optionsFor(const formats::Case& tracked) {
  if (auto options = recordedTrackOptions(tracked)) return *std::move(options);
  throw invalidInput(
      "the case has no \"track\" step; expected one whose vessels were tracked in this volume");
}

/// The middle of every vessel, as clicks.
std::vector<SeedBranch> middlesAsClicks(const formats::Case& tracked) {
  std::vector<SeedBranch> clicks;
  for (const formats::Branch& branch : tracked.tree.branches) {
    if (branch.kind != formats::BranchKind::Vessel) continue;
    SeedBranch click;
    const auto& c = tracked.tree.centre[branch.firstNode + branch.nodeCount / 2];
    click.points.push_back({{c.x, c.y, c.z}, std::nullopt});
    clicks.push_back(std::move(click));
  }
  return clicks;
}

/// The first two different values, in the order of the voxels, and whether there is a third.
struct Values {
  double first = 0;
  std::optional<double> second;
  bool hasMore = false;
};

template <class T>
Values valuesOf(const std::vector<T>& voxels) {
  Values out;
  if (voxels.empty()) return out;
  const T first = voxels.front();
  out.first = static_cast<double>(first);
  const auto isOther = [&](T v) { return v != first; };
  const auto other = std::find_if(voxels.begin(), voxels.end(), isOther);
  if (other == voxels.end()) return out;
  const T second = *other;
  out.second = static_cast<double>(second);
  out.hasMore = std::any_of(other, voxels.end(), [&](T v) { return v != first && v != second; });
  return out;
}

}  // namespace

std::optional<TrackOptions> recordedTrackOptions(const formats::Case& vesselCase) {
  const formats::Step* step = lastStep(vesselCase.metadata, "track");
  if (!step) return std::nullopt;
  TrackOptions o;
  OptionTable table;
  o.addRows(table);
  table.takeRecorded(*step);
  return o;
}

WallShape measureWallShape(const TrackingVolume& volume, const TrackedTree& tree) {
  std::vector<const TrackedBranch*> vessels;
  for (std::size_t i = 0; i < tree.seeds.size(); ++i)
    if (tree.isVessel(i)) vessels.push_back(&tree.branches[i]);
  const VolumeGeometry& geometry = volume.geometry();
  const double edge =
      volume.options().evenBlur ? geometry.spacing.maxCoeff() : geometry.voxelSize();
  const double smoothing = volume.options().smoothing.value_or(0);
  const double least = std::sqrt(smoothing * smoothing + edge * edge / kEdgesToVariance);
  return measureWalls(volume.spline(), vessels, volume.options().dark)
      .value_or(WallShape{least, 0});
}

std::optional<std::string> doubtAbout(const Volume& volume) {
  const Values values =
      std::visit([](const auto& voxels) { return valuesOf(voxels); }, volume.voxels);
  if (!values.second)
    throw invalidInput("every voxel is " + shownNumber(values.first) +
                       ", so there is nothing to track; expected an angiogram");
  if (values.hasMore) return std::nullopt;
  const auto [low, high] = std::minmax(values.first, *values.second);
  return "its voxels are " + shownNumber(low) + " or " + shownNumber(high) +
         " only, as in a mask; expected the intensities of an angiogram: walls will be as coarse "
         "as the voxels, so give the image that the mask was made from, if there is one";
}

TrackingVolume::TrackingVolume(const Volume& volume, const formats::Case& tracked,
                               Progress& progress, const FieldWord& word)
    : m_options(optionsFor(tracked)) {
  m_options.word = word;
  m_options.check(volume.geometry.spacing.minCoeff());
  checkVoxels(volume.geometry.spacing, word);
  const Volume& image = imageOf(volume, progress);
  m_smoothed = smoothForNoise(image, image.geometry, middlesAsClicks(tracked), m_options, progress);
  m_options.smoothing = m_smoothed.smoothing;
  m_wallShape = measureWallShape(*this, makeTrackedTree(tracked));
  if (!m_options.pointSpread) return;
  m_wallShape->pointSpread = *m_options.pointSpread;
  if (*m_options.pointSpread == 0) m_wallShape->halfLevel = 0;
}

TrackingVolume::TrackingVolume(const Volume& volume, const std::vector<SeedBranch>& clicks,
                               const TrackOptions& options, Progress& progress)
    : m_options(options) {
  const Volume& image = imageOf(volume, progress);
  checkAndWarn(image, clicks, options, progress);
  prepare(image, image.geometry, clicks, progress);
}

TrackingVolume::TrackingVolume(const Volume& volume, const GridFrame& frame,
                               const std::vector<SeedBranch>& clicks, const TrackOptions& options,
                               Progress& progress)
    : m_options(options) {
  const Volume& image = imageOf(volume, progress);
  checkAndWarn(image, clicks, options, progress);
  prepare(image, gridGeometry(image.geometry), frame.toGrid(clicks), progress);
}

const Volume& TrackingVolume::imageOf(const Volume& volume, Progress& progress) {
  m_continued = continueImage(volume, progress);
  return m_continued ? *m_continued : volume;
}

void TrackingVolume::prepare(const Volume& volume, const VolumeGeometry& geometry,
                             const std::vector<SeedBranch>& clicks, const Progress& progress) {
  m_smoothed = smoothForNoise(volume, geometry, clicks, m_options, progress);
  m_options.smoothing = m_smoothed.smoothing;
  if (m_options.pointSpread) m_wallShape = WallShape{*m_options.pointSpread, 0};
}

}  // namespace lumen::convert
