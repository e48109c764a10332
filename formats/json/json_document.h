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

#include "formats/container/issue.h"
#include "formats/field/vec3f.h"
#include "formats/json/json_value.h"

namespace lumen::formats {

/// Numbers whose type is not known yet. They are kept as doubles, from which an f32 and an integer
/// of 32 bits follow exactly.
struct NumberTexts {
  std::vector<double> values;
  std::optional<std::size_t> firstReal;  ///< index of the first value with a point or an exponent
  void add(std::string_view text, bool whole);
};

/// A row of numbers, or of arrays of `width` numbers if that is more than 1, for each time of a
/// motion.
struct PoseRows {
  int width = 1;
  std::vector<float> values;        ///< of all rows
  std::vector<std::size_t> rowEnd;  ///< end of each row in `values`
};

/// Target of the numbers of one long array, which bypass the tree of values.
using NumberArray =
    std::variant<std::vector<Vec3f>*, std::vector<float>*, NumberTexts*, std::vector<std::int32_t>*,
                 std::vector<std::uint32_t>*, std::vector<std::array<std::uint32_t, 2>>*,
                 std::vector<double>*, PoseRows*>;

/// The long arrays two levels below the root, by JSON pointer ("/tree/centre"). `seen` is set for
/// those that the text has.
struct ArraySlot {
  NumberArray target;
  bool seen = false;
};
struct ArraySlots {
  std::map<std::string, ArraySlot, std::less<>> byPointer;
  /// The members of "/nodeArrays", whatever their names.
  std::map<std::string, NumberTexts, std::less<>> nodeArrays;
};

/// Parses strict JSON (json_text.h) without duplicate keys in an object, at most kMaxJsonDepth
/// levels deep. Arrays named in `slots` are filled and left out of the returned value; all other
/// numbers are legal whatever their size. Nothing is returned after an error. Errors of syntax are
/// placed from `byteOffset` on, others by JSON pointer after `root`.
std::optional<JsonDocument> parseJson(std::string_view text, std::size_t byteOffset,
                                      const std::string& root, ArraySlots& slots,
                                      IssueList& issues);
/// Parses strict JSON without long arrays; all else is as in the overload with slots.
std::optional<JsonDocument> parseJson(std::string_view text, std::size_t byteOffset,
                                      const std::string& root, IssueList& issues);

}  // namespace lumen::formats
