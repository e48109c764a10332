// SPDX-License-Identifier: Apache-2.0
#include "converters/io/remote/http_answer.h"

#include <charconv>

#include "converters/base/text.h"

namespace lumen::convert {

namespace {

constexpr std::size_t kLongestVersion = 256;

/// The number that `text` begins with, which is taken off; none if there is no digit.
std::optional<std::uint64_t> takeNumber(std::string_view& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

bool takeWord(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

std::optional<ContentRange> parseRange(std::string_view text) {
  ContentRange range;
  if (!takeWord(text, "bytes ")) return {};
  const auto first = takeNumber(text);
  if (!first || !takeWord(text, "-")) return {};
  const auto last = takeNumber(text);
  if (!last || *last < *first || !takeWord(text, "/")) return {};
  range.first = *first;
  range.last = *last;
  if (text == "*") return range;
  range.whole = takeNumber(text);
  if (!range.whole || !text.empty() || *range.whole <= *last) return {};
  return range;
}

/// A tag or a time that may be sent back as it is; weak tags promise no equal bytes.
std::string asVersion(const std::string& value) {
  if (value.size() > kLongestVersion || value.starts_with("W/")) return {};
  for (const char c : value)
    if (c < ' ' || c > '~') return {};
  return value;
}

}  // namespace

HttpAnswer parseHttpAnswer(std::string_view text) {
  HttpAnswer answer;
  std::string tag, time;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string line = trimmed(std::string(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.starts_with("HTTP/")) {  // another answer begins
      answer = {};
      tag.clear();
      time.clear();
      std::string_view rest = line;
      rest.remove_prefix(std::min(rest.find(' '), rest.size() - 1) + 1);
      answer.status = static_cast<int>(takeNumber(rest).value_or(0));
      continue;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string name = lowerCase(line.substr(0, colon)),
                      value = trimmed(line.substr(colon + 1));
    std::string_view number = value;
    if (name == "content-length") answer.length = takeNumber(number);
    if (name == "content-range") answer.range = parseRange(value);
    if (name == "etag") tag = asVersion(value);
    if (name == "last-modified") time = asVersion(value);
  }
  answer.version = tag.empty() ? time : tag;
  return answer;
}

}  // namespace lumen::convert
