// SPDX-License-Identifier: Apache-2.0
// Facts of a check, worded for answers and reports.
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

/// The middle of a vessel's path, mm, LPS.
const Eigen::Vector3d& middleOf(const MissingVessel& vessel);

/// part / whole; NaN unless `whole` is above 0.
double share(double part, double whole);

/// A share in per cent, "2.5 %", or "-".
std::string percentText(double share);

/// The ends beyond which the volume shows more of the vessel, the longest first.
std::vector<OpenEnd> endsThatStopShort(const CheckReport& report);

/// Relation of a volume to the one from which a case was made.
struct SourceRelation {
  bool isKnown = false;
  std::optional<SourceDifference> difference;

  /// "same", "unknown", or the difference: "other size".
  [[nodiscard]] std::string word() const;
  /// A warning that reports the difference, if there is one. `volumeName`: the name of the volume's
  /// file.
  [[nodiscard]] std::optional<std::string> warning(const std::string& volumeName) const;
};
SourceRelation sourceRelation(const formats::SourceVolume& volume,
                              const formats::Metadata& metadata);

/// A warning with the number of nodes outside of the volume, if there are any.
std::optional<std::string> outsideWarning(const CheckReport& report, const std::string& volumeName);

}  // namespace lumen::convert
