// SPDX-License-Identifier: Apache-2.0
// What edits are asked for, checked, and how it is said to people.
#pragma once

#include <cstdint>
#include <string>

#include "formats/case/case.h"

namespace lumen::convert {

/// Throw Error(InvalidInput) for an index that is none.
void requireBranch(const formats::Case& value, std::uint32_t branch);
void requireNode(const formats::Case& value, std::uint32_t node);

/// Throws Error(InvalidInput) for a text that is no label, or another branch's than `branch`.
void requireLabel(const formats::Case& value, const std::string& label, std::uint32_t branch);

/// The label of a branch, in quotation marks, fit to print.
std::string quoted(const formats::Case& value, std::uint32_t branch);
std::string quoted(const std::string& label);

/// "node 3 of "ica"", counted from 1 within its branch.
std::string nodeText(const formats::Case& value, std::uint32_t node);

}  // namespace lumen::convert
