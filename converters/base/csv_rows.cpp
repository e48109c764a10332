// SPDX-License-Identifier: Apache-2.0
#include "converters/base/csv_rows.h"

#include <utility>

#include "converters/base/error.h"
#include "converters/base/text.h"

namespace lumen::convert {
namespace {

/// Places between two characters. Closed: behind a quoted text and white space.
enum class CsvPlace { RowStart, CellStart, Plain, Quoted, QuoteInQuoted, Closed };

class CsvReader {
public:
  explicit CsvReader(char separator) : m_separator(separator) {}
  /// False for a character that RFC 4180 does not allow here.
  bool take(char c) {
    if (m_place == CsvPlace::Quoted && c != '"') return keep(c, CsvPlace::Quoted);
    if (c == '"') return takeQuote();
    if (c == m_separator) return endCell();
    if (c == '\n' || c == '\r') return endRow();
    const bool isClosed = m_place == CsvPlace::QuoteInQuoted || m_place == CsvPlace::Closed;
    if (c != ' ' && c != '\t') return !isClosed && keep(c, CsvPlace::Plain);
    if (m_place == CsvPlace::Plain) return keep(c, CsvPlace::Plain);
    if (isClosed) m_place = CsvPlace::Closed;
    return true;
  }
  /// False within a quoted text.
  bool end() { return m_place != CsvPlace::Quoted && endRow(); }

  CsvRow row;
  std::vector<CsvRow> rows;

private:
  bool keep(char c, CsvPlace next) {
    m_cell += c;
    m_place = next;
    return true;
  }
  bool takeQuote() {
    if (m_place == CsvPlace::QuoteInQuoted) return keep('"', CsvPlace::Quoted);
    if (m_place == CsvPlace::Plain || m_place == CsvPlace::Closed) return false;
    m_place = m_place == CsvPlace::Quoted ? CsvPlace::QuoteInQuoted : CsvPlace::Quoted;
    return true;
  }
  bool endCell() {
    row.cells.push_back(trimmed(std::exchange(m_cell, {})));
    m_place = CsvPlace::CellStart;
    return true;
  }
  bool endRow() {
    if (m_place == CsvPlace::RowStart) return true;
    endCell();
    rows.push_back(std::exchange(row, {}));
    m_place = CsvPlace::RowStart;
    return true;
  }

  char m_separator;
  CsvPlace m_place = CsvPlace::RowStart;
  std::string m_cell;
};

}  // namespace

std::vector<CsvRow> csvRows(const std::string& text, const std::string& name, char separator) {
  CsvReader reader(separator);
  bool isRead = true;
  for (std::size_t at = 0, line = 1; isRead && at < text.size(); ++at) {
    const bool isEnd = text[at] == '\n' || text[at] == '\r';
    if (reader.row.line == 0 && !isEnd) reader.row.line = line;
    isRead = reader.take(text[at]);
    line += text[at] == '\n' ? 1 : 0;
  }
  if (!isRead || !reader.end())
    throw invalidInput(
        name + ": " + "line " + std::to_string(reader.row.line) + ": " +
        "found a quote inside of a text, or one without an end; expected comma-" +
        "separated values in which a text with quotes is \"quoted \"\"like this\"\"\"");
  return std::move(reader.rows);
}

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

}  // namespace lumen::convert
