// SPDX-License-Identifier: Apache-2.0
#include "formats/json/json_place.h"

#include <algorithm>

#include "formats/view/text_rules.h"

namespace lumen::formats {

std::string JsonPlace::pointerTo(std::string_view token) const {
  return m_pointer + "/" + jsonPointerToken(token);
}

std::optional<JsonPlace> JsonPlace::find(std::string_view key) const {
  if (!m_value.isObject()) wrongType("an object");
  const auto found = m_value.find(key);
  return found ? std::optional(below(*found, key)) : std::nullopt;
}

std::optional<JsonPlace> JsonPlace::require(std::string_view key) const {
  auto found = find(key);
  if (!found && m_value.isObject()) m_faults->missingKey(m_pointer, key);
  return found;
}

std::vector<JsonPlace> JsonPlace::entries(const std::string& expected) const {
  if (!m_value.isArray()) wrongType(expected);
  std::vector<JsonPlace> all;
  all.reserve(m_value.arraySize());
  for (std::size_t i = 0; i < m_value.arraySize(); ++i) all.push_back(entry(i));
  return all;
}

std::optional<JsonPlace> JsonPlace::otherThan(std::initializer_list<const char*> known) const {
  if (!m_value.isObject()) wrongType("an object");
  for (const auto& [key, value] : m_value.members())
    if (std::find(known.begin(), known.end(), key) == known.end()) return below(value, key);
  return std::nullopt;
}

double JsonPlace::real(const std::string& expected) const {
  const auto number = m_value.number();
  if (!number) {
    wrongType(expected);
    return 0;
  }
  const auto value = number->asDouble();
  if (!value) m_faults->outOfRange(m_pointer, *number, "a number that rounds to an f64");
  return value.value_or(0);
}

float JsonPlace::single() const {
  const auto number = m_value.number();
  if (!number) {
    wrongType("a number");
    return 0;
  }
  const auto value = number->asFloat();
  if (!value) m_faults->outOfRange(m_pointer, *number, "a number that rounds to an f32");
  return value.value_or(0.0f);
}

bool JsonPlace::boolean(const std::string& expected) const {
  const auto value = m_value.boolean();
  if (!value) wrongType(expected);
  return value.value_or(false);
}

const std::string* JsonPlace::text(const std::string& expected) const {
  const std::string* const value = m_value.text();
  if (value == nullptr) wrongType(expected);
  return value;
}

void JsonPlace::reals(std::span<double> to, const std::string& expected) const {
  if (!m_value.isArray() || m_value.arraySize() != to.size()) return wrongType(expected);
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = entry(i).real();
}

}  // namespace lumen::formats
