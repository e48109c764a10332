// SPDX-License-Identifier: Apache-2.0
// Files of Slicer's vtkMRMLMarkupsFiducialStorageNode: "# name = value" lines, then rows.
// Declared in seeds_parse.h.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/seeds/seeds_parse.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

/// Default columns, for a file that does not name its own.
constexpr const char* kColumns = "id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID";

/// The fields of a row: between commas, or between quotes, which stand for themselves when doubled.
std::vector<std::string> splitFields(std::string_view row) {
  std::vector<std::string> fields(1);
  bool inQuotes = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] == '"' && inQuotes && i + 1 < row.size() && row[i + 1] == '"') {
      fields.back() += '"';
      ++i;
    } else if (row[i] == '"') {
      inQuotes = !inQuotes;
    } else if (row[i] == ',' && !inQuotes) {
      fields.emplace_back();
    } else {
      fields.back() += row[i];
    }
  }
  for (std::string& field : fields) field = trimmed(field);
  return fields;
}

class FcsvReader {
public:
  FcsvReader(const fs::path& file, std::string stem, const SeedReading& reading)
      : m_file(file), m_stem(std::move(stem)), m_reading(reading) {
    nameColumns(kColumns);
    m_system = reading.system;
  }

  std::vector<SeedBranch> read(std::string_view text) {
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      ++m_line;
      readLine(trimmed(std::string(text.substr(begin, end - begin))));
      begin = end + 1;
    }
    return std::move(m_branches);
  }

private:
  enum Column : std::size_t { kX, kY, kZ, kLabel, kDescription, kCount };
  static constexpr std::array<const char*, kCount> kNames = {"x", "y", "z", "label", "desc"};
  static constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);

  [[noreturn]] void refuse(const std::string& what) const {
    throw invalidInput(formats::printable(m_file.string()) + ": line " + std::to_string(m_line) +
                       ": " + what);
  }

  void readLine(const std::string& line) {
    if (line.empty()) return;
    if (line[0] == '#')
      readHeader(line);
    else
      readRow(splitFields(line));
  }

  /// "# CoordinateSystem = LPS", "# columns = id,x,y,z"; other remarks are ignored.
  void readHeader(const std::string& line) {
    const auto equals = line.find('=');
    if (equals == std::string::npos) return;
    const std::string key = lowerCase(trimmed(line.substr(1, equals - 1)));
    const std::string value = trimmed(line.substr(equals + 1));
    if (key == "columns") nameColumns(value);
    if (key != "coordinatesystem" || m_reading.system) return;
    if (value == "LPS" || value == "1")
      m_system = SeedSystem::Lps;
    else if (value == "RAS" || value == "0")
      m_system = SeedSystem::Ras;
    else if (value == "IJK" || value == "2")
      m_system = SeedSystem::Voxel;
    else
      refuse("the coordinate system is " + quotedText(value) +
             "; expected LPS (or 1), RAS (or 0) or IJK (or 2); " + m_reading.word("seeds-frame") +
             " states another");
  }

  void nameColumns(const std::string& names) {
    const std::vector<std::string> all = splitFields(names);
    for (std::size_t c = 0; c < kCount; ++c) {
      const auto at = std::find(all.begin(), all.end(), kNames[c]);
      m_column[c] = at == all.end() ? kAbsent : static_cast<std::size_t>(at - all.begin());
      if (c <= kZ && m_column[c] == kAbsent)
        refuse("the columns are " + quotedText(names) + "; expected " + kNames[c] + " among them");
    }
  }

  [[nodiscard]] double number(const std::vector<std::string>& row, Column column) const {
    const std::string& text = row[m_column[column]];
    const auto value = parsedNumber(text);
    if (!value || !std::isfinite(*value))
      refuse(std::string(kNames[column]) + " is " + quotedText(text) +
             "; expected a finite number");
    return *value;
  }

  [[nodiscard]] std::string text(const std::vector<std::string>& row, Column column) const {
    return m_column[column] < row.size() ? row[m_column[column]] : std::string();
  }

  void readRow(const std::vector<std::string>& row) {
    if (!m_system)
      refuse("no line \"# CoordinateSystem = LPS\" (or RAS) stands before the first point; " +
             m_reading.word("seeds-frame") +
             " lps or ras states it, or save the points from 3D Slicer as .mrk.json");
    const std::size_t needed = std::max({m_column[kX], m_column[kY], m_column[kZ]}) + 1;
    if (row.size() < needed)
      refuse("has " + std::to_string(row.size()) + " columns; expected at least " +
             std::to_string(needed));
    SeedBranch branch;
    branch.frame = {*m_system, m_reading.unit.value_or(1.0)};
    const Eigen::Vector3d xyz(number(row, kX), number(row, kY), number(row, kZ));
    branch.points.push_back({branch.frame.position(xyz), std::nullopt});
    branch.label = text(row, kLabel);
    if (branch.label.empty()) branch.label = m_stem + "-" + std::to_string(m_branches.size() + 1);
    const std::string description = text(row, kDescription);
    applyDescription(description, branch, [&](const std::string& expected) {
      refuse("desc is " + quotedText(description) + "; expected " + expected);
    });
    m_branches.push_back(std::move(branch));
  }

  const fs::path& m_file;
  std::string m_stem;
  const SeedReading& m_reading;
  std::optional<SeedSystem> m_system;
  std::array<std::size_t, kCount> m_column{};
  std::size_t m_line = 0;
  std::vector<SeedBranch> m_branches;
};

}  // namespace

std::vector<SeedBranch> parseFcsv(std::string_view text, const fs::path& file,
                                  const std::string& stem, const SeedReading& reading) {
  return FcsvReader(file, stem, reading).read(text);
}

}  // namespace lumen::convert
