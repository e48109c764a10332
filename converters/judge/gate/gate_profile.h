// SPDX-License-Identifier: Apache-2.0
// Thresholds by which a case passes, or needs a person (docs/quality.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lumen::convert {

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
/// Error(InvalidInput) for a file that is none.
GateProfile gateProfile(const std::string& nameOrFile);

}  // namespace lumen::convert
