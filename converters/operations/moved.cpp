// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/moved.h"

#include <cstdint>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/stages/fitting/image/fit_to_image.h"

namespace lumen::operations {

namespace {

/// Reads the first phase before the vessels are followed, and states in `options` whether vessels
/// are dark. `phase`: the one that is read.
convert::TrackedMotion follow(const formats::Case& rest, const PhaseSeries& phases,
                              convert::MotionOptions& options, std::size_t& phase,
                              Progress& progress) {
  convert::Volume first = phases.read(0);
  options.dark = convert::recordedImageFit(rest, first).dark;
  const auto read = [&](std::size_t next) {
    phase = next;
    return next == 0 ? std::move(first) : phases.read(next);
  };
  return convert::trackMotion(rest, phases.times, phases.period, read, options, progress);
}

}  // namespace

MovedCase moved(formats::Case rest, const std::string& name, const PhaseSeries& phases,
                const Context& context) {
  convert::MotionOptions options;
  options.reach = phases.reach;
  convert::TrackedMotion tracked;
  std::size_t phase = 0;
  try {
    tracked = follow(rest, phases, options, phase, context.progress);
  } catch (const Error& error) {
    const std::string volume = phases.name(phase);
    if (error.kind() != ErrorKind::InvalidInput ||
        std::string_view(error.what()).find(volume) != std::string_view::npos)
      throw;
    throw invalidInput(name + " and " + volume + ": " + error.what());
  }
  rest.motion = std::move(tracked.motion);
  rest.metadata.steps.push_back({"motion",
                                 "lumen " LUMEN_VERSION,
                                 {{"phases", static_cast<std::int64_t>(phases.times.size())},
                                  {"reach", options.reach},
                                  {"dark", options.dark}}});
  return {std::move(rest), std::move(tracked.phases)};
}

}  // namespace lumen::operations
