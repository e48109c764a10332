// SPDX-License-Identifier: Apache-2.0
// A broken rule: which, where, and what was found. All of the format library answers with it: a
// file that cannot be read, bytes that are no container, a value that breaks a rule of the model.
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

  /// "byte 128", a JSON pointer such as /tree/branches/2/label (empty: the whole), or "file".
  [[nodiscard]] std::string place() const;
  /// For people: "RADIUS_RANGE at byte 128 (/tree/radius/0): found -1, expected more than 0 mm".
  [[nodiscard]] std::string text() const;
};

/// An issue with a JSON pointer.
Issue pointerIssue(ErrorCode code, std::string pointer, std::string message,
                   std::vector<Argument> arguments = {});

/// An issue of the model: "found F, expected E".
Issue foundIssue(ErrorCode code, std::string pointer, const std::string& found,
                 const std::string& expected);

/// An issue of a count beyond its published maximum, or of a text's length.
Issue limitIssue(ErrorCode code, std::string pointer, std::size_t found, std::size_t limit);

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
  /// The first that was kept of those that refuse the file.
  [[nodiscard]] std::optional<Issue> firstError() const;
  [[nodiscard]] const std::vector<Issue>& issues() const { return m_issues; }
  [[nodiscard]] std::vector<Issue>& issues() { return m_issues; }

private:
  std::size_t m_maximum, m_errors = 0;
  Keep m_keep;
  std::vector<Issue> m_issues;
};

}  // namespace lumen::formats
