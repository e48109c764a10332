// SPDX-License-Identifier: Apache-2.0
// Session: from seeds to vessels, and the vessel under the pointer.
#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "converters/base/edit_steps.h"
#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/engine/centerline_input.h"
#include "converters/engine/stages.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/fitting/refit.h"
#include "converters/stages/tracking/snap.h"
#include "converters/stages/tracking/track_further.h"
#include "formats/container/printable.h"
#include "viewer/session/session.h"

namespace lumen::viewer {

namespace {

bool hasVessels(const Document& document) {
  return document.value && document.value->tree.nodeCount() > 0;
}

/// The seeds with these labels, or all that are no vessels yet; parents that are neither tracked nor
/// among them are left out.
Seeds seedsFor(const Document& document, const Arguments& request) {
  std::set<std::string> known;
  if (document.value)
    for (const formats::Branch& branch : document.value->tree.branches) known.insert(branch.label);
  std::set<std::string> wanted;
  if (request.has("labels"))
    for (std::string& label : request.texts("labels")) wanted.insert(std::move(label));
  Seeds seeds;
  for (const convert::SeedBranch& seed : *document.seeds)
    if (!known.contains(seed.label) && (wanted.empty() || wanted.contains(seed.label)))
      seeds.push_back(seed);
  for (const convert::SeedBranch& seed : seeds) known.insert(seed.label);
  for (convert::SeedBranch& seed : seeds)
    if (seed.parent && !known.contains(*seed.parent)) seed.parent.reset();
  return seeds;
}

void warnOf(const std::vector<convert::SeedFailure>& failures, const std::string& what,
            Progress& progress) {
  for (const convert::SeedFailure& failure : failures)
    progress.warn("seed \"" + formats::printable(failure.label) + "\"" + what + failure.reason);
}

/// A case that has its tree, wall points and models from these seeds alone.
formats::Case trackedAnew(const Document& document, const Seeds& seeds,
                          const SessionOptions& options, Progress& progress) {
  app::TrackArguments arguments = options.track;
  arguments.seeds = "the seeds";
  formats::Case value = app::trackSeeds(*document.volume, seeds, arguments, progress).result;
  convert::fit(value, app::fitOptionsFor(value, options.fit.options()), progress);
  return value;
}

/// The case with what `seeds` lead to; what it had stays.
formats::Case trackedFurther(const convert::TrackingVolume& volume, const formats::Case& known,
                             const Seeds& seeds, std::vector<std::string>& dropped,
                             Progress& progress) {
  convert::FurtherTracks tracks = convert::trackFurther(volume, known, seeds, progress);
  warnOf(tracks.failures, " started no track: ", progress);
  warnOf(tracks.missedPoints, " does not pass through its ", progress);
  warnOf(tracks.unjoined, " is not joined to its parent: ", progress);
  formats::Case value = std::move(tracks.result);
  if (value.tree.nodeCount() == known.tree.nodeCount())
    throw failed(seeds.size() == 1 ? "the seed started no track"
                                   : "none of the seeds started a track");
  dropped = std::move(tracks.droppedArrays);
  if (!known.models) return value;
  std::vector<std::uint32_t> before(value.tree.nodeCount(), UINT32_MAX);
  std::iota(before.begin(), before.begin() + tracks.firstNewNode, 0U);
  convert::refit(value, convert::staleNodes(known, value, before),
                 convert::recordedFitOptions(value), progress);
  return value;
}

}  // namespace

Json Session::track(const Arguments& request, const Moment& from) {
  if (!from.document.volume) throw Error(ErrorKind::Usage, "tracking needs a volume");
  const Seeds seeds = seedsFor(from.document, request);
  if (seeds.empty()) throw Error(ErrorKind::Usage, "there is no seed that is not tracked yet");
  return startJob("tracking", true, [this, from, seeds](Progress& progress) {
    std::vector<std::string> dropped;
    auto value = std::make_shared<formats::Case>(
        hasVessels(from.document) ? trackedFurther(*trackingVolume(from.document, seeds, progress),
                                                   *from.document.value, seeds, dropped, progress)
                                  : trackedAnew(from.document, seeds, m_options, progress));
    const std::size_t had = from.document.value ? from.document.value->tree.branches.size() : 0;
    const std::size_t more = value->tree.branches.size() - had;
    Document document = from.document;
    document.value = std::move(value);
    const std::string what =
        "track " +
        (seeds.size() == 1 ? seeds.front().label : counted(seeds.size(), "seed", "seeds"));
    commit(what, from, std::move(document));
    tellDropped(dropped);
    return counted(more, "vessel", "vessels") + " tracked";
  });
}

std::shared_ptr<const convert::TrackingVolume> Session::trackingVolume(const Document& document,
                                                                       const Seeds& clicks,
                                                                       Progress& progress) {
  const formats::Step* const step =
      document.value ? lastStep(document.value->metadata, "track") : nullptr;
  const formats::Step made = step != nullptr ? *step : formats::Step{};
  const std::lock_guard lock(m_trackingMutex);
  if (!m_tracking || m_trackedVolume != document.volume || !(m_trackStep == made)) {
    m_tracking.reset();
    m_tracking = step != nullptr ? std::make_shared<const convert::TrackingVolume>(
                                       *document.volume, *document.value, progress)
                                 : std::make_shared<const convert::TrackingVolume>(
                                       *document.volume, clicks, m_options.track.options, progress);
    m_trackedVolume = document.volume;
    m_trackStep = made;
  }
  return m_tracking;
}

Json Session::snap(formats::JsonValue request) {
  const Arguments arguments(request);
  const Eigen::Vector3d click = arguments.position("position");
  const Document document = m_history.now().document;
  if (!document.volume) throw Error(ErrorKind::Usage, "there is no volume to look for a vessel in");
  Progress silent;
  convert::SeedBranch seed;
  seed.label = "click";
  seed.points.push_back({click, std::nullopt});
  const auto json = [](const Eigen::Vector3d& v) -> Json { return {v.x(), v.y(), v.z()}; };
  if (!document.volume->geometry.containsWorld(click))
    return {{"found", false}, {"position", json(click)}, {"reason", "outside of the volume"}};
  const auto snap = convert::snapToVessel(*trackingVolume(document, {seed}, silent), click);
  return {{"found", snap.found},
          {"position", json(snap.position)},
          {"direction", json(snap.direction)},
          {"radius", snap.radius},
          {"reason", snap.reason}};
}

}  // namespace lumen::viewer
