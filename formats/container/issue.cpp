// SPDX-License-Identifier: Apache-2.0
#include "formats/container/issue.h"

#include <iterator>

#include "formats/container/printable.h"

namespace lumen::formats {

std::string Issue::place() const {
  if (offset) return "byte " + std::to_string(*offset);
  return printable(pointer.value_or("file"));
}

std::string Issue::text() const {
  std::string where = place();
  if (where.empty()) where = "the root";
  if (offset && pointer && !pointer->empty()) where += " (" + printable(*pointer) + ")";
  return std::string(errorName(code)) + " at " + where + ": " + printable(message);
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

bool IssueList::count(ErrorCode code) {
  const Severity severity = severityOf(code);
  if (severity == Severity::Error) {
    ++m_counts.errors;
    return m_errors.size() < m_maximum;
  }
  if (m_keep == Keep::Errors) return false;
  ++(severity == Severity::Warning ? m_counts.warnings : m_counts.information);
  return m_errors.size() + m_others.size() < m_maximum;
}

void IssueList::keep(Issue issue) {
  const bool isError = severityOf(issue.code) == Severity::Error;
  if (isError && m_errors.size() + m_others.size() == m_maximum) m_others.pop_back();
  (isError ? m_errors : m_others).push_back(std::move(issue));
}

std::optional<Issue> IssueList::firstError() const {
  return m_errors.empty() ? std::nullopt : std::optional<Issue>(m_errors.front());
}

std::vector<Issue> IssueList::take() {
  std::vector<Issue> issues = std::move(m_errors);
  issues.insert(issues.end(), std::make_move_iterator(m_others.begin()),
                std::make_move_iterator(m_others.end()));
  m_errors.clear();
  m_others.clear();
  return issues;
}

}  // namespace lumen::formats
