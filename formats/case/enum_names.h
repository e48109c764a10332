// SPDX-License-Identifier: Apache-2.0
// The names that enumerations have in JSON, in the order of their stored values.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "formats/case/case.h"
#include "formats/view/model_rules.h"

namespace lumen::formats {

inline constexpr std::array<std::string_view, 2> kBranchKindNames = {"vessel", "aneurysm"};
inline constexpr std::array<std::string_view, 7> kStopReasonNames = {
    "unknown",    "no-valid-cylinder", "turned-back", "left-volume",
    "met-branch", "end-of-seeds",      "step-limit"};
static_assert(kBranchKindNames.size() == kBranchKindCount);
static_assert(kStopReasonNames.size() == kStopReasonCount);
using field::kKernelNames;
/// Names of the value types of node arrays, in the order of the variant in NodeArray.
inline constexpr std::array<std::string_view, 3> kArrayTypeNames = {"f32", "i32", "u32"};

/// The value whose name is `name`.
template <class Enum>
std::optional<Enum> enumFromName(std::span<const std::string_view> names, std::string_view name) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Enum>(i);
  return std::nullopt;
}

/// The name of a legal value; empty for any other.
template <class Enum>
std::string_view enumName(std::span<const std::string_view> names, Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < names.size() ? names[i] : std::string_view{};
}

}  // namespace lumen::formats
