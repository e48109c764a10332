// SPDX-License-Identifier: Apache-2.0
// The wall of vessels that are not round, or that taper (docs/method.md, section 1.11).
#pragma once

#include <vector>

#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// Gives the measured, poorly fitted nodes of a vessel walls that are ellipses about its course and
/// may taper along it: with the wall points that such a section explains, its middle, and the
/// radius of a disc of the same area. A node keeps its cylinder where the section explains hardly
/// more points, covers less of the way around than the cylinder does, or covers less than two
/// thirds of it.
void fitSections(TrackRun& run, std::vector<TrackedNode>& nodes);

}  // namespace lumen::convert
