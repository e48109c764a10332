// SPDX-License-Identifier: Apache-2.0
// Facts of a check, as answers and reports state them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/judge/check/check.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The label of a node's branch.
const std::string& labelOf(const formats::CenterlineTree& tree, std::uint32_t node);

/// The middle of a vessel's way, mm, LPS.
const Eigen::Vector3d& middleOf(const MissingVessel& vessel);

/// part / whole; not a number unless `whole` is above 0.
double share(double part, double whole);

/// "2.5 %", or "-".
std::string percentText(double share);

/// "(1.0, 2.0, 3.0)".
std::string placeText(const Eigen::Vector3d& place);

/// The ends beyond which the volume shows more of their vessel, the longest first.
std::vector<OpenEnd> endsThatStopShort(const CheckReport& report);

/// How a volume relates to the one that a case was made from.
struct SourceRelation {
  bool isKnown = false;
  std::optional<SourceDifference> difference;

  /// "same", "unknown", or what differs: "other size".
  [[nodiscard]] std::string word() const;
  /// Says what differs, if something does. `volumeName`: of the volume's file.
  [[nodiscard]] std::optional<std::string> warning(const std::string& volumeName) const;
};
SourceRelation sourceRelation(const formats::SourceVolume& volume,
                              const formats::Metadata& metadata);

/// Says how many nodes lie outside of the volume, if some do.
std::optional<std::string> outsideWarning(const CheckReport& report, const std::string& volumeName);

}  // namespace lumen::convert
