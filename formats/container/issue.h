// SPDX-License-Identifier: Apache-2.0
// A broken rule: which, where, and what was found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/container/error_code.h"

namespace lumen::formats {

/// What a rule was applied to. `name` is one of those that the rule declares, such as "found".
struct Argument {
  std::string name, value;
  friend bool operator==(const Argument&, const Argument&) = default;
};

/// At least one of `offset` and `pointer` is known, except for a file that cannot be read at all.
struct Issue {
  ErrorCode code;
  std::optional<std::uint64_t> offset{};  ///< bytes from the start of the file
  std::string message{};                  ///< what was found and what was expected
  std::vector<Argument> arguments{};
  std::optional<std::string> pointer{};  ///< JSON pointer (RFC 6901) into the JSON encoding
};

/// Collects issues up to a maximum. Checks ask full() to stop early.
class IssueList {
public:
  enum class Keep : std::uint8_t { All, Errors };

  explicit IssueList(std::size_t maximum, Keep keep = Keep::All)
      : m_maximum(maximum), m_keep(keep) {}

  void add(Issue issue) {
    const bool isError = severityOf(issue.code) == Severity::Error;
    if (!isError && m_keep == Keep::Errors) return;
    if (isError) ++m_errors;
    if (!full()) m_issues.push_back(std::move(issue));
  }
  /// No further issue would be kept.
  [[nodiscard]] bool full() const { return m_issues.size() >= m_maximum; }
  [[nodiscard]] bool keepsWarnings() const { return m_keep == Keep::All && !full(); }
  /// True if there was an error, kept or not; warnings do not count.
  [[nodiscard]] bool failed() const { return m_errors > 0; }
  [[nodiscard]] std::size_t errorCount() const { return m_errors; }
  [[nodiscard]] const std::vector<Issue>& issues() const { return m_issues; }
  [[nodiscard]] std::vector<Issue>& issues() { return m_issues; }

private:
  std::size_t m_maximum, m_errors = 0;
  Keep m_keep;
  std::vector<Issue> m_issues;
};

}  // namespace lumen::formats
