// SPDX-License-Identifier: Apache-2.0
#include "formats/container/issue.h"

#include <algorithm>

namespace lumen::formats {

std::string Issue::place() const {
  if (offset) return "byte " + std::to_string(*offset);
  return pointer.value_or("file");
}

std::string Issue::text() const {
  std::string where = place();
  if (where.empty()) where = "the root";
  if (offset && pointer && !pointer->empty()) where += " (" + *pointer + ")";
  return std::string(errorName(code)) + " at " + where + ": " + message;
}

Issue pointerIssue(ErrorCode code, std::string pointer, std::string message,
                   std::vector<Argument> arguments) {
  return {code, std::nullopt, std::move(message), std::move(arguments), std::move(pointer)};
}

Issue foundIssue(ErrorCode code, std::string pointer, const std::string& found,
                 const std::string& expected) {
  return pointerIssue(code, std::move(pointer), "found " + found + ", expected " + expected,
                      {{"found", found}, {"expected", expected}});
}

Issue limitIssue(ErrorCode code, std::string pointer, std::size_t found, std::size_t limit) {
  const std::string count = std::to_string(found), most = std::to_string(limit);
  return pointerIssue(code, std::move(pointer), "found " + count + ", the limit is " + most,
                      {{"found", count}, {"limit", most}});
}

std::optional<Issue> IssueList::firstError() const {
  const auto found = std::find_if(m_issues.begin(), m_issues.end(), [](const Issue& issue) {
    return severityOf(issue.code) == Severity::Error;
  });
  return found == m_issues.end() ? std::nullopt : std::optional<Issue>(*found);
}

}  // namespace lumen::formats
