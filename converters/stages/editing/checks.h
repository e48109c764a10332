// SPDX-License-Identifier: Apache-2.0
// Checks of the arguments of edits, and their wording in messages.
#pragma once

#include <cstdint>
#include <string>

#include "formats/case/case.h"

namespace lumen::convert {

/// mm: positions and lengths beyond are implausible in a patient, and their squares still fit a float.
constexpr double kFarthest = 1e6;

/// Throw Error(InvalidInput) for an index out of range.
void requireBranch(const formats::Case& value, std::uint32_t branch);
void requireNode(const formats::Case& value, std::uint32_t node);

/// Throws Error(InvalidInput) for a text that is no label, or is the label of a branch other than
/// `branch`.
void requireLabel(const formats::Case& value, const std::string& label, std::uint32_t branch);

/// The label of a branch, in quotation marks, fit to print.
std::string quoted(const formats::Case& value, std::uint32_t branch);
std::string quoted(const std::string& label);

/// "node 3 of "ica"", counted from 1 within its branch.
std::string nodeText(const formats::Case& value, std::uint32_t node);

}  // namespace lumen::convert
