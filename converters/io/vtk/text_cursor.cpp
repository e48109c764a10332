// SPDX-License-Identifier: Apache-2.0
#include "converters/io/vtk/text_cursor.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "converters/base/error.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"

namespace lumen::convert {
namespace {

std::string foundText(const char* what, std::string_view word) {
  return std::string(what) +
         (word.empty() ? " is missing" : " is " + quotedText(std::string(word)));
}

}  // namespace

std::string_view TextCursor::restOfLine() {
  skipSpace(false);
  const std::size_t from = m_at;
  m_at = std::min(m_text.find_first_of("\r\n", m_at), m_text.size());
  std::string_view rest = m_text.substr(from, m_at - from);
  if (m_at < m_text.size()) endLine();
  while (!rest.empty() && (rest.back() == ' ' || rest.back() == '\t')) rest.remove_suffix(1);
  return rest;
}

double TextCursor::parseNumber(std::string_view word, const char* what) const {
  const auto value = parsedNumber(word);
  if (!value) refuse(foundText(what, word) + "; expected a number");
  return *value;
}

std::uint64_t TextCursor::whole(const char* what, std::uint64_t largest) {
  return parseWhole(word(), what, largest);
}

std::uint64_t TextCursor::parseWhole(std::string_view word, const char* what,
                                     std::uint64_t largest) const {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || value > largest)
    refuse(foundText(what, word) + "; expected a whole number from 0 to " +
           std::to_string(largest));
  return value;
}

void TextCursor::refuse(const std::string& what) const {
  throw invalidInput(m_name + ": " + place() + ": " + what);
}

}  // namespace lumen::convert
