// SPDX-License-Identifier: Apache-2.0
// JSON text to values, with the strictness that the format asks for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "formats/case/case.h"
#include "formats/container/issue.h"

namespace lumen::formats {

/// Where the numbers of one long array go, without a tree of values in between.
using NumberArray = std::variant<std::vector<Vec3f>*, std::vector<float>*, std::vector<double>*,
                                 std::vector<std::int32_t>*, std::vector<std::uint32_t>*,
                                 std::vector<std::array<std::uint32_t, 2>>*>;

/// The long arrays two levels below the root, by JSON pointer ("/tree/centre"). `seen` is set for
/// those that the text has.
struct ArraySlot {
  NumberArray target;
  bool seen = false;
};
struct ArraySlots {
  std::map<std::string, ArraySlot, std::less<>> byPointer;
  /// The members of "/nodeArrays", whatever their names.
  std::map<std::string, std::vector<double>, std::less<>> nodeArrays;
};

/// Parses strict JSON: UTF-8, no byte order mark, no zero byte, no duplicate key in an object, at
/// most kMaxJsonDepth levels, numbers in the range of their type. Arrays named in `slots` are
/// filled and left out of the returned value. Nothing is returned after an error, which is placed
/// from `byteOffset` on if it is one of syntax, and by JSON pointer after `root` otherwise.
std::optional<nlohmann::json> parseJson(std::string_view text, std::size_t byteOffset,
                                        const std::string& root, ArraySlots& slots,
                                        IssueList& issues);

/// The float that a double read from text stands for. Going through the shortest decimal avoids
/// rounding twice: it is the text itself if that had up to 15 digits.
float floatFromParsed(double value);

}  // namespace lumen::formats
