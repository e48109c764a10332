// SPDX-License-Identifier: Apache-2.0
// Small cases for tests of operations, and the message of the error that an operation ends in.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "converters/base/error.h"
#include "converters/operations/case_of.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/track_case.h"

namespace lumen::operations::samples {

/// A trunk of 2 mm in radius along z from 0 to 20 mm, and a child of 1 mm that leaves its middle
/// along y and is 8 mm long; with models.
inline formats::Case fittedFork() {
  constexpr double kStep = 0.5;
  constexpr int kTrunk = 41, kChild = 16, kMiddle = 20;
  convert::CenterlineFile file;
  for (int i = 0; i < kTrunk; ++i) file.points.push_back({{0, 0, kStep * i}, 2, i - 1});
  for (int i = 1; i <= kChild; ++i)
    file.points.push_back({{0, kStep * i, kStep * kMiddle}, 1, i == 1 ? kMiddle : kTrunk + i - 2});
  file.unit = 1;
  file.axes = convert::CenterlineAxes::Lps;
  Source source;
  source.centerline = CenterlinePart{std::move(file), "fork"};
  CaseOptions options;
  options.models.emplace();
  Progress silent;
  return caseOf(std::move(source), options, Context{silent}).value;
}

/// The tube phantom, 64 voxels of 0.2 mm across, and the case that is tracked from its seeds. `dark`:
/// the vessel is darker than its background.
struct TrackedTube {
  convert::Volume volume;
  formats::Case value;
};
inline TrackedTube trackedTube(bool dark = false) {
  convert::PhantomOptions options;
  options.name = "tube";
  options.size = 64;
  Progress silent;
  convert::Phantom tube = convert::makePhantom(options, silent);
  if (dark)
    for (auto& v : std::get<std::vector<std::int16_t>>(tube.volume.voxels))
      v = static_cast<std::int16_t>(-v);
  convert::TrackOptions track;
  track.dark = dark;
  TrackedTube made;
  made.value = convert::trackFromSeeds(tube.volume, tube.seeds, track, silent).result;
  made.volume = std::move(tube.volume);
  return made;
}

/// The message of the error that `work` ends in, or "none".
template <class Work>
std::string faultOf(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

}  // namespace lumen::operations::samples
