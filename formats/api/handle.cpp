// SPDX-License-Identifier: Apache-2.0
#include "formats/api/handle.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

#include "formats/container/error_code.h"

namespace lumen::formats::api {
namespace {

// Copies a text, and cuts it off before a character of UTF-8 that does not fit.
void copyText(std::span<char> target, std::string_view text) {
  std::size_t size = std::min(text.size(), target.size() - 1);
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  if (size < text.size())
    while (size > 0 && continues(text[size])) --size;
  std::copy_n(text.begin(), size, target.begin());
  target[size] = '\0';
}

lumen_case_status statusOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::IoMissing:
    case ErrorCode::IoNotAFile:
    case ErrorCode::IoEmpty:
    case ErrorCode::IoRead:
      return LUMEN_CASE_ERROR_FILE;
    case ErrorCode::IoWrite:
      return LUMEN_CASE_ERROR_WRITE;
    case ErrorCode::ViewMemory:
      return LUMEN_CASE_ERROR_MEMORY;
    default:
      return LUMEN_CASE_ERROR_RULE;
  }
}

}  // namespace

lumen_case_fault faultOf(const Issue& issue, std::string_view prefix) {
  lumen_case_fault fault{};
  fault.code = static_cast<std::int32_t>(issue.code);
  fault.severity = static_cast<lumen_case_severity>(severityOf(issue.code));
  copyText(fault.name, errorName(issue.code));
  copyText(fault.place, issue.place());
  copyText(fault.message, std::string(prefix) + issue.text());
  return fault;
}

lumen_case_status refuse(lumen_case_fault* fault, lumen_case_status status,
                         std::string_view sentence) {
  if (fault) {
    *fault = {};
    copyText(fault->message, sentence);
  }
  return status;
}

lumen_case_status refuseArgument(lumen_case_fault* fault, std::string_view sentence) {
  return refuse(fault, LUMEN_CASE_ERROR_ARGUMENT, sentence);
}

lumen_case_status refuse(lumen_case_fault* fault, const Issue& issue, std::string_view prefix) {
  if (fault) *fault = faultOf(issue, prefix);
  return statusOf(issue.code);
}

}  // namespace lumen::formats::api
