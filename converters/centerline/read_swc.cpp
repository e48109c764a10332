// SPDX-License-Identifier: Apache-2.0
#include "converters/centerline/read_swc.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <queue>
#include <system_error>
#include <utility>

#include "converters/common/error.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{64} << 20;
constexpr double kLargestId = 2147483647;
constexpr double kLargestLength = 1e9;  // far beyond any unit that is meant
constexpr std::size_t kShownBytes = 24;
constexpr std::array<const char*, 7> kColumns = {"the id", "the type",   "x",         "y",
                                                 "z",      "the radius", "the parent"};
constexpr const char* kExpectedLine = "expected: id type x y z radius parent";

// A point as its line has it.
struct Line {
  std::int32_t id, parent;  // ids; parent -1: none
  std::size_t number;       // from 1
  CenterlinePoint point;    // without its parent
};

class Parser {
public:
  Parser(std::string_view text, std::string name) : m_text(text), m_name(std::move(name)) {}

  std::vector<Line> lines() {
    if (m_text.starts_with("\xEF\xBB\xBF")) m_text.remove_prefix(3);
    std::vector<Line> lines;
    while (!m_text.empty()) {
      ++m_number;
      const std::array<std::string_view, 7> columns = columnsOf(nextLine());
      if (!columns[0].empty()) lines.push_back(lineOf(columns));
    }
    if (lines.empty()) throw invalidInput(m_name + ": has no points; " + kExpectedLine);
    return lines;
  }

  [[noreturn]] void refuse(const std::string& what) const { refuseAt(m_number, what); }
  [[noreturn]] void refuseAt(std::size_t number, const std::string& what) const {
    throw invalidInput(m_name + ": line " + std::to_string(number) + ": " + what);
  }

private:
  // Up to the next end of line, and without a comment.
  std::string_view nextLine() {
    const std::size_t end = std::min(m_text.find_first_of("\r\n"), m_text.size());
    const std::string_view line = m_text.substr(0, end);
    std::size_t next = end;
    if (next < m_text.size() && m_text[next] == '\r') ++next;
    if (next < m_text.size() && m_text[next] == '\n') ++next;
    m_text.remove_prefix(next);
    return line.substr(0, line.find('#'));
  }

  // The first is empty for an empty line.
  [[nodiscard]] std::array<std::string_view, 7> columnsOf(std::string_view line) const {
    std::array<std::string_view, 7> columns;
    std::size_t count = 0;
    while (count < columns.size()) {
      const std::size_t from = std::min(line.find_first_not_of(" \t\v\f"), line.size());
      line.remove_prefix(from);
      if (line.empty()) break;
      const std::size_t size = std::min(line.find_first_of(" \t\v\f"), line.size());
      columns[count++] = line.substr(0, size);
      line.remove_prefix(size);
    }
    if (count != 0 && count != columns.size())
      refuse("has " + std::to_string(count) + " of 7 columns; " + kExpectedLine);
    return columns;
  }

  [[nodiscard]] double numberOf(std::string_view text, std::size_t column) const {
    std::string_view digits = text;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value) ||
        std::abs(value) > kLargestLength * 10 || text.starts_with("+-"))
      refuse(found(text, column) + "; expected a number");
    return value;
  }

  [[nodiscard]] std::int32_t wholeOf(std::string_view text, std::size_t column, double low) const {
    const double value = numberOf(text, column);
    if (value != std::floor(value) || value < low || value > kLargestId)
      refuse(found(text, column) + "; expected a whole number from " +
             std::to_string(static_cast<int>(low)) + " to 2147483647");
    return static_cast<std::int32_t>(value);
  }

  static std::string found(std::string_view text, std::size_t column) {
    const bool cut = text.size() > kShownBytes;
    return std::string(kColumns[column]) + " is \"" +
           formats::printable(text.substr(0, kShownBytes)) + (cut ? "...\"" : "\"");
  }

  [[nodiscard]] Line lineOf(const std::array<std::string_view, 7>& columns) const {
    Line line;
    line.number = m_number;
    line.id = wholeOf(columns[0], 0, 0);
    line.point.type = wholeOf(columns[1], 1, -kLargestId);
    for (std::size_t a = 0; a < 3; ++a) {
      const double value = numberOf(columns[2 + a], 2 + a);
      if (std::abs(value) > kLargestLength)
        refuse(found(columns[2 + a], 2 + a) + "; expected -1e9 to 1e9");
      line.point.position[static_cast<Eigen::Index>(a)] = value;
    }
    line.point.radius = numberOf(columns[5], 5);
    if (!(line.point.radius > 0 && line.point.radius <= kLargestLength))
      refuse(found(columns[5], 5) + "; expected a positive number up to 1e9");
    line.parent = wholeOf(columns[6], 6, -1);
    if (line.parent == line.id)
      refuse(found(columns[6], 6) + ", the point itself; expected another point, or -1 of a root");
    return line;
  }

  std::string_view m_text;
  std::string m_name;
  std::size_t m_number = 0;
};

