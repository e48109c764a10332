// SPDX-License-Identifier: Apache-2.0
// From the issues that checks collect to what callers get.
#pragma once

#include <string>

#include "formats/case/case_file.h"
#include "formats/container/issue.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {

FormatError formatError(const Issue& issue);

/// Of a rule about files rather than about their bytes.
FormatError fileError(ErrorCode code, const std::string& message);

/// An issue with a JSON pointer.
inline Issue pointerIssue(ErrorCode code, std::string pointer, std::string message,
                          std::vector<Argument> arguments = {}) {
  return {code, std::nullopt, std::move(message), std::move(arguments), std::move(pointer)};
}

}  // namespace lumen::formats
