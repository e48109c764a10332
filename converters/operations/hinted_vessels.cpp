// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/hinted_vessels.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/random.h"
#include "converters/base/relayed_progress.h"
#include "converters/base/vectors.h"
#include "converters/base/warning.h"
#include "converters/geometry/automatic_names.h"
#include "converters/geometry/far_origin.h"
#include "converters/io/seeds/case_seeds.h"
#include "converters/operations/dark_seeds.h"
#include "converters/operations/label_maps.h"
#include "converters/stages/editing/hint_parents.h"
#include "converters/stages/editing/hints.h"
#include "converters/stages/editing/inlets.h"
#include "converters/stages/editing/selection.h"
#include "converters/stages/finding/background.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "converters/voxels/image_region.h"
#include "formats/container/printable.h"

namespace lumen::operations {
namespace {

using convert::SeedFailure;

/// Noise that a repeated run adds to the voxels, in deviations of their own: a second scan differs by
/// far more. Vessels that are found without a click depend on no random number, so other random
/// numbers alone would give equal vessels.
constexpr double kNoiseShare = 0.1;
constexpr std::uint64_t kNoiseStream = 1;  // of random numbers; that of moved clicks is 0

constexpr const char* kRepeatExtension = "LUMEN_repeat";
constexpr const char* kRepeatArray = "LUMEN_repeat.share";

void append(std::vector<SeedFailure>&& from, std::vector<SeedFailure>& to) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

void requireInVessels(const formats::Case& value, const std::string& name,
                      const VesselOptions& options, const Context& context) {
  for (std::size_t i = 0; i < options.roots.size(); ++i) {
    if (convert::placeIn(value.tree, options.roots[i])) continue;
    const std::string near = nearestText(value.tree, options.roots[i]);
    throw failed(formats::printable(name) + ": " + context.field("root", i) +
                 " lies in no vessel that is found" + (near.empty() ? "" : ": " + near) +
                 "; nothing is written");
  }
}

/// Roots that lie in a vessel, but at whose end blood does not come in.
void warnOfRoots(const std::vector<convert::UnusedPlace>& unused, const std::string& name,
                 const Context& context) {
  for (const convert::UnusedPlace& place : unused)
    warn(context.progress,
         {WarningCode::RootUnused, formats::printable(name) + ": no tree begins at " +
                                       context.field("root", place.index) + ": " +
                                       convert::reasonFor(place.why)});
}

/// Names of the branches in which the roots lie.
std::set<std::string> rootLabels(const formats::Case& value, const VesselOptions& options) {
  std::set<std::string> labels;
  for (const Eigen::Vector3d& place : options.roots)
    if (const auto at = convert::placeIn(value.tree, place))
      labels.insert(value.tree.branches[at->branch].label);
  return labels;
}

/// Leaves out what the user does not want. `named`: branches of seeds.
void select(formats::Case& value, std::set<std::string> named, const VesselOptions& options) {
  if (!options.isOnlyConnected || (options.seeds.empty() && options.roots.empty())) return;
  named.merge(rootLabels(value, options));
  convert::leaveOutBranches(value, convert::unconnectedWith(value.tree, named));
}

std::set<std::string> labelsOf(const std::vector<convert::SeedBranch>& seeds) {
  std::set<std::string> labels;
  for (const convert::SeedBranch& seed : seeds) labels.insert(seed.label);
  return labels;
}

/// Roots and selection for a case of which `named` are the vessels to keep.
void apply(formats::Case& target, const std::string& name, std::set<std::string> named,
           const VesselOptions& options, const Context& context) {
  requireInVessels(target, name, options, context);
  warnOfRoots(convert::beginAt(target, options.roots), name, context);
  select(target, std::move(named), options);
}

/// Notes a vessel that was tracked from a seed, but leaves it out.
void noteStart(const convert::SeedBranch& seed, convert::TrackResult& result) {
  const auto own = convert::branchNamed(result.result.tree, seed.label);
  const Eigen::Vector3d& click = seed.points.front().position;
  if (!own || convert::placeIn(result.result.tree, *own, click)) return;
  result.missedPoints.push_back({seed.label, "point 1; " + nearestText(result.result.tree, click)});
}

void warnOfHints(const convert::HintRemarks& hints, const std::string& name,
                 const VesselOptions& options, const Context& context) {
  const std::string file = formats::printable(options.seedsName);
  warnOfSeeds(file, {WarningCode::SeedUnused, " names no vessel of its own: "}, hints.unused,
              context);
  warnOfSeeds(file, {WarningCode::SeedShared, " shares a vessel: "}, hints.halved, context);
  warnOfSeeds(file, {WarningCode::SeedInlet, " is no inlet: "}, hints.unrooted, context);
  warnOfRoots(hints.unusedRoots, name, context);
}

/// Tracks the hints that lie in no vessel into the result, but for those at which the volume shows
/// nothing.
void addUnusedHints(const convert::Volume& volume, std::vector<convert::SeedBranch> unused,
                    const VesselOptions& options, convert::TrackResult& result,
                    const Context& context) {
  LitSeeds seeds = withoutDark(volume, std::move(unused), options.track.dark, context);
  append(std::move(seeds.dark), result.failures);
  const std::vector<convert::SeedBranch>& rest = seeds.lit;
  if (rest.empty()) return;
  const convert::TrackingVolume tracking(volume, result.result, context.progress,
                                         context.fieldWord);
  convert::AddedTracks added =
      convert::addTracksFromSeeds(tracking, result.result, rest, context.progress,
                                  placesOfPrior(options.prior, volume.geometry));
  result.result = std::move(added.result);
  append(std::move(added.failures), result.failures);
  append(std::move(added.missedPoints), result.missedPoints);
  append(std::move(added.unjoined), result.unjoined);
  std::move(added.ends.begin(), added.ends.end(), std::back_inserter(result.ends));
  for (const convert::SeedBranch& seed : rest) noteStart(seed, result);
}

convert::TrackResult findAndApplyHints(const convert::Volume& volume, const std::string& name,
                                       const VesselOptions& options, const Context& context) {
  convert::PlacedSeeds placed = placedSeeds(volume, options, context);
  std::string whyNone;
  convert::TrackResult result = findAndTrackIfAny(volume, options, whyNone, context);
  if (result.result.tree.nodeCount() == 0) {
    result = trackPlaced(volume, placed, options, context);
    reportOnSeeds(volume, options, placed, result, context);
    apply(result.result, name, labelsOf(options.seeds), options, context);
    convert::setSeeds(result.result, convert::markTracked(placed.seeds, result.failures));
    return result;
  }
  requireInVessels(result.result, name, options, context);
  convert::HintRemarks hints = convert::applyHints(result.result, placed.seeds, options.roots);
  convert::nameAutomatically(result.result.tree, 0, labelsOf(placed.seeds));
  append(std::move(hints.missedPoints), result.missedPoints);
  append(std::move(hints.unjoined), result.unjoined);
  addUnusedHints(volume, std::move(hints.rest), options, result, context);
  warnOfHints(hints, name, options, context);
  append(convert::unkeptParents(result.result.tree, placed.seeds, hints.holders, result.unjoined),
         result.unjoined);
  reportOnSeeds(volume, options, placed, result, context);
  select(result.result, labelsOf(placed.seeds), options);
  renameEnds(result.result.tree, result.ends);
  convert::setSeeds(result.result, convert::markTracked(placed.seeds, result.failures));
  return result;
}

}  // namespace

convert::TrackResult trackVessels(const convert::Volume& volume, const std::string& name,
                                  const VesselOptions& options, const Context& context) {
  const bool isSeeded = !options.seeds.empty();
  if (isSeeded && !options.isSeedsOnly) return findAndApplyHints(volume, name, options, context);
  convert::TrackResult result = isSeeded ? placeAndTrack(volume, options, context)
                                         : findAndTrack(volume, name, options, context);
  apply(result.result, name, labelsOf(options.seeds), options, context);
  renameEnds(result.result.tree, result.ends);
  return result;
}

namespace {

/// Seeds whose points are moved by a tenth of a voxel in a random direction.
std::vector<convert::SeedBranch> moved(std::vector<convert::SeedBranch> seeds, double voxel,
                                       Random random) {
  constexpr double kMovedVoxels = 0.1;
  for (convert::SeedBranch& seed : seeds)
    for (convert::SeedPoint& point : seed.points) {
      const Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
      // coordinates that the volume places are in voxels
      const double unit = seed.frame.system == convert::SeedSystem::Voxel ? 1 : voxel;
      point.position += kMovedVoxels * unit * direction.normalized();
    }
  return seeds;
}

/// A volume with normal noise of a deviation, voxel units, added to its voxels.
convert::Volume withNoise(const convert::Volume& volume, double deviation, Random random) {
  std::vector<float> voxels;
  std::visit(
      [&](const auto& from) {
        voxels.reserve(from.size());
        for (const auto value : from)
          voxels.push_back(static_cast<float>(value + deviation * random.normal()));
      },
      volume.voxels);
  return {volume.geometry, std::move(voxels), volume.assumptions};
}

}  // namespace

std::optional<convert::Repetition> repeatTracks(const convert::Volume& volume,
                                                const std::string& name,
                                                const VesselOptions& options, std::uint64_t repeats,
                                                const CaseSelection& select, formats::Case& judged,
                                                const Context& context) {
  if (repeats == 0) return std::nullopt;
  std::vector<formats::Case> runs;
  Progress& progress = context.progress;
  progress.begin("repeating", repeats);
  QuietProgress quiet(progress);
  const float sign = options.track.dark ? -1.0F : 1.0F;
  const std::shared_ptr<const convert::Volume> continued = convert::continueImage(volume, progress);
  const convert::Volume& image = continued ? *continued : volume;
  const double noise = double{convert::Background(image, sign, progress).noise()};
  for (std::uint64_t run = 1; run <= repeats; ++run) {
    VesselOptions other = options;
    other.track.seed += run;
    other.seeds = moved(options.seeds, volume.geometry.voxelSize(), Random(other.track.seed));
    try {
      const convert::Volume noisy =
          withNoise(image, kNoiseShare * noise, Random(other.track.seed, kNoiseStream));
      runs.push_back(trackVessels(noisy, name, other, context.within(quiet)).result);
      if (select) select(runs.back(), context.within(quiet));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Failed) throw;
      runs.resize(run);  // it finds nothing
      runs.back() = {};
    }
    progress.advance();
  }
  progress.end();
  convert::Repetition out = convert::compareRuns(judged, runs);
  judged.metadata.extensionsUsed.emplace_back(kRepeatExtension);
  judged.nodeArrays.push_back({kRepeatArray, 1, "", out.nodes});
  return out;
}

void applyRoots(formats::Case& target, const std::string& name, const VesselOptions& options,
                const Context& context) {
  VesselOptions near = options;
  if (target.tree.nodeCount() > 0)
    convert::bringNear(toEigen(target.tree.centre.front()), near.roots);
  apply(target, name, {}, near, context);
}

}  // namespace lumen::operations
