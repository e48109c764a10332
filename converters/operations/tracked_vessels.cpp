// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/tracked_vessels.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/geometry/automatic_names.h"
#include "converters/io/seeds/case_seeds.h"
#include "converters/io/volume/write_volume.h"
#include "converters/operations/dark_seeds.h"
#include "converters/operations/label_prior.h"
#include "converters/operations/stated_vessels.h"
#include "converters/stages/editing/correct_topology.h"
#include "converters/stages/editing/further_inlets.h"
#include "converters/stages/editing/hint_parents.h"
#include "converters/stages/finding/find_vessels.h"
#include "converters/stages/tracking/vessel_at_click.h"
#include "formats/case/vessel_system.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

std::string share(std::size_t count, std::size_t seeds) {
  if (seeds == 1) return "it lies";
  return std::to_string(count) + " of " + std::to_string(seeds) + " lie";
}

/// Reason why seeds may start no track, after a semicolon: they stand out of the volume in another
/// reading of their file, or hardly at all.
std::string doubtAboutSeeds(const convert::Volume& volume,
                            const std::vector<convert::SeedBranch>& seeds,
                            const std::vector<convert::SeedBranch>& placed,
                            const convert::TrackOptions& options, const Context& context) {
  const convert::ClickLight light(volume, options, context.progress);
  const std::size_t inVessels = light.countInVessels(placed);
  std::size_t most = inVessels;
  std::string advice;
  for (const convert::RereadSeeds& other :
       convert::otherReadings(seeds, volume.geometry, context.fieldWord)) {
    const std::size_t count = light.countInVessels(other.seeds);
    if (count <= most || 3 * count < 2 * seeds.size()) continue;
    most = count;
    advice = "; read " + other.words + ", " + share(count, seeds.size()) + " in " +
             (options.dark ? "dark" : "bright") + " vessels: add " + other.options;
  }
  if (!advice.empty() || 2 * inVessels >= placed.size()) return advice;
  return "; " + share(placed.size() - inVessels, placed.size()) +
         " in the background, as seeds of another volume do";
}

/// Candidates without a wall are no failures of the user's: they are listed for --verbose alone.
void reportRefused(convert::TrackRemarks& remarks, Progress& progress) {
  for (const convert::SeedFailure& failure : remarks.failures)
    progress.detail(failure.label + " is no vessel: " + failure.reason);
  remarks.failures.clear();
}

/// Seeds that the prior kept from starting get that as the reason.
void explainByPrior(const std::vector<convert::SeedBranch>& seeds,
                    const convert::PlaceTest& isNoVessel, convert::TrackRemarks& remarks) {
  if (!isNoVessel) return;
  for (convert::SeedFailure& failure : remarks.failures)
    for (const convert::SeedBranch& seed : seeds)
      if (seed.label == failure.label && isNoVessel(seed.points.front().position))
        failure.reason = "a label map states that it lies in no vessel";
}

/// The places of bone; empty where none was found, so that edges are not examined for it. `found`
/// must outlive it.
convert::PlaceTest placesOfBone(const convert::FoundVessels& found) {
  if (found.bone.empty()) return {};
  convert::PlaceTest places{[&found](const Eigen::Vector3d& point) { return found.isBone(point); },
                            found.isBoneKnown};
  if (found.rim)
    places.isRim = [&found](const Eigen::Vector3d& point) { return found.rim->isOn(point); };
  return places;
}

}  // namespace

void warnOfSeeds(const std::string& file, const SeedOutcome& outcome,
                 const std::vector<convert::SeedFailure>& failures, const Context& context) {
  constexpr std::size_t kMostSeedLines = 20;
  for (std::size_t i = 0; i < std::min(failures.size(), kMostSeedLines); ++i)
    warn(context.progress,
         {outcome.code, file + ": seed \"" + formats::printable(failures[i].label) + "\"" +
                            outcome.words + failures[i].reason});
  if (failures.size() > kMostSeedLines)
    warn(context.progress, {outcome.code, file + ": and so on for " +
                                              std::to_string(failures.size() - kMostSeedLines) +
                                              " more seeds; " + context.allRemarks + " lists all"});
}

convert::TrackResult findAndTrack(const convert::Volume& volume, const std::string& name,
                                  const VesselOptions& options, const Context& context) {
  std::string whyNone;
  convert::TrackResult result = findAndTrackIfAny(volume, options, whyNone, context);
  if (result.result.tree.nodeCount() == 0)
    throw failed(formats::printable(name) + ": " + kNoVesselsFound + ", as " + whyNone + "; " +
                 context.field("seeds") + " states where vessels begin, and " +
                 context.field("dark") + " that they are darker than their background");
  return result;
}

convert::TrackResult findAndTrackIfAny(const convert::Volume& volume, const VesselOptions& options,
                                       std::string& whyNone, const Context& context) {
  Progress& progress = context.progress;
  const convert::FoundVessels found =
      convert::findVessels(volume, options.track.dark, options.prior, progress);
  whyNone = found.isBoneKnown ? "it is computed tomography in which no blood has contrast"
                              : "nothing long and thin stands out of its noise";
  if (found.courses.empty()) return {};
  whyNone =
      "no cylinder fits along any of " + counted(found.courses.size(), "candidate", "candidates");
  convert::TrackResult result = convert::trackAlongCourses(
      found.tracked(volume), found.courses, placesOfBone(found), options.track, progress,
      [&](std::span<const convert::WorldBall> vessels) {
        return convert::coursesInRemainingLumen(found, vessels, progress);
      });
  if (&found.tracked(volume) != &volume)
    result.result.metadata.source = convert::describeSource(volume);
  reportRefused(result, progress);
  if (result.result.tree.nodeCount() == 0) return result;
  const convert::LumenInVolume lumen{
      [&](const Eigen::Vector3d& point) { return found.isLumen(point); },
      [&](const Eigen::Vector3d& point) { return found.geometry.containsWorld(point); }};
  setSystemsOf(found, result.result);
  addStatedVessels(options.stated, found, result.result);
  for (const Eigen::Vector3d& place : convert::correctTopology(result.result, lumen))
    progress.detail("one vessel goes on at " + convert::vectorText(place) + " mm");
  // names of the maps' labels state the systems of the case
  formats::setNodeSystems(result.result, {});
  convert::reportInlets(convert::beginAtFurtherInlets(result.result, lumen.isInside), progress);
  convert::nameAutomatically(result.result.tree);
  return result;
}

