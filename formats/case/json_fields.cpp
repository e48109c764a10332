// SPDX-License-Identifier: Apache-2.0
#include "formats/case/json_fields.h"

namespace lumen::formats {

using nlohmann::json;

JsonFields::JsonFields(const json& value, std::string place, JsonReadState& state)
    : m_object(value), m_place(std::move(place)), m_state(state) {
  if (!value.is_object()) m_state.wrongType(m_place, value, "an object");
}

const json* JsonFields::find(std::string_view key) {
  m_known.push_back(key);
  if (!m_object.is_object()) return nullptr;
  const auto found = m_object.find(key);
  return found == m_object.end() ? nullptr : &*found;
}

const json* JsonFields::require(std::string_view key) {
  const json* value = find(key);
  if (value == nullptr && m_object.is_object())
    m_state.fail(ErrorCode::JsonKeyMissing, m_place,
                 "the object has no \"" + std::string(key) + "\"", {{"key", std::string(key)}});
  return value;
}

double JsonFields::toReal(const json& value, const std::string& place) {
  if (!isNumber(value)) {
    m_state.wrongType(place, value, "a number");
    return 0.0;
  }
  const auto number = asDouble(value);
  if (!number) m_state.outOfRange(place, value, "a number that rounds to an f64");
  return number.value_or(0.0);
}

double JsonFields::real(std::string_view key) {
  const json* value = require(key);
  return value == nullptr ? 0.0 : toReal(*value, placeOf(key));
}

float JsonFields::single(std::string_view key) {
  const json* value = require(key);
  if (value == nullptr) return 0.0f;
  if (!isNumber(*value)) {
    m_state.wrongType(placeOf(key), *value, "a number");
    return 0.0f;
  }
  const auto number = asFloat(*value);
  if (!number) m_state.outOfRange(placeOf(key), *value, "a number that rounds to an f32");
  return number.value_or(0.0f);
}

std::optional<std::string> JsonFields::readText(std::string_view key) {
  const json* value = require(key);
  if (value == nullptr) return std::nullopt;
  if (value->is_string()) return value->get<std::string>();
  m_state.wrongType(placeOf(key), *value, "a string");
  return std::nullopt;
}

bool JsonFields::boolean(std::string_view key) {
  const json* value = require(key);
  if (value == nullptr) return false;
  if (value->is_boolean()) return value->get<bool>();
  m_state.wrongType(placeOf(key), *value, "a boolean");
  return false;
}

std::vector<std::string> JsonFields::texts(std::string_view key) {
  std::vector<std::string> result;
  const json* values = require(key);
  if (values == nullptr) return result;
  if (!values->is_array()) {
    m_state.wrongType(placeOf(key), *values, "an array of strings");
    return result;
  }
  for (const json& value : *values) {
    if (!value.is_string())
      m_state.wrongType(placeOf(key) + "/" + std::to_string(result.size()), value, "a string");
    result.push_back(value.is_string() ? value.get<std::string>() : std::string());
  }
  return result;
}

const json* JsonFields::arrayOf(std::string_view key, std::size_t size) {
  const json* value = require(key);
  if (value == nullptr) return nullptr;
  if (value->is_array() && value->size() == size) return value;
  const std::string found =
      value->is_array() ? "an array of " + std::to_string(value->size()) : kindOf(*value);
  const std::string expected = "an array of " + std::to_string(size) + " numbers";
  m_state.fail(ErrorCode::JsonType, placeOf(key), "found " + found + ", expected " + expected,
               {{"found", found}, {"expected", expected}});
  return nullptr;
}

void JsonFields::reals(std::string_view key, std::span<double> to) {
  if (const json* values = arrayOf(key, to.size()))
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = toReal((*values)[i], placeOf(key) + "/" + std::to_string(i));
}

void JsonFields::counts(std::string_view key, std::span<std::uint32_t> to) {
  if (const json* values = arrayOf(key, to.size()))
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = toInteger<std::uint32_t>((*values)[i], placeOf(key) + "/" + std::to_string(i));
}

void JsonFields::finish() {
  if (!m_state.fullyKnown || !m_object.is_object()) return;
  for (const auto& [key, value] : m_object.items())
    if (!key.starts_with("x-") && std::find(m_known.begin(), m_known.end(), key) == m_known.end())
      m_state.fail(ErrorCode::JsonKeyUnknown, placeOf(key.substr(0, 80)),
                   "the format does not define this key; keys of others start with \"x-\"",
                   {{"key", key.substr(0, 80)}});
}

}  // namespace lumen::formats
