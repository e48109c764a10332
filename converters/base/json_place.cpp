// SPDX-License-Identifier: Apache-2.0
#include "converters/base/json_place.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "formats/case/json_document.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

using formats::printable;
using nlohmann::json;

/// A value as a message shows it.
std::string shown(const json& value) {
  if (value.is_array()) return "an array of " + std::to_string(value.size()) + " entries";
  if (value.is_object()) return "an object";
  if (value.is_string()) return quotedText(value.get_ref<const std::string&>());
  return value.dump();
}

/// The JSON pointer from `from` to the value at the address `to`; nothing if it is not below.
std::optional<std::string> pointerTo(const json& from, const json* to) {
  if (&from == to) return std::string();
  if (!from.is_structured()) return std::nullopt;
  for (const auto& [key, value] : from.items())
    if (const auto rest = pointerTo(value, to))
      return std::string("/").append(formats::jsonPointerToken(key)).append(*rest);
  return std::nullopt;
}

}  // namespace

json parseJson(const std::string& text, const std::filesystem::path& file) {
  formats::IssueList issues(1);
  formats::ArraySlots none;
  auto parsed = formats::parseJson(text, 0, "", none, issues);
  if (parsed) return *std::move(parsed);
  const formats::Issue issue = *issues.firstError();
  const std::string where = issue.pointer ? ": at \"" + *issue.pointer + "\": " : ": is not JSON: ";
  throw invalidInput(printable(file.string() + where + issue.message));
}

std::string JsonPlace::where() const {
  const std::string pointer = printable(pointerTo(m_file->root, m_value).value_or(""));
  return printable(m_file->name).append(": at \"").append(pointer).append("\"");
}

void JsonPlace::refuse(const std::string& expected) const {
  throw invalidInput(where() + ": found " + shown(*m_value) + "; expected " + expected);
}

void JsonPlace::onlyKeys(std::initializer_list<const char*> keys) const {
  if (!m_value->is_object()) refuse("an object");
  for (const auto& [key, value] : m_value->items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string known;
    for (const char* k : keys) known += (known.empty() ? "" : ", ") + std::string(k);
    throw invalidInput(JsonPlace(value, *m_file).where() + ": unknown key; expected one of " +
                       known);
  }
}

bool JsonPlace::has(const char* key) const {
  if (!m_value->is_object()) refuse("an object");
  return m_value->contains(key);
}

JsonPlace JsonPlace::at(const char* key) const {
  if (!has(key)) throw invalidInput(where() + ": the key \"" + key + "\" is missing");
  return {m_value->at(key), *m_file};
}

std::vector<JsonPlace> JsonPlace::elements() const {
  if (!m_value->is_array()) refuse("an array");
  std::vector<JsonPlace> all;
  all.reserve(m_value->size());
  for (const json& element : *m_value) all.emplace_back(element, *m_file);
  return all;
}

const std::string& JsonPlace::text() const {
  if (!m_value->is_string()) refuse("a string");
  return m_value->get_ref<const std::string&>();
}

double JsonPlace::number() const {
  if (!m_value->is_number()) refuse("a number");
  const auto number = m_value->get<double>();
  if (!std::isfinite(number)) refuse("a finite number");
  return number;
}

Eigen::Vector3d JsonPlace::vector() const {
  if (!m_value->is_array() || m_value->size() != 3) refuse("three numbers [x, y, z]");
  Eigen::Vector3d out;
  for (std::size_t a = 0; a < 3; ++a)
    out[static_cast<Eigen::Index>(a)] = JsonPlace((*m_value)[a], *m_file).number();
  return out;
}

}  // namespace lumen::convert
