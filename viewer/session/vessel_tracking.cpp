// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/vessel_tracking.h"

#include <numeric>
#include <set>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/base/warning.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/operations/case_of.h"
#include "converters/operations/label_maps.h"
#include "converters/operations/label_prior.h"
#include "converters/operations/stated_vessels.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/tracking/track_case.h"
#include "converters/stages/tracking/vessel_at_click.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "formats/container/printable.h"
#include "viewer/session/document/document_labels.h"
#include "viewer/session/document/document_seeds.h"
#include "viewer/session/proposals.h"

namespace lumen::viewer {

namespace {

bool hasVessels(const Document& document) {
  return document.value && document.value->tree.nodeCount() > 0;
}

void warnAbout(const std::vector<convert::SeedFailure>& failures,
               const operations::SeedOutcome& outcome, Progress& progress) {
  for (const convert::SeedFailure& failure : failures)
    warn(progress, {outcome.code, "seed \"" + formats::printable(failure.label) + "\"" +
                                      outcome.words + failure.reason});
}

/// A case that has its tree, wall points and models from these seeds alone.
formats::Case trackNewCase(const Document& document, const Seeds& seeds,
                           const SessionOptions& options, Progress& progress) {
  operations::VesselOptions vessels = options.track.vessels();
  vessels.seeds = seeds;
  vessels.seedsName = "the seeds";
  const operations::Context context = engine::operationContext(progress);
  return operations::fitted(operations::placeAndTrack(*document.volume, vessels, context).result,
                            {options.fit}, context);
}

/// The case with further vessels, to which `seeds` lead; it keeps those that it had.
formats::Case trackFurther(const convert::TrackingVolume& volume, const formats::Case& known,
                           const Seeds& seeds, std::vector<std::string>& dropped,
                           Progress& progress) {
  convert::AddedTracks tracks = convert::addTracksFromSeeds(volume, known, seeds, progress);
  warnAbout(tracks.failures, {WarningCode::SeedUntracked, " started no track: "}, progress);
  warnAbout(tracks.missedPoints, {WarningCode::SeedPoint, " does not pass through its "}, progress);
  warnAbout(tracks.unjoined, {WarningCode::SeedUnjoined, " is not joined to its parent: "},
            progress);
  formats::Case value = std::move(tracks.result);
  if (value.tree.nodeCount() == known.tree.nodeCount())
    throw failed(seeds.size() == 1 ? "the seed started no track"
                                   : "none of the seeds started a track");
  dropped = std::move(tracks.droppedArrays);
  fitNewNodes(value, known, tracks.firstNewNode, progress);
  return value;
}

/// Proposals with the names and systems of the labels on which they lie; null for null.
std::shared_ptr<const formats::Case> byMaps(const std::vector<operations::LabelPart>& maps,
                                            const Document& document,
                                            std::shared_ptr<const formats::Case> proposals,
                                            const SessionOptions& options,
                                            const operations::Context& context) {
  if (maps.empty() || !proposals) return proposals;
  const std::string name = document.labelOf(FileRole::Volume);
  const auto naming = operations::namingMaps(maps, document.volume->geometry, name);
  auto named = std::make_shared<formats::Case>(*proposals);
  operations::nameByMaps(naming, *named, context);
  if (options.labels.isOnlyLabelled) operations::leaveOutUnlabelled(naming, *named, name);
  operations::recordMaps(maps, *named);
  return named;
}

/// The middles of the vessels of a case, as clicks.
Seeds clicksOn(const formats::CenterlineTree& tree) {
  Seeds clicks;
  for (const formats::Branch& branch : tree.branches) {
    convert::SeedBranch click;
    click.label = branch.label;
    click.points.push_back(
        {toEigen(tree.centre[branch.firstNode + branch.nodeCount / 2]), std::nullopt});
    clicks.push_back(std::move(click));
  }
  return clicks;
}

}  // namespace

Seeds untrackedSeeds(const Document& document, const Arguments& request) {
  std::set<std::string_view> known = vesselLabels(document.value);
  std::set<std::string> wanted;
  if (request.has("labels"))
    for (std::string& label : request.texts("labels")) wanted.insert(std::move(label));
  Seeds seeds;
  for (const convert::SeedBranch& seed : *document.seeds)
    if (!isTracked(seed, known) && (wanted.empty() || wanted.contains(seed.label)))
      seeds.push_back(seed);
  for (const convert::SeedBranch& seed : seeds) known.insert(seed.label);
  for (convert::SeedBranch& seed : seeds)
    if (seed.parent && !known.contains(*seed.parent)) seed.parent.reset();
  return seeds;
}

TrackedCase trackUntracked(const Document& document, const Seeds& seeds, TrackingCache& cache,
                           const SessionOptions& options, Progress& progress) {
  TrackedCase tracked;
  tracked.value = std::make_shared<const formats::Case>(
      hasVessels(document)
          ? trackFurther(*cache.volumeFor(document, seeds, options.track.options, progress),
                         *document.value, seeds, tracked.droppedArrays, progress)
          : trackNewCase(document, seeds, options, progress));
  const std::size_t had = document.value ? document.value->tree.branches.size() : 0;
  tracked.newVessels = tracked.value->tree.branches.size() - had;
  return tracked;
}

void fitNewNodes(formats::Case& value, const formats::Case& known, std::uint32_t firstNew,
                 Progress& progress) {
  if (!known.models) return;
  std::vector<std::uint32_t> before(value.tree.nodeCount(), UINT32_MAX);
  std::iota(before.begin(), before.begin() + firstNew, 0U);
  convert::refit(value, convert::staleNodes(known, value, before),
                 convert::recordedFitOptions(value), progress);
}

std::shared_ptr<const formats::Case> findProposals(const Document& document, TrackingCache& cache,
                                                   const SessionOptions& options,
                                                   Progress& progress) {
  const std::string name = formats::printable(document.labelOf(FileRole::Volume));
  const operations::Context context = engine::operationContext(progress);
  if (convert::holdsLabels(*document.volume))
    throw invalidInput(name +
                       ": its voxels are labels, as of a mask; expected the intensities of an "
                       "angiogram. `lumen convert` makes a case of a mask");
  const std::vector<operations::LabelPart> maps = mapsOf(document);
  operations::VesselOptions vessels{options.track.options};
  vessels.prior = operations::priorOf(maps, document.volume->geometry, progress);
  vessels.stated = operations::statedVessels(maps, context);
  if (hasVessels(document)) {
    const auto& known = *document.value;
    const auto tracking = cache.volumeFor(document, clicksOn(known.tree), vessels.track, progress);
    convert::AddedTracks added =
        operations::findAndAdd(*tracking, *document.volume, known, vessels, context);
    auto proposals = proposalsBehind(std::move(added.result), added.firstNewBranch);
    return proposalsFor(document, byMaps(maps, document, std::move(proposals), options, context));
  }
  std::string whyNone;
  convert::TrackResult found =
      operations::findAndTrackIfAny(*document.volume, vessels, whyNone, context);
  if (found.result.tree.nodeCount() == 0)
    throw failed("no vessels are found in " + name + ", as " + whyNone +
                 "; a seed states where a vessel begins");
  auto proposals = proposalsBehind(std::move(found.result), 0);
  return proposalsFor(document, byMaps(maps, document, std::move(proposals), options, context));
}

Json vesselNear(const Eigen::Vector3d& click, const Document& document, TrackingCache& cache,
                const convert::TrackOptions& options) {
  if (!document.volume) refuse("there is no volume to look for a vessel in");
  if (!document.volume->geometry.containsWorld(click))
    return {{"found", false},
            {"position", engine::vectorJson(click)},
            {"reason", "outside of the volume"}};
  convert::SeedBranch seed;
  seed.label = "click";
  seed.points.push_back({click, std::nullopt});
  Progress silent;
  const auto vessel =
      convert::vesselAtClick(*cache.volumeFor(document, {seed}, options, silent), click);
  return {{"found", vessel.found},
          {"position", engine::vectorJson(vessel.position)},
          {"direction", engine::vectorJson(vessel.direction)},
          {"radius_mm", vessel.radius},
          {"reason", vessel.reason}};
}

std::shared_ptr<const convert::TrackingVolume> TrackingCache::volumeFor(
    const Document& document, const Seeds& clicks, const convert::TrackOptions& options,
    Progress& progress) {
  const formats::Step* const step =
      document.value ? lastStep(document.value->metadata, "track") : nullptr;
  const formats::Step made = step != nullptr ? *step : formats::Step{};
  const std::lock_guard lock(m_mutex);
  if (!m_tracking || m_volume != document.volume || !(m_step == made)) {
    m_tracking.reset();
    m_tracking = step != nullptr ? std::make_shared<const convert::TrackingVolume>(
                                       *document.volume, *document.value, progress, options.word)
                                 : std::make_shared<const convert::TrackingVolume>(
                                       *document.volume, clicks, options, progress);
    m_volume = document.volume;
    m_step = made;
  }
  return m_tracking;
}

}  // namespace lumen::viewer
