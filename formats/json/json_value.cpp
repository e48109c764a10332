// SPDX-License-Identifier: Apache-2.0
#include "formats/json/json_value.h"

#include <nlohmann/json.hpp>

namespace lumen::formats {

namespace {

using Json = nlohmann::json;

}  // namespace

JsonDocument::JsonDocument(Json root) : m_root(std::make_unique<Json>(std::move(root))) {}
JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;
JsonDocument& JsonDocument::operator=(JsonDocument&&) noexcept = default;
JsonDocument::~JsonDocument() = default;

const char* JsonValue::kind() const {
  return number() ? "number" : m_value->type_name();
}

bool JsonValue::isNull() const {
  return m_value->is_null();
}
bool JsonValue::isArray() const {
  return m_value->is_array();
}
bool JsonValue::isObject() const {
  return m_value->is_object();
}

std::optional<bool> JsonValue::boolean() const {
  const bool* const value = m_value->get_ptr<const bool*>();
  return value == nullptr ? std::nullopt : std::optional(*value);
}

std::optional<JsonNumber> JsonValue::number() const {
  if (const auto* whole = m_value->get_ptr<const std::int64_t*>()) return JsonNumber(*whole);
  if (const auto* real = m_value->get_ptr<const double*>()) return JsonNumber(*real);
  const auto* bytes = m_value->get_ptr<const Json::binary_t*>();
  if (bytes == nullptr) return std::nullopt;
  return JsonNumber(std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
}

const std::string* JsonValue::text() const {
  return m_value->get_ptr<const std::string*>();
}

bool JsonValue::is(std::string_view expected) const {
  return text() != nullptr && *text() == expected;
}

bool JsonValue::is(int expected) const {
  const auto found = number();
  return found && found->asInteger<int>() == expected;
}

std::size_t JsonValue::arraySize() const {
  return m_value->is_array() ? m_value->size() : 0;
}

JsonValue JsonValue::operator[](std::size_t index) const {
  return JsonValue((*m_value)[index]);
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  if (!m_value->is_object()) return std::nullopt;
  const auto found = m_value->find(key);
  return found == m_value->end() ? std::nullopt : std::optional(JsonValue(*found));
}

std::vector<JsonValue> JsonValue::entries() const {
  if (!m_value->is_array()) return {};
  std::vector<JsonValue> all;
  all.reserve(m_value->size());
  for (const Json& entry : *m_value) all.emplace_back(entry);
  return all;
}

std::vector<JsonMember> JsonValue::members() const {
  if (!m_value->is_object()) return {};
  std::vector<JsonMember> all;
  all.reserve(m_value->size());
  for (const auto& [key, value] : m_value->items()) all.push_back({key, JsonValue(value)});
  return all;
}

}  // namespace lumen::formats
