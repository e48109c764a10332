// SPDX-License-Identifier: Apache-2.0
// Reading the members of JSON objects into fields, strictly.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/case/enum_names.h"
#include "formats/container/issue.h"
#include "formats/json/json_document.h"
#include "formats/json/json_place.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {

/// The issues of one text. Reading goes on after a fault, with defaults.
class JsonReadState final : public JsonFaults {
public:
  explicit JsonReadState(IssueList& list, bool known = true) : issues(list), fullyKnown(known) {}

  IssueList& issues;
  bool fullyKnown;  ///< false: unknown keys are those of a newer version and ignored

  void fail(ErrorCode code, std::string place, std::string message,
            std::vector<Argument> arguments = {}) {
    issues.add(pointerIssue(code, std::move(place), std::move(message), std::move(arguments)));
  }
  void wrongType(std::string place, JsonValue value, const std::string& expected) override {
    const std::string found = value.kind();
    fail(ErrorCode::JsonType, std::move(place), "found " + found + ", expected " + expected,
         {{"found", found}, {"expected", expected}});
  }
  void outOfRange(std::string place, JsonNumber number, const std::string& expected) override {
    const std::string found = number.shown();
    fail(ErrorCode::NumberRange, std::move(place), "found " + found + ", expected " + expected,
         {{"found", found}});
  }
  void missingKey(std::string place, std::string_view key) override {
    fail(ErrorCode::JsonKeyMissing, std::move(place),
         "the object has no \"" + std::string(key) + "\"", {{"key", std::string(key)}});
  }
};

/// One object. Every key must be asked for, start with "x-", or belong to a newer version.
class JsonFields {
public:
  JsonFields(JsonValue value, std::string place, JsonReadState& state);

  /// The member at `key`, which is known from then on.
  std::optional<JsonValue> find(std::string_view key);
  /// The member at `key`; JSON_KEY_MISSING without it.
  std::optional<JsonValue> require(std::string_view key);

  double real(std::string_view key);
  float single(std::string_view key);
  std::string text(std::string_view key) { return readText(key).value_or(std::string()); }
  bool boolean(std::string_view key);
  std::vector<std::string> texts(std::string_view key);
  void reals(std::string_view key, std::span<double> to);
  void counts(std::string_view key, std::span<std::uint32_t> to);

  template <class Integer>
  Integer integer(std::string_view key) {
    const auto place = requirePlace(key);
    return place ? place->integer<Integer>() : Integer{};
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

  [[nodiscard]] std::string placeOf(std::string_view key) const { return m_object.pointerTo(key); }
  [[nodiscard]] JsonReadState& state() const { return m_state; }

private:
  std::optional<std::string> readText(std::string_view key);
  std::optional<JsonPlace> requirePlace(std::string_view key);
  // The entries of the array at `key`; none unless there are exactly `size`.
  std::vector<JsonPlace> arrayOf(std::string_view key, std::size_t size);

  JsonPlace m_object;
  JsonReadState& m_state;
  std::vector<std::string_view> m_known;
};

/// Reports each of the long arrays that the text lacks.
void requireArrays(const ArraySlots& slots, std::initializer_list<std::string> pointers,
                   JsonReadState& state);

}  // namespace lumen::formats
