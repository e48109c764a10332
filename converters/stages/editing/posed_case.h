// SPDX-License-Identifier: Apache-2.0
// A case with a motion, as it stands at one time.
#pragma once

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The case at a time in s, without a motion: nodes, wall points and blobs lie where the poses
/// carry them (spec/lumen.md, "The posed case"), and a step "pose" records the time. A node whose
/// radius changes gets new blobs, fitted to its moved wall points with the options of the case's
/// last fit, because a sum of blobs does not scale. Throws Error(InvalidInput) for a case without a
/// motion, for one whose node needs new blobs and that has no wall points, and for poses that lead
/// to numbers beyond those of the format; Error(Cancelled).
formats::Case posedCase(const formats::Case& source, double time, Progress& progress);

}  // namespace lumen::convert
