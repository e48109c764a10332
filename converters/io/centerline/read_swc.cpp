// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <queue>
#include <set>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/join_curves.h"
#include "converters/io/centerline/line_graph.h"
#include "converters/io/centerline/swc_comments.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr double kMillimetresOfMicrometre = 1e-3;
constexpr std::int32_t kSoma = 1;  // a type of SWC
constexpr double kSomaRounding = 0.05;
constexpr double kLargestId = 2147483647;
constexpr double kLargestLength = 1e9;  // far beyond any plausible unit
constexpr std::array<const char*, 7> kColumns = {"the id", "the type",   "x",         "y",
                                                 "z",      "the radius", "the parent"};
constexpr const char* kExpectedLine = "expected: id type x y z radius parent";

// A point as stated by its line.
struct Line {
  std::int32_t id, parent;  // ids; parent -1: none
  std::size_t number;       // from 1
  CenterlinePoint point;    // without its parent
};

class Parser {
public:
  Parser(std::string_view text, std::string name)
      : m_text(withoutByteOrderMark(text)), m_name(std::move(name)) {}

  std::vector<Line> lines() {
    std::vector<Line> lines;
    while (!m_text.empty()) {
      ++m_number;
      const std::array<std::string_view, 7> columns = splitColumns(nextLine());
      if (!columns[0].empty()) lines.push_back(lineOf(columns));
    }
    if (lines.empty()) throw invalidInput(m_name + ": has no points; " + kExpectedLine);
    return lines;
  }

  /// Names of vessels by the id of their first point, as written by write_swc.h.
  [[nodiscard]] const std::map<std::int32_t, std::string>& vessels() const { return m_vessels; }
  /// Unit and axes from a comment; SWC itself has neither.
  double unit = 0;
  CenterlineAxes axes = CenterlineAxes::Unknown;
  bool isOfLumen = false;
  SwcComments comments;

  [[noreturn]] void refuse(const std::string& what) const { refuseAt(m_number, what); }
  [[noreturn]] void refuseAt(std::size_t number, const std::string& what) const {
    throw invalidInput(m_name + ": line " + std::to_string(number) + ": " + what);
  }

private:
  // The text up to the next end of line, without its comment.
  std::string_view nextLine() {
    const std::size_t end = std::min(m_text.find_first_of("\r\n"), m_text.size());
    const std::string_view line = m_text.substr(0, end);
    const std::size_t comment = line.find('#');
    if (comment != line.npos) readComment(line.substr(comment + 1));
    std::size_t next = end;
    if (next < m_text.size() && m_text[next] == '\r') ++next;
    if (next < m_text.size() && m_text[next] == '\n') ++next;
    m_text.remove_prefix(next);
    return line.substr(0, comment);
  }

  void readComment(std::string_view text) {
    comments.read(text);
    if (text.find("NeuroMorpho") != text.npos) unit = kMillimetresOfMicrometre;
    if (text.find(kOwnCenterline) != text.npos) {
      unit = 1;
      axes = CenterlineAxes::Lps;
      isOfLumen = true;
    }
    constexpr std::string_view kVessel = " vessel ";
    if (!text.starts_with(kVessel)) return;
    text.remove_prefix(kVessel.size());
    std::int32_t id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    const auto used = static_cast<std::size_t>(end - text.data());
    if (error != std::errc{} || used + 1 >= text.size() || text[used] != ' ') return;
    m_vessels[id] = text.substr(used + 1);
  }

