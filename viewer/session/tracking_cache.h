// SPDX-License-Identifier: Apache-2.0
// The volume as tracking and snapping take it.
#pragma once

#include <memory>
#include <mutex>

#include "converters/base/progress.h"
#include "converters/stages/tracking/track_options.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "viewer/session/document.h"

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

}  // namespace lumen::viewer
