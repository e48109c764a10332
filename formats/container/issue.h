// SPDX-License-Identifier: Apache-2.0
// A broken rule: its code, its place, and the value found. The whole format library reports it, for
// a file that cannot be read, bytes that are no container, or a value that breaks a rule of the
// model.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/container/fault_list.h"

namespace lumen::formats {

/// A value that a rule was applied to. `name` is one that the rule declares, such as "found".
struct Argument {
  std::string name, value;
  friend bool operator==(const Argument&, const Argument&) = default;
};

/// A broken rule and its place. At least one of `offset` and `pointer` is known, except for a file
/// that cannot be read at all.
struct Issue {
  ErrorCode code;
  std::optional<std::uint64_t> offset{};  ///< bytes from the start of the file
  std::string message{};                  ///< what was found and what was expected
  std::vector<Argument> arguments{};
  std::optional<std::string> pointer{};  ///< JSON pointer (RFC 6901) into the JSON encoding

  // place() and text() are one line, fit to print, whatever texts and keys the file has; the
  // members hold these as they are.
  /// "byte 128", a JSON pointer such as /tree/branches/2/label (empty: the whole), or "file".
  [[nodiscard]] std::string place() const;
  /// Message: "RADIUS_RANGE at byte 128 (/tree/radius/0): found -1, expected more than 0 mm".
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

/// The issues of one file.
using IssueList = FaultList<Issue>;
using IssueCounts = FaultCounts;

}  // namespace lumen::formats
