// SPDX-License-Identifier: Apache-2.0
// New vessels in a case that is tracked already (docs/method.md, section 11).
#pragma once

#include <cstdint>
#include <vector>

#include "converters/stages/tracking/tracker.h"
#include "converters/stages/tracking/tracking_volume.h"

namespace lumen::convert {

struct FurtherTracks : TrackRemarks {
  /// The nodes and branches that there were, under their indices, and the new ones behind them. New nodes
  /// have no models yet. As it was, if nothing was tracked.
  formats::Case result;
  std::uint32_t firstNewNode = 0, firstNewBranch = 0;
  /// Nodes that were there and have other wall points now: where an aneurysm opens into their vessel.
  std::vector<std::uint32_t> changed;
  /// Names of node arrays that were dropped, since nobody knows their values at new nodes.
  std::vector<std::string> droppedArrays;
};

/// Tracks seeds as track() does, in a volume with a valid case of it, `known`, whose vessels stay as they
/// are: a new track ends where it meets one, a click in one starts nothing, and a new vessel is joined to
/// its parent through the lumen. `parent` of a seed is the label of a branch of the case or of another
/// seed; without one it is joined to what it runs into. An aneurysm is a chain of clicks with radii, as
/// ever. The "edit" step of the result says what was tracked. The result does not depend on the number of
/// threads. Throws Error(InvalidInput) if a seed has the label of a branch or of another seed, or a parent
/// that is none, and Error(Cancelled).
FurtherTracks trackFurther(const TrackingVolume& volume, const formats::Case& known,
                           const std::vector<SeedBranch>& seeds, Progress& progress);

}  // namespace lumen::convert
