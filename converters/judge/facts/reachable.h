// SPDX-License-Identifier: Apache-2.0
// The part of a case that a tool can reach, for answers and warnings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "formats/case/case.h"
#include "formats/field/vector.h"

namespace lumen::convert {

/// A place where the path is closed: see formats::Barrier.
struct ClosedPath {
  std::string branch;      ///< label of the branch
  std::uint32_t node = 0;  ///< index in the case; the path to it is closed
  field::Vec position{};   ///< mm, LPS
  double beyond = 0;       ///< mm
};

struct Reach {
  double length = 0, of = 0;       ///< mm, of vesselLengths()
  std::size_t trees = 0;           ///< that are reached each from its own root
  std::size_t networks = 0;        ///< parts that neither a parent nor a link joins
  double longest = 0;              ///< mm of the longest tree
  std::vector<ClosedPath> closed;  ///< the one with the greatest length beyond it first
};

/// Number of roots.
std::size_t countTrees(const formats::CenterlineTree& tree);

/// Number of parts of a tree that neither a parent nor a link joins.
std::size_t countNetworks(const formats::CenterlineTree& tree);

/// The reachable length of a valid case; empty for a case without models.
std::optional<Reach> measureReach(const formats::Case& value, const Progress& progress);

/// "3448.1 of 3477.0 mm", or the reason why it is unknown.
std::string reachText(const std::optional<Reach>& reach);

/// A line of text, "reachable: 3448.1 of 3477.0 mm\n".
std::string reachLine(const std::optional<Reach>& reach);

/// A closed path as text: "branch a-1 is closed before node 27 at (1.0, 2.0, 3.0): 28.9 mm beyond
/// cannot be reached".
std::string closedText(const ClosedPath& path);

/// One text for each closed path; a long list is cut, and its last text states the number of the
/// others.
std::vector<std::string> closedTexts(const Reach& reach);

/// Reports each closed path's text as a warning.
void warnOfClosed(const std::optional<Reach>& reach, Progress& progress);

}  // namespace lumen::convert
