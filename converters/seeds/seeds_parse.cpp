// SPDX-License-Identifier: Apache-2.0
#include "converters/seeds/seeds_parse.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "converters/common/error.h"
#include "formats/case/json_document.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

using nlohmann::json;

/// A value as a message shows it.
std::string shown(const json& value) {
  if (value.is_array()) return "an array of " + std::to_string(value.size()) + " entries";
  if (value.is_object()) return "an object";
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

}  // namespace

json parseJson(const std::string& text, const std::filesystem::path& file) {
  formats::IssueList issues(1);
  formats::ArraySlots none;
  auto parsed = formats::parseJson(text, 0, "", none, issues);
  if (parsed) return *std::move(parsed);
  const formats::Issue issue = *issues.firstError();
  const std::string where = issue.pointer ? ": at \"" + *issue.pointer + "\": " : ": is not JSON: ";
  throw invalidInput(file.string() + where + issue.message);
}

void JsonPlace::refuse(const std::string& expected) const {
  throw invalidInput(m_file + ": at \"" + m_pointer + "\": found " + shown(*m_value) +
                     "; expected " + expected);
}

void JsonPlace::onlyKeys(std::initializer_list<const char*> keys) const {
  if (!m_value->is_object()) refuse("an object");
  for (const auto& [key, value] : m_value->items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string known;
    for (const char* k : keys) known += (known.empty() ? "" : ", ") + std::string(k);
    throw invalidInput(m_file + ": at \"" + m_pointer + "/" + formats::jsonPointerToken(key) +
                       "\": unknown key; expected one of " + known);
  }
}

bool JsonPlace::has(const std::string& key) const {
  if (!m_value->is_object()) refuse("an object");
  return m_value->contains(key);
}

JsonPlace JsonPlace::at(const std::string& key) const {
  if (!has(key))
    throw invalidInput(m_file + ": at \"" + m_pointer + "\": the key \"" + key + "\" is missing");
  return {m_value->at(key), m_file, m_pointer + "/" + formats::jsonPointerToken(key)};
}

std::vector<JsonPlace> JsonPlace::elements() const {
  if (!m_value->is_array()) refuse("an array");
  std::vector<JsonPlace> all;
  for (std::size_t i = 0; i < m_value->size(); ++i)
    all.emplace_back((*m_value)[i], m_file, m_pointer + "/" + std::to_string(i));
  return all;
}

std::string JsonPlace::text() const {
  if (!m_value->is_string()) refuse("a string");
  return m_value->get<std::string>();
}

double JsonPlace::number() const {
  if (!m_value->is_number()) refuse("a number");
  const auto number = m_value->get<double>();
  if (!std::isfinite(number)) refuse("a finite number");
  return number;
}

Eigen::Vector3d JsonPlace::vector() const {
  if (!m_value->is_array() || m_value->size() != 3) refuse("three numbers [x, y, z]");
  const auto xyz = elements();
  return {xyz[0].number(), xyz[1].number(), xyz[2].number()};
}

double scaleOf(const JsonPlace& unit) {
  const std::string word = unit.text();
  if (word == "mm") return 1;
  if (word == "m") return 1000;
  unit.refuse("\"mm\" or \"m\"");
}

std::optional<formats::BranchKind> branchKind(const std::string& word) {
  if (word == "vessel") return formats::BranchKind::Vessel;
  if (word == "aneurysm") return formats::BranchKind::Aneurysm;
  return std::nullopt;
}

}  // namespace lumen::convert
