// SPDX-License-Identifier: Apache-2.0
#include "formats/case/json_fields.h"

namespace lumen::formats {

JsonFields::JsonFields(JsonValue value, std::string place, JsonReadState& state)
    : m_object(value, state, std::move(place)), m_state(state) {
  if (!value.isObject()) m_state.wrongType(m_object.pointer(), value, "an object");
}

std::optional<JsonValue> JsonFields::find(std::string_view key) {
  m_known.push_back(key);
  return m_object.value().find(key);
}

std::optional<JsonValue> JsonFields::require(std::string_view key) {
  const auto value = find(key);
  if (!value && m_object.value().isObject()) m_state.missingKey(m_object.pointer(), key);
  return value;
}

std::optional<JsonPlace> JsonFields::requirePlace(std::string_view key) {
  const auto value = require(key);
  return value ? std::optional(JsonPlace(*value, m_state, placeOf(key))) : std::nullopt;
}

double JsonFields::real(std::string_view key) {
  const auto place = requirePlace(key);
  return place ? place->real() : 0.0;
}

float JsonFields::single(std::string_view key) {
  const auto place = requirePlace(key);
  return place ? place->single() : 0.0f;
}

std::optional<std::string> JsonFields::readText(std::string_view key) {
  const auto place = requirePlace(key);
  const std::string* const text = place ? place->text() : nullptr;
  return text == nullptr ? std::nullopt : std::optional(*text);
}

bool JsonFields::boolean(std::string_view key) {
  const auto place = requirePlace(key);
  return place && place->boolean();
}

std::vector<std::string> JsonFields::texts(std::string_view key) {
  std::vector<std::string> result;
  const auto place = requirePlace(key);
  if (!place) return result;
  if (!place->value().isArray())
    m_state.wrongType(place->pointer(), place->value(), "an array of strings");
  for (std::size_t i = 0; i < place->value().arraySize(); ++i) {
    const std::string* const text = place->entry(i).text();
    result.push_back(text == nullptr ? std::string() : *text);
  }
  return result;
}

std::vector<JsonPlace> JsonFields::arrayOf(std::string_view key, std::size_t size) {
  const auto place = requirePlace(key);
  if (!place) return {};
  const JsonValue& value = place->value();
  if (value.isArray() && value.arraySize() == size) return place->entries();
  const std::string found =
      value.isArray() ? "an array of " + std::to_string(value.arraySize()) : value.kind();
  const std::string expected = "an array of " + std::to_string(size) + " numbers";
  m_state.fail(ErrorCode::JsonType, place->pointer(), "found " + found + ", expected " + expected,
               {{"found", found}, {"expected", expected}});
  return {};
}

void JsonFields::reals(std::string_view key, std::span<double> to) {
  auto next = to.begin();
  for (const JsonPlace& entry : arrayOf(key, to.size())) *next++ = entry.real();
}

void JsonFields::counts(std::string_view key, std::span<std::uint32_t> to) {
  auto next = to.begin();
  for (const JsonPlace& entry : arrayOf(key, to.size())) *next++ = entry.integer<std::uint32_t>();
}

void JsonFields::finish() {
  if (!m_state.fullyKnown) return;
  for (const auto& [name, value] : m_object.value().members()) {
    const std::string key(name);
    if (key.starts_with("x-") || std::find(m_known.begin(), m_known.end(), key) != m_known.end())
      continue;
    m_state.fail(ErrorCode::JsonKeyUnknown, placeOf(key.substr(0, 80)),
                 "the format does not define this key; keys of others start with \"x-\"",
                 {{"key", key.substr(0, 80)}});
  }
}

void requireArrays(const ArraySlots& slots, std::initializer_list<std::string> pointers,
                   JsonReadState& state) {
  for (const std::string& pointer : pointers)
    if (!slots.byPointer.find(pointer)->second.seen) {
      const std::size_t slash = pointer.rfind('/');
      const std::string key = pointer.substr(slash + 1);
      state.fail(ErrorCode::JsonKeyMissing, pointer.substr(0, slash),
                 "the object has no \"" + key + "\"", {{"key", key}});
    }
}

}  // namespace lumen::formats
