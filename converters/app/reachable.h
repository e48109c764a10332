// SPDX-License-Identifier: Apache-2.0
// Which part of a case a tool can be pushed through, for answers and warnings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/app/report.h"
#include "converters/common/progress.h"
#include "formats/case/case.h"
#include "formats/field/vector.h"

namespace lumen::app {

/// Where the way is closed: see formats::Barrier.
struct ClosedPlaceInfo {
  std::string branch;       ///< its label
  std::uint32_t node = 0;   ///< within the branch
  std::uint32_t index = 0;  ///< of that node in the tree
  field::Vec position{};    ///< mm, LPS
  double beyond = 0;        ///< mm
};

struct Reach {
  double length = 0, of = 0;  ///< mm
  std::vector<ClosedPlaceInfo> closed;
};

/// Empty for a case without models.
std::optional<Reach> reachOf(const formats::Case& value);

/// "3448.1 of 3477.0 mm".
std::string reachText(const Reach& reach);

/// "branch a-1 is closed before its node 27, at (1, 2, 3): 28.9 mm beyond cannot be reached".
std::string closedText(const ClosedPlaceInfo& place);

/// length_mm, of_mm and closed; null for nothing.
Json reachJson(const std::optional<Reach>& reach);

/// An answer with the member "reachable".
Json withReach(Json json, const std::optional<Reach>& reach);

/// "reachable: 3448.1 of 3477.0 mm\n"; empty for nothing.
std::string reachLine(const std::optional<Reach>& reach);

/// A warning for each place, as long as there are not too many to read.
void warnOfClosed(const std::optional<Reach>& reach, Progress& progress);

}  // namespace lumen::app
