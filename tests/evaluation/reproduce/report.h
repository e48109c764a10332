// SPDX-License-Identifier: Apache-2.0
// Tables of measured figures, written as Markdown and as JSON.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
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

// The data of line plots, which plots.py draws.
struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;
  bool dashed = false;
};

struct Plot {
  std::string title, xLabel, yLabel;
  bool logarithmic = false;  ///< the y axis; values that are not above zero are left out
  std::vector<Curve> curves;
};

/// {"title", "x", "y", "logarithmic", "curves": [{"name", "dashed", "points": [[x, y], ...]},
/// ...]}; a coordinate that is not finite is null.
std::string plotJson(const Plot& plot);

/// Writes `name`.plot.json, of which plots.py makes `name`.svg. Throws Error(Failed).
void writePlot(const std::filesystem::path& folder, const std::string& name, const Plot& plot);

}  // namespace lumen::reproduce
