// SPDX-License-Identifier: Apache-2.0
#include "formats/container/issue.h"

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

}  // namespace lumen::formats
