// SPDX-License-Identifier: Apache-2.0
// A JSON text that was read strictly, and the values in it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "formats/json/json_number.h"

namespace lumen::formats {

struct JsonMember;

/// A value of a JsonDocument, which must outlive it. Copies are cheap. A number can be read as a
/// JsonNumber alone.
class JsonValue {
public:
  explicit JsonValue(const nlohmann::json& value) : m_value(&value) {}

  /// "array", "boolean", "null", "number", "object" or "string".
  [[nodiscard]] const char* kind() const;
  [[nodiscard]] bool isNull() const;
  [[nodiscard]] bool isArray() const;
  [[nodiscard]] bool isObject() const;

  /// The value as a type of C++; nothing, or null, for a value of another kind.
  [[nodiscard]] std::optional<bool> boolean() const;
  [[nodiscard]] std::optional<JsonNumber> number() const;
  [[nodiscard]] const std::string* text() const;

  /// True for the string `text`, and for the integer `number`.
  [[nodiscard]] bool is(std::string_view text) const;
  [[nodiscard]] bool is(int number) const;

  /// The number of entries of an array; 0 for a value of another kind.
  [[nodiscard]] std::size_t arraySize() const;
  /// An entry of an array; `index` is below arraySize().
  [[nodiscard]] JsonValue operator[](std::size_t index) const;
  /// A member of an object; nothing for a missing key, and for a value of another kind.
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;
  /// The entries of an array, and none of a value of another kind.
  [[nodiscard]] std::vector<JsonValue> entries() const;
  /// The members of an object in the order of their keys, and none of a value of another kind.
  [[nodiscard]] std::vector<JsonMember> members() const;

private:
  const nlohmann::json* m_value;
};

struct JsonMember {
  std::string_view key;
  JsonValue value;
};

/// Owner of the values of a text.
class JsonDocument {
public:
  explicit JsonDocument(nlohmann::json root);
  JsonDocument(JsonDocument&&) noexcept;
  JsonDocument& operator=(JsonDocument&&) noexcept;
  ~JsonDocument();

  [[nodiscard]] JsonValue root() const { return JsonValue(*m_root); }

private:
  std::unique_ptr<const nlohmann::json> m_root;
};

}  // namespace lumen::formats
