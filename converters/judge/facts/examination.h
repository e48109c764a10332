// SPDX-License-Identifier: Apache-2.0
// Faults and warnings of a case file, as `lumen validate` reports them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "converters/base/input_file.h"
#include "converters/base/progress.h"
#include "formats/case/case_file.h"

namespace lumen::convert {

/// A broken rule, or another finding.
struct Remark {
  std::string code;
  int number = 0;
  std::string severity;
  std::optional<std::uint64_t> offset;
  std::optional<std::string> pointer;
  std::vector<formats::Argument> arguments;
  std::string message;
  std::string text;  ///< "CODE at PLACE: message"
};

struct FileReport {
  bool valid = true;
  bool refusedByStrict = false;  ///< valid, but for a warning and --strict
  bool personal = false;         ///< the privacy check found something, which is a warning
  formats::IssueCounts counts;   ///< counts of all findings, listed or not
  std::vector<Remark> remarks;   ///< the listed findings, errors first
  [[nodiscard]] std::size_t unlisted() const { return counts.total() - remarks.size(); }
};

/// The faults of a case file: broken rules of the format, closed paths, and with `privacy` texts
/// that may identify a patient. Every fault counts for the verdict; at most `maxIssues` remarks are
/// listed. An unreadable file is a remark.
FileReport examine(const InputFile& file, std::size_t maxIssues, bool privacy,
                   const Progress& progress);
/// The faults of a case file in memory: broken rules of the format, closed paths, and with
/// `privacy` texts that may identify a patient. Every fault counts for the verdict; at most
/// `maxIssues` remarks are listed.
FileReport examineBytes(std::span<const std::byte> bytes, const std::string& file,
                        std::size_t maxIssues, bool privacy, const Progress& progress);

}  // namespace lumen::convert
