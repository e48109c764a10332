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

  // Both are one line, fit to print, whatever the file has in its texts and keys; the members hold
  // them as they are.
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

/// How many issues there are of each severity, listed or not.
struct IssueCounts {
  std::size_t errors = 0, warnings = 0, information = 0;
  [[nodiscard]] std::size_t total() const { return errors + warnings + information; }
  friend bool operator==(const IssueCounts&, const IssueCounts&) = default;
};

/// Counts all issues and keeps some. The verdict is that of the counts; what is cut is the list, so
/// checks go on after it is full. Errors have precedence in it.
class IssueList {
public:
  /// Errors: warnings are not asked for, and checks may stop once the list is full.
  enum class Keep : std::uint8_t { All, Errors };

  explicit IssueList(std::size_t maximum, Keep keep = Keep::All)
      : m_maximum(maximum), m_keep(keep) {}

  void add(Issue issue) {
    if (count(issue.code)) keep(std::move(issue));
  }
  /// For checks of many values: `make` gives the issue, and is called only if that is kept.
  template <class Make>
  void add(ErrorCode code, Make make) {
    if (count(code)) keep(make());
  }
  /// Nothing that is still to be found would change anything: a check may stop.
  [[nodiscard]] bool done() const { return m_keep == Keep::Errors && m_errors.size() >= m_maximum; }
  [[nodiscard]] bool keepsWarnings() const { return m_keep == Keep::All; }
  /// True if there was an error, kept or not; warnings do not count.
  [[nodiscard]] bool failed() const { return m_counts.errors > 0; }
  [[nodiscard]] const IssueCounts& counts() const { return m_counts; }
  /// The first that was kept of those that refuse the file.
  [[nodiscard]] std::optional<Issue> firstError() const;
  /// What is listed: errors as they were found, then the others as they were found.
  [[nodiscard]] std::vector<Issue> take();
  /// Lets `change` complete every issue that is kept.
  template <class Change>
  void forEach(Change change) {
    for (Issue& issue : m_errors) change(issue);
    for (Issue& issue : m_others) change(issue);
  }

private:
  // True if an issue of this code is to be kept.
  bool count(ErrorCode code);
  void keep(Issue issue);

  std::size_t m_maximum;
  Keep m_keep;
  IssueCounts m_counts;
  std::vector<Issue> m_errors, m_others;
};

}  // namespace lumen::formats
