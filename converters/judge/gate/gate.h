// SPDX-License-Identifier: Apache-2.0
// The verdict on a checked case by a profile's thresholds: passed, or a person is needed, and
// where.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "converters/judge/check/check.h"
#include "converters/judge/facts/reachable.h"
#include "formats/case/case.h"

namespace lumen::convert {

// Thresholds by which a case passes, or needs a person (docs/quality.md).

/// A limit on one measure of a check.
struct Threshold {
  std::string measure;   ///< one of gateMeasures()
  bool isLeast = false;  ///< the least value that passes; otherwise the greatest
  double limit = 0;
};

struct GateProfile {
  std::string name;
  std::string summary;  ///< what cases that pass are good for; empty for a profile of a file
  std::vector<Threshold> thresholds;
};

/// A measure of a check, as a profile names it.
struct GateMeasure {
  std::string_view name;
  bool isLeast;            ///< more of it is better
  std::string_view about;  ///< a noun for people
};

/// All measures, in the order of reports.
const std::vector<GateMeasure>& gateMeasures();

/// The profiles that lumen has.
const std::vector<GateProfile>& gateProfiles();

/// The profile of that name, or the one in a file whose name ends in .json: {"name": TEXT, "least":
/// {MEASURE: NUMBER}, "most": {MEASURE: NUMBER}}. Throws Error(Usage) for an unknown name,
/// Error(InvalidInput) for a file that is no profile.
GateProfile gateProfile(const std::string& nameOrFile);

/// A measure that does not keep its threshold.
struct GateFault {
  Threshold threshold;
  double found = 0;   ///< NaN: not known, which does not pass
  double excess = 0;  ///< how far beyond the limit, in units of what the limit leaves; > 0
};

/// A place for a person to look at.
struct GatePlace {
  std::string measure;                                 ///< of the fault that it belongs to
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS
  std::uint32_t node = 0;                              ///< of the case, the nearest
};

struct GateVerdict {
  std::string profile;
  std::vector<GateFault> faults;   ///< the farthest beyond its limit first
  std::optional<GatePlace> worst;  ///< of the first fault that has a place
  [[nodiscard]] bool passes() const { return faults.empty(); }
};

/// `value` is the case of the report, and valid; `reach` is of it.
GateVerdict judgeCase(const GateProfile& profile, const formats::Case& value,
                      const CheckReport& report, const std::optional<Reach>& reach);

}  // namespace lumen::convert
