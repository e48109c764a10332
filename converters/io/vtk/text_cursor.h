// SPDX-License-Identifier: Apache-2.0
// Words and numbers of a text, with their line numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "converters/base/options/parsed_number.h"

namespace lumen::convert {

/// Single pass over a text. Lines end with LF, CR LF or CR; blanks separate words.
class TextCursor {
public:
  /// `line` is the number of the first line. A byte-order mark before the text is skipped.
  TextCursor(std::string_view text, std::string name, std::size_t line = 1)
      : m_text(text),
        m_name(std::move(name)),
        m_at(text.size() - withoutByteOrderMark(text).size()),
        m_line(line) {}

  /// The next word, of this line or a later one; empty at the end.
  std::string_view word() {
    skipSpace(true);
    return take();
  }
  /// The next word of this line; empty if there is none.
  std::string_view wordOfLine() {
    skipSpace(false);
    return take();
  }
  /// The rest of this line without blanks around it. The next word is then on the next line.
  std::string_view restOfLine();

  /// The next word, of this line or a later one, as a number, finite or not. Refuses a word that is
  /// no number, and a number too large for a double. `what` is the subject of the message.
  double number(const char* what) { return parseNumber(word(), what); }
  double parseNumber(std::string_view word, const char* what) const;
  /// The next word as a whole number from 0 to `largest`. Refuses any other word.
  std::uint64_t whole(const char* what, std::uint64_t largest);
  std::uint64_t parseWhole(std::string_view word, const char* what, std::uint64_t largest) const;

  [[nodiscard]] std::size_t line() const { return m_line; }
  [[nodiscard]] std::size_t offset() const { return m_at; }
  [[nodiscard]] std::size_t left() const { return m_text.size() - m_at; }
  [[nodiscard]] std::string place() const { return "line " + std::to_string(m_line); }
  [[nodiscard]] const std::string& name() const { return m_name; }
  /// Skips `bytes` bytes of binary data.
  void skip(std::size_t bytes) { m_at += bytes; }

  /// Throws Error(InvalidInput): "name: line N: what".
  [[noreturn]] void refuse(const std::string& what) const;

private:
  void skipSpace(bool lines) {
    while (m_at < m_text.size()) {
      const char c = m_text[m_at];
      if (c == '\n' || c == '\r') {
        if (!lines) return;
        endLine();
      } else if (c == ' ' || c == '\t' || c == '\v' || c == '\f') {
        ++m_at;
      } else {
        return;
      }
    }
  }
  // Skips the end of a line at the current position.
  void endLine() {
    if (m_text[m_at] == '\r' && m_at + 1 < m_text.size() && m_text[m_at + 1] == '\n') ++m_at;
    ++m_at;
    ++m_line;
  }
  static bool isSpace(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
  }
  std::string_view take() {
    const std::size_t from = m_at;
    while (m_at < m_text.size() && !isSpace(m_text[m_at])) ++m_at;
    return m_text.substr(from, m_at - from);
  }

  std::string_view m_text;
  std::string m_name;
  std::size_t m_at;
  std::size_t m_line;
};

}  // namespace lumen::convert
