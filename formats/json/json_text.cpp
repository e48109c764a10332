// SPDX-License-Identifier: Apache-2.0
#include "formats/json/json_text.h"

#include <algorithm>
#include <cstdint>

#include "formats/container/utf8.h"

namespace lumen::formats {
namespace {

constexpr std::uint32_t kNoEscape = 0xffffffffu;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

void appendUtf8(std::string& to, std::uint32_t point) {
  const auto add = [&to](std::uint32_t byte) { to += static_cast<char>(byte); };
  if (point < 0x80) return add(point);
  if (point < 0x800) {
    add(0xc0u | point >> 6);
  } else if (point < 0x10000) {
    add(0xe0u | point >> 12);
    add(0x80u | (point >> 6 & 0x3fu));
  } else {
    add(0xf0u | point >> 18);
    add(0x80u | (point >> 12 & 0x3fu));
    add(0x80u | (point >> 6 & 0x3fu));
  }
  add(0x80u | (point & 0x3fu));
}

class JsonParser {
public:
  JsonParser(std::string_view text, JsonEvents& events) : m_text(text), m_events(events) {}

  std::optional<JsonFault> read() {
    if (m_text.starts_with("\xef\xbb\xbf"))
      (void)fail("found a byte order mark, which JSON does not allow");
    else if (value() && (skipSpace(), m_at < m_text.size()))
      (void)expected("the end of the text");
    return std::move(m_fault);
  }

private:
  [[nodiscard]] bool at(char c) const { return m_at < m_text.size() && m_text[m_at] == c; }
  bool take(char c) {
    if (!at(c)) return false;
    ++m_at;
    return true;
  }
  void skipSpace() {
    while (at(' ') || at('\n') || at('\r') || at('\t')) ++m_at;
  }

  bool fail(const std::string& message) {
    const std::string_view before = m_text.substr(0, m_at);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t column = m_at - (before.rfind('\n') + 1) + 1;
    m_fault = JsonFault{m_at, "line " + std::to_string(line) + ", column " +
                                  std::to_string(column) + ": " + message};
    return false;
  }
  bool expected(const std::string& what) {
    if (m_at == m_text.size()) return fail("the text ends, expected " + what);
    std::size_t end = m_at;
    (void)nextCodePoint(m_text, end);
    return fail("found \"" + std::string(m_text.substr(m_at, end - m_at)) + "\", expected " + what);
  }

  bool value() {
    skipSpace();
    if (take('{')) return object();
    if (take('[')) return array();
    if (at('"')) return text() && m_events.string(m_string);
    if (at('-') || (m_at < m_text.size() && isDigit(m_text[m_at]))) return number();
    if (at('t')) return word("true") && m_events.boolean(true);
    if (at('f')) return word("false") && m_events.boolean(false);
    if (at('n')) return word("null") && m_events.null();
    return expected("a value");
  }

  bool word(std::string_view name) {
    for (const char c : name)
      if (!take(c)) return expected("the word " + std::string(name));
    return true;
  }

  bool object() {
    if (!m_events.beginObject()) return false;
    skipSpace();
    for (bool first = true; !take('}'); first = false) {
      if (!first && !take(',')) return expected("\",\" or \"}\"");
      skipSpace();
      if (!at('"')) return expected(first ? "a key in quotes, or \"}\"" : "a key in quotes");
      if (!text() || !m_events.key(m_string)) return false;
      skipSpace();
      if (!take(':')) return expected("\":\"");
      if (!value()) return false;
      skipSpace();
    }
    return m_events.endObject();
  }

  bool array() {
    if (!m_events.beginArray()) return false;
    skipSpace();
    for (bool first = true; !take(']'); first = false) {
      if (!first && !take(',')) return expected("\",\" or \"]\"");
      if (!value()) return false;
      skipSpace();
    }
    return m_events.endArray();
  }

  bool digits() {
    if (m_at == m_text.size() || !isDigit(m_text[m_at])) return expected("a digit");
    while (m_at < m_text.size() && isDigit(m_text[m_at])) ++m_at;
    return true;
  }

  bool number() {
    const std::size_t start = m_at;
    bool whole = true;
    take('-');
    if (take('0')) {
      if (m_at < m_text.size() && isDigit(m_text[m_at]))
        return fail("a number starts with a zero that nothing needs");
    } else if (!digits()) {
      return false;
    }
    if (take('.')) {
      whole = false;
      if (!digits()) return false;
    }
    if (take('e') || take('E')) {
      whole = false;
      if (!take('-')) take('+');
      if (!digits()) return false;
    }
    return m_events.number(m_text.substr(start, m_at - start), whole);
  }

  // Reads a text in quotes to m_string.
  bool text() {
    m_string.clear();
    ++m_at;
    while (!at('"')) {
      if (m_at == m_text.size()) return expected("the quote that ends a text");
      if (at('\\')) {
        if (!escape()) return false;
        continue;
      }
      const std::size_t start = m_at;
      std::size_t end = m_at;
      const std::uint32_t point = nextCodePoint(m_text, end);
      if (point == kIllFormed) return fail("found bytes that are not UTF-8");
      if (point < 0x20)
        return fail("found a control character in a text; it is written as \\uNNNN");
      m_string += m_text.substr(start, end - start);
      m_at = end;
    }
    ++m_at;
    return true;
  }

  bool escape() {
    constexpr std::string_view kLetters = "\"\\/bfnrt", kMeanings = "\"\\/\b\f\n\r\t";
    const std::size_t start = m_at++;
    if (m_at < m_text.size())
      if (const auto letter = kLetters.find(m_text[m_at]); letter != std::string_view::npos) {
        m_string += kMeanings[letter];
        ++m_at;
        return true;
      }
    std::uint32_t point = unicodeEscape();
    if (point >= 0xd800 && point < 0xdc00 && take('\\')) {
      const std::uint32_t low = unicodeEscape();
      point = low >= 0xdc00 && low < 0xe000 ? 0x10000 + ((point & 0x3ffu) << 10) + (low & 0x3ffu)
                                            : kNoEscape;
    }
    if (point == kNoEscape || (point >= 0xd800 && point < 0xe000)) {
      m_at = start;
      return fail("found an escape that JSON does not have");
    }
    appendUtf8(m_string, point);
    return true;
  }

  // Reads the four digits after \u; kNoEscape without them.
  std::uint32_t unicodeEscape() {
    if (!take('u') || m_text.size() - m_at < 4) return kNoEscape;
    std::uint32_t point = 0;
    for (int i = 0; i < 4; ++i) {
      const char c = m_text[m_at++];
      const char lower = static_cast<char>(c | 0x20);
      if (!isDigit(c) && (lower < 'a' || lower > 'f')) return kNoEscape;
      point = point << 4 | static_cast<std::uint32_t>(isDigit(c) ? c - '0' : lower - 'a' + 10);
    }
    return point;
  }

  std::string_view m_text;
  JsonEvents& m_events;
  std::size_t m_at = 0;
  std::string m_string;
  std::optional<JsonFault> m_fault;
};

}  // namespace

std::optional<JsonFault> readJsonText(std::string_view text, JsonEvents& events) {
  return JsonParser(text, events).read();
}

}  // namespace lumen::formats
