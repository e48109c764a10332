// SPDX-License-Identifier: Apache-2.0
// Agreement of several runs of tracking that began at slightly different places (docs/method.md,
// section 6).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/case/case.h"

namespace lumen::convert {

/// How much of a tree other runs find again.
struct Repetition {
  /// A vessel of which a run finds less than half, and that is longer than kLongVessel.
  struct Vessel {
    std::string label;     ///< in the judged case; empty if it is a vessel of another run alone
    double length = 0;     ///< mm
    std::size_t runs = 0;  ///< runs that lack it, or the one that has it
  };

  std::size_t runs = 0;                        ///< beside the judged case
  double leastLength = 0, greatestLength = 0;  ///< mm of all vessels, the judged case included
  std::vector<float> nodes;  ///< for each node: share of the runs in whose lumen it lies, in [0, 1]
  std::vector<float> branches;  ///< for each branch: mean over its nodes
  std::vector<Vessel> unstable;

  /// Greatest difference of the lengths, as a share of the greatest one: 1 if a run finds nothing.
  [[nodiscard]] double spread() const {
    return greatestLength > 0 ? (greatestLength - leastLength) / greatestLength : 0.0;
  }
};

/// mm: a shorter vessel may come and go.
constexpr double kLongVessel = 5;

/// Compares a case with other runs of the same volume. Neither needs more than a tree; runs may have
/// none.
Repetition compareRuns(const formats::Case& judged, std::span<const formats::Case> runs);

}  // namespace lumen::convert
