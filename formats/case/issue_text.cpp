// SPDX-License-Identifier: Apache-2.0
#include "formats/case/issue_text.h"

namespace lumen::formats {

std::string FormatError::text() const {
  std::string where = place.empty() ? "the root" : place;
  if (offset && pointer && !pointer->empty()) where += " (" + *pointer + ")";
  return code + " at " + where + ": " + message;
}

FormatError formatError(const Issue& issue) {
  const std::string place = issue.offset    ? "byte " + std::to_string(*issue.offset)
                            : issue.pointer ? *issue.pointer
                                            : "file";
  return {errorName(issue.code), place,        issue.message, severityOf(issue.code),
          issue.arguments,       issue.offset, issue.pointer};
}

FormatError fileError(ErrorCode code, const std::string& message) {
  return formatError({code, std::nullopt, message});
}

}  // namespace lumen::formats