  // The first field is empty for an empty line.
  [[nodiscard]] std::array<std::string_view, 7> splitColumns(std::string_view line) const {
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

  [[nodiscard]] double parseNumber(std::string_view text, std::size_t column) const {
    const auto value = parsedNumber(text);
    if (!value || std::isnan(*value)) refuse(found(text, column) + "; expected a number");
    return *value;
  }

  [[nodiscard]] std::int32_t parseWhole(std::string_view text, std::size_t column,
                                        double low) const {
    const double value = parseNumber(text, column);
    if (value != std::floor(value) || value < low || value > kLargestId)
      refuse(found(text, column) + "; expected a whole number from " +
             std::to_string(static_cast<int>(low)) + " to 2147483647");
    return static_cast<std::int32_t>(value);
  }

  static std::string found(std::string_view text, std::size_t column) {
    return std::string(kColumns[column]) + " is " + quotedText(std::string(text));
  }

  [[nodiscard]] Line lineOf(const std::array<std::string_view, 7>& columns) const {
    Line line;
    line.number = m_number;
    line.id = parseWhole(columns[0], 0, 0);
    line.point.type = parseWhole(columns[1], 1, -kLargestId);
    for (std::size_t a = 0; a < 3; ++a) {
      const double value = parseNumber(columns[2 + a], 2 + a);
      if (std::abs(value) > kLargestLength)
        refuse(found(columns[2 + a], 2 + a) + "; expected -1e9 to 1e9");
      line.point.position[static_cast<Eigen::Index>(a)] = value;
    }
    line.point.radius = parseNumber(columns[5], 5);
    if (line.point.radius > kLargestLength)
      refuse(found(columns[5], 5) + "; expected a positive number up to 1e9");
    if (line.point.radius < 0) line.point.radius = 0;  // a placeholder
    line.parent = parseWhole(columns[6], 6, -1);
    if (line.parent == line.id)
      refuse(found(columns[6], 6) + ", the point itself; expected another point, or -1 of a root");
    return line;
  }

  std::string_view m_text;
  std::string m_name;
  std::size_t m_number = 0;
  std::map<std::int32_t, std::string> m_vessels;
};

// Index of each line's parent line, or kNoPoint. Refuses ids that occur twice and missing parents.
std::vector<std::int32_t> resolveParents(const std::vector<Line>& lines, const Parser& parser) {
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

// A neuron's body in NeuroMorpho's form: two points beside the first, at a distance of its radius,
// without children. They would be vessels of no length. Returns the number of points left out.
std::size_t dropSomaHelpers(std::vector<Line>& lines) {
  std::set<std::int32_t> parents;
  for (const Line& line : lines) parents.insert(line.parent);
  const auto root = std::find_if(lines.begin(), lines.end(), [](const Line& line) {
    return line.parent == -1 && line.point.type == kSoma;
  });
  if (root == lines.end()) return 0;
  const Line body = *root;
  const auto isHelper = [&](const Line& line) {
    if (line.parent != body.id || line.point.type != kSoma || parents.count(line.id) > 0)
      return false;
    const double distance = (line.point.position - body.point.position).norm();
    return std::abs(distance - body.point.radius) <= kSomaRounding * body.point.radius;
  };
  if (std::count_if(lines.begin(), lines.end(), isHelper) != 2) return 0;
  return std::erase_if(lines, isHelper);
}

// The index of a line whose ancestors include itself.
std::size_t someOfCycle(const std::vector<std::int32_t>& parents, std::size_t start) {
  auto at = static_cast<std::int32_t>(start);
  for (std::size_t i = 0; i < parents.size(); ++i) at = parents[static_cast<std::size_t>(at)];
  std::int32_t lowest = at;
  for (std::int32_t n = parents[static_cast<std::size_t>(at)]; n != at;
       n = parents[static_cast<std::size_t>(n)])
    lowest = std::min(lowest, n);
  return static_cast<std::size_t>(lowest);
}

// The lines ordered with parents first, otherwise as in the file.
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
  const std::string shown = formats::printable(name);
  Parser parser(text, shown);
  std::vector<Line> lines = parser.lines();
  CenterlineFile file;
  file.unit = parser.unit;
  file.axes = parser.axes;
  file.isOfLumen = parser.isOfLumen;
  if (file.unit == kMillimetresOfMicrometre)
    file.remarks.push_back("its comments name NeuroMorpho, so lengths are micrometres");
  const std::size_t soma = dropSomaHelpers(lines);
  if (soma > 0) file.remarks.push_back("a soma of three points is taken as its first one");
  const std::vector<std::int32_t> parents = resolveParents(lines, parser);
  const std::vector<std::int32_t> order = parentsFirst(lines, parents, parser);
  std::vector<std::int32_t> place(lines.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    place[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
  file.points.reserve(lines.size());
  for (const std::int32_t index : order) {
    const auto i = static_cast<std::size_t>(index);
    file.points.push_back(lines[i].point);
    CenterlinePoint& point = file.points.back();
    if (parents[i] != kNoPoint) {
      point.parent = place[static_cast<std::size_t>(parents[i])];
      point.vessel = file.points[static_cast<std::size_t>(point.parent)].vessel;
    }
    const auto named = parser.vessels().find(lines[i].id);
    if (named == parser.vessels().end()) continue;
    point.vessel = static_cast<std::int32_t>(file.vessels.size());
    file.vessels.push_back(named->second);
  }
  if (!file.isOfLumen) {
    parser.comments.apply(file);
    attachTrees(file);
  }
  fillRadii(file, shown, "one at some point at least (its sixth column)");
  return file;
}

CenterlineFile readSwc(const InputFile& file) {
  return parseSwc(file.read("centerline", kMostText), file.path().string());
}

}  // namespace lumen::convert
