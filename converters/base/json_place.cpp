// SPDX-License-Identifier: Apache-2.0
#include "converters/base/json_place.h"

#include "converters/base/shown_text.h"
#include "formats/container/printable.h"
#include "formats/json/json_document.h"

namespace lumen::convert {
namespace {

using formats::JsonNumber;
using formats::JsonValue;
using formats::printable;

/// A value as shown in a message.
std::string shown(const JsonValue& value) {
  if (value.isArray()) return "an array of " + std::to_string(value.arraySize()) + " entries";
  if (value.isObject()) return "an object";
  if (value.text() != nullptr) return quotedText(*value.text());
  if (const auto number = value.number()) return number->shown();
  if (const auto truth = value.boolean()) return *truth ? "true" : "false";
  return "null";
}

formats::JsonDocument documentOf(std::string_view text, const std::filesystem::path& file) {
  formats::IssueList issues(1);
  auto parsed = formats::parseJson(text, 0, "", issues);
  if (parsed) return *std::move(parsed);
  const formats::Issue issue = *issues.firstError();
  const std::string where = issue.pointer ? ": at \"" + *issue.pointer + "\": " : ": is not JSON: ";
  throw invalidInput(printable(file.string() + where + issue.message));
}

}  // namespace

JsonFile::JsonFile(std::string_view text, const std::filesystem::path& file)
    : m_name(printable(file.string())), m_document(documentOf(text, file)) {}

std::string JsonFile::place(const std::string& pointer) const {
  return m_name + ": at \"" + printable(pointer) + "\"";
}

Error JsonFile::fault(const std::string& pointer, JsonValue found,
                      const std::string& expected) const {
  return invalidInput(place(pointer) + ": found " + shown(found) + "; expected " + expected);
}

void JsonFile::wrongType(std::string pointer, JsonValue found, const std::string& expected) {
  throw fault(pointer, found, expected);
}

void JsonFile::outOfRange(std::string pointer, JsonNumber found, const std::string& expected) {
  throw invalidInput(place(pointer) + ": found " + found.shown() + "; expected " + expected);
}

void JsonFile::missingKey(std::string objectPointer, std::string_view key) {
  throw invalidInput(place(objectPointer) + ": the key \"" + std::string(key) + "\" is missing");
}

void JsonPlace::refuse(const std::string& expected) const {
  throw m_file->fault(m_place.pointer(), value(), expected);
}

void JsonPlace::onlyKeys(std::initializer_list<const char*> keys) const {
  const auto other = m_place.otherThan(keys);
  if (!other) return;
  std::string known;
  for (const char* key : keys) known += (known.empty() ? "" : ", ") + std::string(key);
  throw invalidInput(m_file->place(other->pointer()) + ": unknown key; expected one of " + known);
}

JsonPlace JsonPlace::at(std::string_view key) const {
  return {*m_place.require(key), *m_file};
}

std::vector<JsonPlace> JsonPlace::elements() const {
  std::vector<JsonPlace> all;
  for (formats::JsonPlace& entry : m_place.entries())
    all.push_back(JsonPlace(std::move(entry), *m_file));
  return all;
}

Eigen::Vector3d JsonPlace::vector() const {
  Eigen::Vector3d numbers;
  m_place.reals(std::span(numbers.data(), 3), "three numbers [x, y, z]");
  return numbers;
}

}  // namespace lumen::convert
