// SPDX-License-Identifier: Apache-2.0
// A case with the motion of its vessels through a series of volumes.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "converters/operations/context.h"
#include "converters/stages/motion/track_motion.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// Volumes of one patient space in the order of time. One of them is in memory at a time, beside
/// the first.
struct PhaseSeries {
  std::vector<double> times;  ///< s, ascending, one for each volume, at least one
  double period = 0;          ///< s of a cycle that begins anew; 0: the motion does not come back
  convert::PhaseSource read;  ///< called once for each phase, in their order, on one thread
  std::function<std::string(std::size_t phase)> name;  ///< for messages
  double reach = convert::MotionOptions{}.reach;  ///< mm, > 0: as that of convert::MotionOptions
};

struct MovedCase {
  formats::Case value;                       ///< as at rest, with the motion of all nodes
  std::vector<convert::PhaseReport> phases;  ///< one for each phase
};

/// The case `rest`, called `name`, with the motion that trackMotion() finds, in place of that which
/// it had, and the step "motion". Vessels are as dark as those that the case was tracked by. Takes
/// seconds to minutes for each phase, on all threads. Throws Error(InvalidInput) for a phase that
/// shows no vessel of the case, with the names of both, what `read` throws, with these names where
/// an Error(InvalidInput) lacks the phase's, and Error(Cancelled).
MovedCase moved(formats::Case rest, const std::string& name, const PhaseSeries& phases,
                const Context& context);

}  // namespace lumen::operations
