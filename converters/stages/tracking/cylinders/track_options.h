// SPDX-License-Identifier: Apache-2.0
// Options of the tracker.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "converters/base/field_word.h"
#include "converters/base/options/option_table.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Defaults are those of Yureidini's thesis, table 3.1.
struct TrackOptions {
  double inlierRate = 0.70;  ///< p_inl: accepts a cylinder
  double inlierBand = 0.10;  ///< r_t: half width of the inlier band, relative to the radius
  int rays = 162;            ///< N_r: an icosphere's vertex count: 12, 42, 162 or 642
  int axes = 81;             ///< N_d: half of an icosphere's vertex count: 6, 21, 81 or 321
  int samples = 128;         ///< N_p: samples on a ray, at most
  int minTrials = 220;       ///< N_min: RANSAC trials for each axis
  int maxTrials = 500;       ///< N_max
  double step = 0.5;         ///< s: prediction step, in cylinder heights
  double noiseMargin = 1.8;  ///< a node below p_inl needs a wall this many times as strong as noise
  int lookAhead = 4;         ///< steps to look beyond a place where nothing fits; 0: stop there
  double branchOffset = 1.25;  ///< a child starts this many parent radii from its parent's axis
  /// aneurysm points need this share of the strongest gradient seen from their centre
  double aneurysmGradient = 0.3;
  /// standard deviation of the blur, mm, by which walls are corrected; 0: not at all; empty:
  /// measured
  std::optional<double> pointSpread;
  /// standard deviation, mm, of the Gaussian that smooths the volume; empty: chosen by its noise
  std::optional<double> smoothing;
  /// Smooth the finer axes of a volume whose coarsest edge is over 1.5 times as long, until all are
  /// about as blurred.
  bool evenBlur = true;
  int maxNodes = 20000;    ///< bound on nodes in one branch
  bool dark = false;       ///< vessels are darker than their background
  std::uint64_t seed = 1;  ///< seed of the random numbers
  FieldWord word{};        ///< names fields in messages

  /// Adds a row for each value above, stored in this object.
  void addRows(OptionTable& table);
  /// Adds the rows of the values that count for vessels that are found without seeds.
  void addFoundRows(OptionTable& table);
  /// Throws Error(InvalidInput) if a value is out of range for a volume whose voxels' smallest edge
  /// is `smallestEdge` mm.
  void check(double smallestEdge) const;
  /// The values that are set, by option name, as a case stores them.
  [[nodiscard]] std::map<std::string, formats::ParameterValue> parameters() const;
};

}  // namespace lumen::convert
