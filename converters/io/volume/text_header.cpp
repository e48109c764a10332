// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/text_header.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <memory>

#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

/// Numbers have several notations, and words either case.
bool isSameValue(const std::string& a, const std::string& b) {
  const auto same = [](const std::string& v, const std::string& w) {
    const auto number = parsedNumber(v);
    return lowerCase(v) == lowerCase(w) || (number && number == parsedNumber(w));
  };
  const auto left = splitWords(a), right = splitWords(b);
  return std::equal(left.begin(), left.end(), right.begin(), right.end(), same);
}

}  // namespace

std::vector<std::string> splitWords(std::string_view text, std::string_view separators) {
  std::vector<std::string> words;
  for (std::size_t at = 0;
       (at = text.find_first_not_of(separators, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

std::optional<std::int64_t> parseInteger(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size()) return value;
  const auto real = parsedNumber(text);        // "48.0"
  constexpr double kExact = 9007199254740992;  // 2^53
  if (!real || std::abs(*real) > kExact || *real != std::floor(*real)) return {};
  return static_cast<std::int64_t>(*real);
}

HeaderLines::HeaderLines(const InputFile& file) {
  constexpr std::size_t kMaxHeader = 1 << 22;  // enough for names of 50 000 files
  const std::unique_ptr<std::istream> stream = file.open();
  m_text.resize(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), kMaxHeader)));
  stream->read(m_text.data(), static_cast<std::streamsize>(m_text.size()));
  if (stream->bad()) throw invalidInput(file.path().string() + ": cannot be read");
  m_text.resize(static_cast<std::size_t>(stream->gcount()));
}

bool HeaderLines::next(std::string& line) {
  if (m_at >= m_text.size()) return false;
  const std::size_t end = std::min(m_text.find('\n', m_at), m_text.size());
  line = m_text.substr(m_at, end - m_at);
  m_at = std::min(end + 1, m_text.size());
  return true;
}

void TextHeader::set(const std::string& name, const std::string& value) {
  const auto [field, added] = m_fields.emplace(name, value);
  if (added || isSameValue(field->second, value)) return;
  throw invalidInput(path().string() + ": its header states " + formats::printable(name) +
                     " twice: " + quotedText(field->second) + " and " + quotedText(value));
}

const std::string& TextHeader::text(const std::string& name) const {
  static const std::string none;
  const auto field = m_fields.find(name);
  return field == m_fields.end() ? none : field->second;
}

const std::string& TextHeader::required(const std::string& name) const {
  if (!has(name)) throw invalidInput(path().string() + ": its header has no field " + name);
  return text(name);
}

std::vector<double> TextHeader::numbers(const std::string& name, std::size_t count) const {
  std::vector<double> values;
  if (!has(name)) return values;
  const auto words = splitWords(text(name));
  for (const std::string& word : words)
    if (const auto value = parsedNumber(word)) values.push_back(*value);
  if (values.size() != count || words.size() != count)
    throw refusal(name, std::to_string(count) + " numbers");
  return values;
}

std::vector<std::int64_t> TextHeader::integers(const std::string& name, std::size_t count,
                                               std::int64_t low, std::int64_t high) const {
  std::vector<std::int64_t> values;
  const auto words = splitWords(required(name));
  for (const std::string& word : words)
    if (const auto value = parseInteger(word); value && *value >= low && *value <= high)
      values.push_back(*value);
  if (values.size() != count || words.size() != count)
    throw refusal(name, (count == 1 ? "a whole number" : std::to_string(count) + " whole numbers") +
                            (" from " + std::to_string(low)) + " to " + std::to_string(high));
  return values;
}

std::int64_t TextHeader::integer(const std::string& name, std::int64_t low, std::int64_t high,
                                 std::int64_t absent) const {
  return has(name) ? integers(name, 1, low, high)[0] : absent;
}

Error TextHeader::refusal(const std::string& name, const std::string& expected) const {
  return invalidInput(path().string() + ": its " + name + " is " + quotedText(text(name)) +
                      "; expected " + expected);
}

}  // namespace lumen::convert
