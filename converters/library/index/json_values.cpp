// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/json_values.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "converters/base/error.h"
#include "converters/library/index/record.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {

namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

bool isHex(char c) {
  return isDigit(c) || (c >= 'a' && c <= 'f');
}

int number(std::string_view digits) {
  int value = 0;
  for (const char c : digits) value = value * 10 + (c - '0');
  return value;
}

}  // namespace

std::string plainText(const JsonPlace& place, std::size_t most, std::size_t least) {
  const std::string& text = place.text();
  if (formats::checkText(text, most, "") || text.size() < least)
    place.refuse("a text of " + std::to_string(least) + " to " + std::to_string(most) +
                 " bytes of UTF-8 without control characters");
  return text;
}

std::uint64_t wholeNumber(const JsonPlace& place, std::uint64_t least, std::uint64_t most) {
  const auto number = place.value().number();
  const auto value = number ? number->asInteger<std::uint64_t>() : std::nullopt;
  if (!value || *value < least || *value > most)
    place.refuse("a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return *value;
}

double notNegative(const JsonPlace& place) {
  const double value = place.number();
  if (value < 0) place.refuse("a number of at least 0");
  return value;
}

double positive(const JsonPlace& place) {
  const double value = place.number();
  if (value <= 0) place.refuse("a number above 0");
  return value;
}

std::string readWord(const JsonPlace& place, std::initializer_list<const char*> words) {
  const std::string& text = place.text();
  if (std::find(words.begin(), words.end(), text) != words.end()) return text;
  std::string expected = "one of ";
  for (const char* word : words)
    expected += (word == *words.begin() ? "\"" : ", \"") + std::string(word) + "\"";
  place.refuse(expected);
}

std::string digest(const JsonPlace& place) {
  const std::string& text = place.text();
  if (text.size() != 64 || !std::all_of(text.begin(), text.end(), isHex))
    place.refuse("a SHA-256 of 64 lower-case hexadecimal digits");
  return text;
}

std::string day(const JsonPlace& place) {
  if (!isDay(place.text())) place.refuse("a date such as \"2026-11-22\"");
  return place.text();
}

std::string caseId(const JsonPlace& place) {
  if (!isCaseId(place.text()))
    place.refuse("an id of 1 to 64 of a to z, 0 to 9 and -, not beginning with -");
  return place.text();
}

bool isDay(std::string_view text) {
  if (text.size() != 10) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (i == 4 || i == 7 ? text[i] != '-' : !isDigit(text[i])) return false;
  using namespace std::chrono;
  return (year(number(text.substr(0, 4))) /
          month(static_cast<unsigned>(number(text.substr(5, 2)))) /
          std::chrono::day(static_cast<unsigned>(number(text.substr(8)))))
      .ok();
}

bool isUuid(std::string_view text) {
  if (text.size() != 36) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool isHyphen = i == 8 || i == 13 || i == 18 || i == 23;
    if (isHyphen ? text[i] != '-' : !isHex(text[i])) return false;
  }
  return true;
}

void requireFormat(const JsonPlace& root, const char* name) {
  if (const JsonPlace format = root.at("format"); format.text() != name)
    format.refuse("\"" + std::string(name) + "\"");
  const JsonPlace version = root.at("formatVersion");
  if (!version.value().is(kLibraryFormat))
    version.refuse(std::to_string(kLibraryFormat) + ", the only version that this lumen reads");
}

}  // namespace lumen::convert
