// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/cli/terminal_progress.h"

namespace lumen::reproduce {
namespace {

std::string cellText(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  return formatNumber(std::get<double>(cell));
}

nlohmann::ordered_json cellValue(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const double value = std::get<double>(cell);
  if (!std::isfinite(value)) return nullptr;
  return value;
}

std::string line(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

}  // namespace

std::string formatNumber(double value) {
  if (std::isnan(value)) return "-";
  if (value == std::round(value) && std::abs(value) < 1e6) {
    return std::to_string(static_cast<long long>(value));
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void Report::paragraph(const std::string& text) {
  m_body += text + "\n\n";
}

void Report::table(const Table& table) {
  m_body += "**" + table.title + "**\n\n" + line(table.columns);
  m_body += line(std::vector<std::string>(table.columns.size(), "---"));
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (const Cell& cell : row) cells.push_back(cellText(cell));
    m_body += line(cells);
  }
  m_body += "\n";
  m_tables.push_back(table);
}

void Report::picture(const std::string& file, const std::string& caption) {
  m_body += "Picture `" + file + "`: " + caption + ".\n\n";
}

std::string Report::markdown() const {
  return "# " + m_title + "\n\n" + m_body;
}

std::string Report::json() const {
  nlohmann::ordered_json root{{"title", m_title}, {"tables", nlohmann::ordered_json::array()}};
  for (const Table& table : m_tables) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const auto& row : table.rows) {
      nlohmann::ordered_json object;
      for (std::size_t i = 0; i < row.size(); ++i) object[table.columns[i]] = cellValue(row[i]);
      rows.push_back(object);
    }
    root["tables"].push_back({{"title", table.title}, {"rows", rows}});
  }
  return root.dump(2) + "\n";
}

void Report::write(const std::filesystem::path& folder, const std::string& name) const {
  writeText(folder / (name + ".md"), markdown());
  writeText(folder / (name + ".json"), json());
}

void writeText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw failed(file.string() + ": cannot be written");
}

int runReport(int argc, char** argv, const std::string& program,
              void (*run)(const std::filesystem::path& folder, Progress& progress)) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", program.c_str());
    return 2;
  }
  TerminalProgress progress(TerminalProgress::detectStyle(stderr, Verbosity::Normal));
  try {
    run(argv[1], progress);
  } catch (const std::exception& e) {
    progress.abandon();
    std::fprintf(stderr, "%s: %s\n", program.c_str(), e.what());
    return 1;
  }
  return 0;
}

std::string plotJson(const Plot& plot) {
  using Json = nlohmann::ordered_json;
  Json root{{"title", plot.title},
            {"x", plot.xLabel},
            {"y", plot.yLabel},
            {"logarithmic", plot.logarithmic},
            {"curves", Json::array()}};
  for (const Curve& curve : plot.curves) {
    Json points = Json::array();
    for (const auto& [x, y] : curve.points) points.push_back(Json::array({x, y}));
    root["curves"].push_back({{"name", curve.name}, {"dashed", curve.dashed}, {"points", points}});
  }
  return root.dump() + "\n";
}

void writePlot(const std::filesystem::path& folder, const std::string& name, const Plot& plot) {
  writeText(folder / (name + ".plot.json"), plotJson(plot));
}

}  // namespace lumen::reproduce
