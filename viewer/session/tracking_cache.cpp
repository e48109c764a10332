// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/tracking_cache.h"

#include "converters/base/edit_steps.h"

namespace lumen::viewer {

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
                                       *document.volume, *document.value, progress)
                                 : std::make_shared<const convert::TrackingVolume>(
                                       *document.volume, clicks, options, progress);
    m_volume = document.volume;
    m_step = made;
  }
  return m_tracking;
}

}  // namespace lumen::viewer
