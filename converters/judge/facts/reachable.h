// SPDX-License-Identifier: Apache-2.0
// Which part of a case a tool can be pushed through, for answers and warnings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "formats/case/case.h"
#include "formats/field/vector.h"

namespace lumen::convert {

/// Where the way is closed: see formats::Barrier.
struct ClosedWay {
  std::string branch;      ///< its label
  std::uint32_t node = 0;  ///< index in the case; the way to it is closed
  field::Vec position{};   ///< mm, LPS
  double beyond = 0;       ///< mm
};

struct Reach {
  double length = 0, of = 0;      ///< mm
  std::vector<ClosedWay> closed;  ///< the one with most beyond it first
};

/// Empty for a case without models. The case is valid.
std::optional<Reach> reachOf(const formats::Case& value, const Progress& progress);

/// "3448.1 of 3477.0 mm", or why that is not known.
std::string reachText(const std::optional<Reach>& reach);

/// "reachable: 3448.1 of 3477.0 mm\n".
std::string reachLine(const std::optional<Reach>& reach);

/// "branch a-1 is closed before node 27 at (1.0, 2.0, 3.0): 28.9 mm beyond cannot be reached".
std::string closedText(const ClosedWay& way);

/// One text for each closed way, or as many as are worth reading and then how many more there are.
std::vector<std::string> closedTexts(const Reach& reach);

/// A warning of each of these texts.
void warnOfClosed(const std::optional<Reach>& reach, Progress& progress);

}  // namespace lumen::convert
