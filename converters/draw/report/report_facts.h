// SPDX-License-Identifier: Apache-2.0
// Facts on the page of `lumen report`.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "converters/judge/check/check.h"
#include "converters/judge/facts/case_info.h"
#include "converters/judge/facts/check_facts.h"
#include "converters/judge/facts/examination.h"
#include "converters/judge/measure/measures.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A picture in the PNG format.
struct DrawnView {
  std::string title;
  std::string png;
  int width = 0, height = 0;  ///< pixels
};

/// The volume that the case is held against.
struct ReportVolume {
  std::string name;  ///< the file's
  formats::SourceVolume geometry;
  SourceRelation source;
  std::optional<convert::CheckReport> check;  ///< none of a case without models
  std::vector<DrawnView> projections;         ///< one scale for all; they show the tree, too
};

struct ReportFacts {
  std::string title;
  std::string caseName;   ///< the file's
  std::size_t bytes = 0;  ///< size of the file
  std::string sha256;     ///< digest of the file
  formats::Case value;
  CaseInfo info;
  CaseMeasures measures;
  FileReport examination;
  /// Warnings about the closed surface, reading the volume, how the case lies in it, and names of
  /// files.
  std::vector<std::string> otherWarnings;
  std::vector<DrawnView> sides;         ///< none of a case without models
  std::optional<DrawnView> confidence;  ///< none if a case without models or inlier rates
  std::optional<ReportVolume> volume;   ///< none without --volume

  /// Number of warnings, without notes.
  [[nodiscard]] std::size_t warnings() const {
    return examination.counts.warnings + otherWarnings.size();
  }
};

}  // namespace lumen::convert