convert::AddedTracks findAndAdd(const convert::TrackingVolume& tracking,
                                const convert::Volume& volume, const formats::Case& known,
                                const VesselOptions& options, const Context& context) {
  Progress& progress = context.progress;
  const convert::FoundVessels found =
      convert::findVessels(volume, tracking.options().dark, options.prior, progress);
  convert::AddedTracks added =
      convert::addTracksAlongCourses(tracking, known, found.courses, placesOfBone(found), progress);
  reportRefused(added, progress);
  addStatedVessels(options.stated, found, added.result);
  convert::nameAutomatically(added.result.tree, added.firstNewBranch);
  return added;
}

convert::PlacedSeeds placedSeeds(const convert::Volume& volume, const VesselOptions& options,
                                 const Context& context) {
  const std::string file = formats::printable(options.seedsName);
  convert::PlacedSeeds placed =
      convert::placeSeeds(options.seeds, volume.geometry, options.seedsName, context.fieldWord);
  if (!placed.advice.empty())
    warn(context.progress, {WarningCode::SeedsFrame, file + ": " + placed.advice});
  warnOfSeeds(file, {WarningCode::SeedLeftOut, " is left out: "}, placed.leftOut, context);
  warnOfSeeds(file, {WarningCode::SeedPoint, " is used without one of its points: "},
              placed.leftPoints, context);
  return placed;
}

void reportOnSeeds(const convert::Volume& volume, const VesselOptions& options,
                   convert::PlacedSeeds& placed, convert::TrackResult& result,
                   const Context& context) {
  const std::string file = formats::printable(options.seedsName);
  const std::vector<convert::SeedBranch>& seeds = options.seeds;
  addNearestVessels(result.result.tree, placed.seeds, result.failures);
  warnOfSeeds(file, {WarningCode::SeedUntracked, " started no track: "}, result.failures, context);
  warnOfSeeds(file, {WarningCode::SeedPoint, " does not pass through its "}, result.missedPoints,
              context);
  warnOfSeeds(file, {WarningCode::SeedUnjoined, " is not joined to its parent: "}, result.unjoined,
              context);
  const bool isNone =
      result.result.tree.nodeCount() == 0 || result.failures.size() == placed.seeds.size();
  if (isNone || 2 * result.failures.size() > placed.seeds.size()) {
    const std::string doubt = doubtAboutSeeds(volume, seeds, placed.seeds, options.track, context);
    const std::string count = std::to_string(seeds.size()) + " seeds started ";
    // seeds of one vessel may fail together: without a doubt about them the rest is good
    if (isNone || !doubt.empty())
      throw failed(
          file + ": " +
          (seeds.size() == 1 ? "its seed started no track"
           : isNone          ? "none of its " + count + "a track"
                    : std::to_string(result.failures.size()) + " of its " + count + "no track") +
          doubt + "; nothing is written");
  }
  std::move(placed.leftOut.begin(), placed.leftOut.end(), std::back_inserter(result.failures));
  std::move(placed.leftPoints.begin(), placed.leftPoints.end(),
            std::back_inserter(result.missedPoints));
}

convert::PlaceTest placesOfPrior(const convert::Prior& prior,
                                 const convert::VolumeGeometry& geometry) {
  if (prior.systems.empty()) return {};
  return {[&](const Eigen::Vector3d& place) {
    const auto cell = geometry.cells().nearest(geometry.indexFromWorld(place));
    return cell && prior.isNoVessel(geometry.index(*cell));
  }};
}

convert::TrackResult trackPlaced(const convert::Volume& volume, const convert::PlacedSeeds& placed,
                                 const VesselOptions& options, const Context& context) {
  const convert::PlaceTest isNoVessel = placesOfPrior(options.prior, volume.geometry);
  LitSeeds seeds = withoutDark(volume, placed.seeds, options.track.dark, context);
  convert::TrackResult result;
  if (!seeds.lit.empty())
    result =
        convert::trackFromSeeds(volume, seeds.lit, options.track, context.progress, isNoVessel);
  std::move(seeds.dark.begin(), seeds.dark.end(), std::back_inserter(result.failures));
  for (convert::SeedFailure& unkept :
       convert::unkeptParents(result.result.tree, placed.seeds, {}, result.unjoined))
    result.unjoined.push_back(std::move(unkept));
  explainByPrior(placed.seeds, isNoVessel, result);
  return result;
}

convert::TrackResult placeAndTrack(const convert::Volume& volume, const VesselOptions& options,
                                   const Context& context) {
  convert::PlacedSeeds placed = placedSeeds(volume, options, context);
  convert::TrackResult result = trackPlaced(volume, placed, options, context);
  reportOnSeeds(volume, options, placed, result, context);
  convert::setSeeds(result.result, convert::markTracked(placed.seeds, result.failures));
  return result;
}

}  // namespace lumen::operations
