// SPDX-License-Identifier: Apache-2.0
// Reading the members of JSON objects into fields, strictly.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "formats/case/enum_names.h"
#include "formats/case/json_number.h"
#include "formats/container/issue.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {

/// Shared by all readers of one text. After a failure reads give defaults.
struct JsonReadState {
  IssueList& issues;
  bool fullyKnown = true;  ///< false: unknown keys are those of a newer version and ignored

  void fail(ErrorCode code, std::string place, std::string message,
            std::vector<Argument> arguments = {}) {
    issues.add(pointerIssue(code, std::move(place), std::move(message), std::move(arguments)));
  }
  void wrongType(std::string place, const nlohmann::json& value, const std::string& expected) {
    const std::string found = kindOf(value);
    fail(ErrorCode::JsonType, std::move(place), "found " + found + ", expected " + expected,
         {{"found", found}, {"expected", expected}});
  }
  void outOfRange(std::string place, const nlohmann::json& number, const std::string& expected) {
    const std::string found = numberText(number);
    fail(ErrorCode::NumberRange, std::move(place), "found " + found + ", expected " + expected,
         {{"found", found}});
  }
};

/// One object. Every key must be asked for, start with "x-", or belong to a newer version.
class JsonFields {
public:
  JsonFields(const nlohmann::json& value, std::string place, JsonReadState& state);

  /// The member, or nullptr; the key is known from then on.
  const nlohmann::json* find(std::string_view key);
  /// The member; JSON_KEY_MISSING without it.
  const nlohmann::json* require(std::string_view key);

  double real(std::string_view key);
  float single(std::string_view key);
  std::string text(std::string_view key) { return readText(key).value_or(std::string()); }
  bool boolean(std::string_view key);
  std::vector<std::string> texts(std::string_view key);
  void reals(std::string_view key, std::span<double> to);
  void counts(std::string_view key, std::span<std::uint32_t> to);

  template <class Integer>
  Integer integer(std::string_view key) {
    const nlohmann::json* value = require(key);
    return value == nullptr ? Integer{} : toInteger<Integer>(*value, placeOf(key));
  }

  template <class Enum>
  Enum enumeration(std::string_view key, std::span<const std::string_view> names) {
    const std::optional<std::string> name = readText(key);
    if (!name) return Enum{};
    if (const auto value = enumFromName<Enum>(names, *name)) return *value;
    const std::string found = name->substr(0, 80);
    std::string expected;
    for (const std::string_view known : names)
      expected.append(expected.empty() ? "" : ", ").append(known);
    m_state.fail(ErrorCode::EnumValue, placeOf(key),
                 "found \"" + found + "\", expected one of " + expected,
                 {{"found", found}, {"expected", expected}});
    return Enum{};
  }

  /// Reports the keys that nobody asked for. Call it last.
  void finish();

  [[nodiscard]] std::string placeOf(std::string_view key) const {
    return m_place + "/" + jsonPointerToken(key);
  }
  [[nodiscard]] JsonReadState& state() const { return m_state; }

private:
  std::optional<std::string> readText(std::string_view key);
  double toReal(const nlohmann::json& value, const std::string& place);

  template <class Integer>
  Integer toInteger(const nlohmann::json& value, const std::string& place) {
    if (!isNumber(value) || !isWhole(value)) {
      m_state.wrongType(place, value, "an integer, without point and exponent");
      return Integer{};
    }
    if (const auto number = asInteger<Integer>(value)) return *number;
    m_state.outOfRange(place, value,
                       "an integer from " + std::to_string(std::numeric_limits<Integer>::min()) +
                           " to " + std::to_string(std::numeric_limits<Integer>::max()));
    return Integer{};
  }

  // The array of exactly `size` values at `key`, or nullptr.
  const nlohmann::json* arrayOf(std::string_view key, std::size_t size);

  const nlohmann::json& m_object;
  std::string m_place;
  JsonReadState& m_state;
  std::vector<std::string_view> m_known;
};

}  // namespace lumen::formats
