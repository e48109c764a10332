// SPDX-License-Identifier: Apache-2.0
// Tables of measured figures, written as Markdown and as JSON.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "converters/base/progress.h"

namespace lumen::reproduce {

using Cell = std::variant<std::string, double>;

struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};

/// Paragraphs, tables and pictures in order.
class Report {
public:
  explicit Report(std::string title) : m_title(std::move(title)) {}

  void paragraph(const std::string& text);
  void table(const Table& table);
  /// `file` is relative to the folder of the report.
  void picture(const std::string& file, const std::string& caption);

  [[nodiscard]] std::string markdown() const;
  /// {"title": ..., "tables": [{"title": ..., "rows": [{column: value, ...}, ...]}, ...]}
  [[nodiscard]] std::string json() const;
  /// Writes `name`.md and `name`.json. Throws Error(Failed).
  void write(const std::filesystem::path& folder, const std::string& name) const;

private:
  std::string m_title;
  std::string m_body;
  std::vector<Table> m_tables;
};

/// Three significant digits; a dash for NaN.
std::string formatNumber(double value);

/// Throws Error(Failed).
void writeText(const std::filesystem::path& file, const std::string& text);

/// main() of a program that takes a folder and reports into it: 0, 1 after an error, 2 for a wrong
/// usage.
int runReport(int argc, char** argv, const std::string& program,
              void (*run)(const std::filesystem::path& folder, Progress& progress));

}  // namespace lumen::reproduce