// For each line the index of its parent's, or kNoPoint. Refuses ids that occur twice and parents
// that are missing.
std::vector<std::int32_t> parentsOf(const std::vector<Line>& lines, const Parser& parser) {
  std::vector<std::pair<std::int32_t, std::int32_t>> byId;  // id, index
  byId.reserve(lines.size());
  for (const Line& line : lines) byId.emplace_back(line.id, static_cast<std::int32_t>(byId.size()));
  std::sort(byId.begin(), byId.end());
  for (std::size_t i = 1; i < byId.size(); ++i)
    if (byId[i].first == byId[i - 1].first)
      parser.refuseAt(
          lines[static_cast<std::size_t>(byId[i].second)].number,
          "the id " + std::to_string(byId[i].first) + " is that of line " +
              std::to_string(lines[static_cast<std::size_t>(byId[i - 1].second)].number) +
              " already; expected one point of each id");
  std::vector<std::int32_t> parents;
  parents.reserve(lines.size());
  for (const Line& line : lines) {
    parents.push_back(kNoPoint);
    if (line.parent == -1) continue;
    const auto entry = std::lower_bound(byId.begin(), byId.end(), std::pair(line.parent, 0));
    if (entry == byId.end() || entry->first != line.parent)
      parser.refuseAt(line.number, "the parent is " + std::to_string(line.parent) +
                                       ", which no line has as its id; expected the id of a "
                                       "point, or -1 of a root");
    parents.back() = entry->second;
  }
  return parents;
}

// The index of a line that leads back to itself.
std::size_t someOfCycle(const std::vector<std::int32_t>& parents, std::size_t start) {
  auto at = static_cast<std::int32_t>(start);
  for (std::size_t i = 0; i < parents.size(); ++i) at = parents[static_cast<std::size_t>(at)];
  std::int32_t lowest = at;
  for (std::int32_t n = parents[static_cast<std::size_t>(at)]; n != at;
       n = parents[static_cast<std::size_t>(n)])
    lowest = std::min(lowest, n);
  return static_cast<std::size_t>(lowest);
}

// The lines in an order where parents come first, otherwise that of the file.
std::vector<std::int32_t> parentsFirst(const std::vector<Line>& lines,
                                       const std::vector<std::int32_t>& parents,
                                       const Parser& parser) {
  const std::size_t n = lines.size();
  std::vector<std::int32_t> firstChild(n, kNoPoint), sibling(n, kNoPoint), order;
  std::priority_queue<std::int32_t, std::vector<std::int32_t>, std::greater<>> ready;
  for (std::size_t i = 0; i < n; ++i) {
    const auto index = static_cast<std::int32_t>(i);
    if (parents[i] == kNoPoint)
      ready.push(index);
    else
      sibling[i] = std::exchange(firstChild[static_cast<std::size_t>(parents[i])], index);
  }
  std::vector<bool> placed(n, false);
  while (!ready.empty()) {
    order.push_back(ready.top());
    ready.pop();
    const auto last = static_cast<std::size_t>(order.back());
    placed[last] = true;
    for (std::int32_t c = firstChild[last]; c != kNoPoint; c = sibling[static_cast<std::size_t>(c)])
      ready.push(c);
  }
  if (order.size() == n) return order;
  const auto left = std::find(placed.begin(), placed.end(), false) - placed.begin();
  const Line& line = lines[someOfCycle(parents, static_cast<std::size_t>(left))];
  parser.refuseAt(line.number,
                  "the parents of point " + std::to_string(line.id) +
                      " lead back to it; expected a way to a root, whose parent is -1");
}

}  // namespace

CenterlineFile parseSwc(std::string_view text, const std::string& name) {
  Parser parser(text, formats::printable(name));
  const std::vector<Line> lines = parser.lines();
  const std::vector<std::int32_t> parents = parentsOf(lines, parser);
  const std::vector<std::int32_t> order = parentsFirst(lines, parents, parser);
  std::vector<std::int32_t> place(lines.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    place[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
  CenterlineFile file;
  file.points.reserve(lines.size());
  for (const std::int32_t index : order) {
    const auto i = static_cast<std::size_t>(index);
    file.points.push_back(lines[i].point);
    if (parents[i] != kNoPoint)
      file.points.back().parent = place[static_cast<std::size_t>(parents[i])];
  }
  return file;
}

CenterlineFile readSwc(const fs::path& file) {
  const std::string name = formats::printable(file.string());
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error) throw invalidInput(name + ": cannot be read (" + error.message() + ")");
  if (size > kMaxBytes)
    throw invalidInput(name + ": has " + std::to_string(size) +
                       " bytes; expected at most 64 MiB of SWC");
  std::string text(static_cast<std::size_t>(size), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(text.data(), static_cast<std::streamsize>(size)))
    throw invalidInput(name + ": cannot be read");
  return parseSwc(text, file.string());
}

}  // namespace lumen::convert
