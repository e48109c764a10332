// SPDX-License-Identifier: Apache-2.0
// Tracking of vessels from seeds, the vessel under the pointer, and the volume as both take it.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/tracking/cylinders/track_options.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document.h"
#include "viewer/session/document/encoded_document.h"

namespace lumen::viewer {

/// Keeps the last tracking volume: another volume, or a case that was tracked otherwise, has
/// another one. All calls are thread-safe; while one makes it, others wait.
class TrackingCache {
public:
  /// `clicks` and `options` count where no case was tracked in the volume yet.
  std::shared_ptr<const convert::TrackingVolume> volumeFor(const Document& document,
                                                           const Seeds& clicks,
                                                           const convert::TrackOptions& options,
                                                           Progress& progress);

private:
  std::mutex m_mutex;  ///< guards all that follow
  std::shared_ptr<const convert::TrackingVolume> m_tracking;
  std::shared_ptr<const convert::Volume> m_volume;
  formats::Step m_step;  ///< step that tracked the case
};

/// The seeds with the labels of the request, or all, without those that are vessels already. A
/// parent that is neither a vessel nor among them is left out.
Seeds untrackedSeeds(const Document& document, const Arguments& request);

struct TrackedCase {
  std::shared_ptr<const formats::Case> value;  ///< fitted
  std::size_t newVessels = 0;
  std::vector<std::string> droppedArrays;  ///< node arrays without values for new nodes
};

/// The case of the document with the vessels of these seeds, or a new case. The document has a
/// volume. Throws as the stages.
TrackedCase trackUntracked(const Document& document, const Seeds& seeds, TrackingCache& cache,
                           const SessionOptions& options, Progress& progress);

/// Fits the nodes of `value` from `firstNew` on, and those around them, as its case was fitted; none
/// if `known`, of the nodes before, has no models.
void fitNewNodes(formats::Case& value, const formats::Case& known, std::uint32_t firstNew,
                 Progress& progress);

/// The vessels that the volume of a document shows and its case lacks, without clicks, as proposals
/// with names that are free; a label map states what lies where, and names them. Null if the case has
/// all. Throws Error(Failed) if the volume shows none, Error(InvalidInput) for a mask, and as the
/// stages.
std::shared_ptr<const formats::Case> findProposals(const Document& document, TrackingCache& cache,
                                                   const SessionOptions& options,
                                                   Progress& progress);

/// {"found", "position", "direction", "radius_mm", "reason"} of the axis near a click, mm. Throws
/// Error(Usage) without a volume.
Json vesselNear(const Eigen::Vector3d& click, const Document& document, TrackingCache& cache,
                const convert::TrackOptions& options);

}  // namespace lumen::viewer
