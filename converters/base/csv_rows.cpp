// SPDX-License-Identifier: Apache-2.0
#include "converters/base/csv_rows.h"

#include <memory>
#include <utility>

#include <csv.h>

#include "converters/base/error.h"
#include "converters/base/text.h"

namespace lumen::convert {
namespace {

struct Table {
  std::vector<CsvRow> rows;
  CsvRow row;
};

}  // namespace

std::vector<CsvRow> csvRows(const std::string& text, const std::string& name) {
  csv_parser parser{};
  if (csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI | CSV_APPEND_NULL) != 0)
    throw failed("comma-separated values cannot be read");
  const std::unique_ptr<csv_parser, void (*)(csv_parser*)> owner(&parser, csv_free);
  Table table;
  const auto cell = [](void* bytes, std::size_t size, void* data) {
    static_cast<Table*>(data)->row.cells.push_back(
        trimmed(std::string(static_cast<const char*>(bytes), size)));
  };
  const auto row = [](int, void* data) {
    auto& all = *static_cast<Table*>(data);
    all.rows.push_back(std::exchange(all.row, {}));
  };
  bool isRead = true;
  // lines are counted here, as libcsv does not report them
  for (std::size_t at = 0, line = 1; isRead && at < text.size(); ++at) {
    const bool isEnd = text[at] == '\n' || text[at] == '\r';
    if (table.row.line == 0 && !isEnd) table.row.line = line;
    isRead = csv_parse(&parser, &text[at], 1, cell, row, &table) == 1;
    line += text[at] == '\n' ? 1 : 0;
  }
  if (!isRead || csv_fini(&parser, cell, row, &table) != 0)
    throw invalidInput(
        name + ": " + "line " + std::to_string(table.row.line) + ": " +
        "found a quote inside of a text, or one without an end; expected comma-" +
        "separated values in which a text with quotes is \"quoted \"\"like this\"\"\"");
  return std::move(table.rows);
}

}  // namespace lumen::convert
