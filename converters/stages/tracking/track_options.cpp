// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/track_options.h"

#include "converters/base/error.h"
#include "converters/geometry/icosphere.h"
#include "converters/voxels/bspline.h"

namespace lumen::convert {
namespace {

void require(bool holds, const char* rule) {
  if (!holds) throw invalidInput(std::string("tracking options: ") + rule);
}

}  // namespace

void TrackOptions::check(double smallestEdge) const {
  require(inlierRate > 0 && inlierRate <= 1, "inlier-rate must be in (0, 1]");
  require(inlierBand > 0 && inlierBand < 1, "inlier-band must be in (0, 1)");
  require(icosphereOrder(rays) > 0, "rays must be 12, 42, 162 or 642");
  require(icosphereOrder(2 * axes) > 0, "axes must be 6, 21, 81 or 321");
  require(samples >= 8 && samples <= 4096, "samples must be in 8 .. 4096");
  require(minTrials >= 1 && maxTrials >= minTrials,
          "min-trials must be at least 1 and max-trials at least min-trials");
  require(step > 0 && step <= 2, "step must be in (0, 2]");
  require(lookAhead >= 0 && lookAhead <= 100, "look-ahead must be in 0 .. 100");
  require(noiseMargin >= 0 && noiseMargin <= 100, "noise-margin must be in 0 .. 100");
  require(branchOffset > 0 && branchOffset <= 10, "branch-offset must be in (0, 10]");
  require(aneurysmGradient >= 0 && aneurysmGradient <= 1, "aneurysm-gradient must be in [0, 1]");
  require(!pointSpread || (*pointSpread >= 0 && *pointSpread <= 1000),
          "point-spread must be in 0 .. 1000");
  require(!smoothing || *smoothing >= 0, "smoothing must not be negative");
  require(maxNodes >= 2, "max-nodes must be at least 2");
  require(smoothing.value_or(0.0) <= BsplineVolume::kMostSmoothing * smallestEdge,
          "smoothing must be at most twice the smallest edge of a voxel");
}

std::map<std::string, formats::ParameterValue> TrackOptions::parameters() const {
  const auto integer = [](int value) { return static_cast<std::int64_t>(value); };
  std::map<std::string, formats::ParameterValue> values{
      {"inlier-rate", inlierRate},
      {"inlier-band", inlierBand},
      {"rays", integer(rays)},
      {"axes", integer(axes)},
      {"samples", integer(samples)},
      {"min-trials", integer(minTrials)},
      {"max-trials", integer(maxTrials)},
      {"step", step},
      {"noise-margin", noiseMargin},
      {"look-ahead", integer(lookAhead)},
      {"branch-offset", branchOffset},
      {"aneurysm-gradient", aneurysmGradient},
      {"max-nodes", integer(maxNodes)},
      {"dark", dark},
      {"even-blur", evenBlur},
      {"random-seed", static_cast<std::int64_t>(seed)}};
  if (smoothing) values["smoothing"] = *smoothing;
  if (pointSpread) values["point-spread"] = *pointSpread;
  return values;
}

}  // namespace lumen::convert
