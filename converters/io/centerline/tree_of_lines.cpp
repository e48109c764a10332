// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/tree_of_lines.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/io/centerline/join_curves.h"

namespace lumen::convert {
namespace {

constexpr std::int64_t kUnused = -2;

// The point before each; empty unless the lines determine it, and share a point.
std::vector<std::int64_t> pointsBefore(const LineSet& set) {
  std::vector<std::int64_t> before(set.points.size(), kUnused);
  std::vector<std::size_t> uses(before.size(), 0);
  for (const std::vector<std::int32_t>& line : set.lines)
    for (std::size_t i = 0; i < line.size(); ++i) {
      const auto point = static_cast<std::size_t>(line[i]);
      ++uses[point];
      if (i == 0) {
        if (before[point] == kUnused) before[point] = kNoPoint;
        continue;
      }
      const std::int64_t previous = line[i - 1];
      if (before[point] >= 0 && before[point] != previous) return {};
      before[point] = previous;
    }
  // separate lines are joined by their places instead
  if (std::none_of(uses.begin(), uses.end(), [](std::size_t n) { return n > 1; })) return {};
  return before;
}

// The tree of lines that share points; empty unless the lines determine each point's predecessor.
std::optional<CenterlineFile> sharedTree(const LineSet& set) {
  const std::vector<std::int64_t> before = pointsBefore(set);
  CenterlineFile file;
  std::int32_t vessels = 0;
  std::vector<std::int32_t> place(before.size(), kNoPoint);
  const auto add = [&](std::size_t i) {
    place[i] = static_cast<std::int32_t>(file.points.size());
    file.points.push_back(set.points[i]);
    file.points.back().parent =
        before[i] < 0 ? kNoPoint : place[static_cast<std::size_t>(before[i])];
    vessels = std::max(vessels, set.points[i].vessel + 1);
  };
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t at = i; before[at] != kUnused && place[at] == kNoPoint;) {
      open.push_back(at);
      if (before[at] < 0) break;
      at = static_cast<std::size_t>(before[at]);
      if (open.size() > before.size()) return std::nullopt;  // a cycle
    }
    for (; !open.empty(); open.pop_back()) add(open.back());
  }
  if (file.points.empty()) return std::nullopt;
  file.vessels.resize(static_cast<std::size_t>(vessels));
  return file;
}

std::optional<CenterlineFile> joinedLines(const LineSet& set) {
  if (set.lines.size() > kMostParts) return std::nullopt;
  std::vector<CenterlineCurve> curves;
  for (const std::vector<std::int32_t>& line : set.lines) {
    CenterlineCurve curve;
    for (const std::int32_t index : line) {
      const CenterlinePoint& point = set.points[static_cast<std::size_t>(index)];
      curve.points.push_back({point.position, point.radius});
    }
    if (!curve.points.empty()) curves.push_back(std::move(curve));
  }
  return joinCurves(curves);
}

bool namesVessels(const LineSet& set) {
  return std::any_of(set.points.begin(), set.points.end(),
                     [](const CenterlinePoint& point) { return point.vessel != kNoVessel; });
}

// The trees of lines in the file's directions, if their graph has no better ones.
std::optional<CenterlineFile> treeAsDrawn(const LineSet& cells, const LineSet& courses,
                                          const LineGraph* graph) {
  std::optional<CenterlineFile> file = sharedTree(cells);
  const bool hasVessels = file && namesVessels(cells);
  if (!file) file = joinedLines(courses);
  if (file && graph != nullptr && !graph->agreesWith(*file, hasVessels)) file.reset();
  return file;
}

LineSet withoutTurns(LineSet set, const std::vector<bool>& turned) {
  for (std::size_t i = 0; i < set.lines.size(); ++i) {
    std::vector<std::int32_t>& line = set.lines[i];
    if (turned[i]) std::reverse(line.begin(), line.end());
    line.erase(std::unique(line.begin(), line.end()), line.end());
  }
  return set;
}

std::string turnedRemark(const std::vector<bool>& turned) {
  const auto count = std::count(turned.begin(), turned.end(), true);
  if (count == 0) return {};
  return std::to_string(count) + " of its " + std::to_string(turned.size()) +
         (count == 1 ? " lines runs towards the root, and is turned"
                     : " lines run towards the root, and are turned");
}

[[noreturn]] void refuseNumber(const LineSet& courses, const std::string& name) {
  throw invalidInput(name + ": has " + std::to_string(courses.lines.size()) +
                     " lines; expected at most 10000, one for each vessel or way to a tip");
}

// The trees of lines that do not give the trees of their graph as they are drawn.
CenterlineFile mended(const LineSet& courses, const LineGraph& graph, const std::string& name) {
  if (graph.partCount() > kMostParts) refuseNumber(courses, name);
  const std::vector<bool> turned = graph.turnedLines();
  const std::string turns = turnedRemark(turned);
  std::optional<CenterlineFile> file;
  if (!turns.empty()) {
    const LineSet straight = withoutTurns(courses, turned);
    file = treeAsDrawn(straight, straight, &graph);
  }
  if (!file) file = graph.tree();
  if (courses.isDirected && !turns.empty()) file->remarks.push_back(turns);
  if (const std::string remark = graph.rootRemark(); !remark.empty())
    file->remarks.push_back(remark);
  return *std::move(file);
}

}  // namespace

CenterlineFile treeOfLines(const LineSet& cells, const LineSet& courses, bool isExact,
                           const std::string& name) {
  if (isExact) {
    std::optional<CenterlineFile> own = treeAsDrawn(cells, courses, nullptr);
    if (!own) refuseNumber(courses, name);
    return *std::move(own);
  }
  const LineGraph graph(courses);
  std::optional<CenterlineFile> file = treeAsDrawn(cells, courses, &graph);
  if (!file) file = mended(courses, graph, name);
  attachTrees(*file);
  return *std::move(file);
}

CenterlineFile treeOfGraph(const LineSet& lines, const std::string& name) {
  const LineGraph graph(lines);
  if (graph.partCount() > kMostParts)
    throw invalidInput(name + ": has " + std::to_string(graph.partCount()) +
                       " parts without a connection; expected at most 10000");
  CenterlineFile file = graph.tree();
  if (const std::string remark = graph.rootRemark(); !remark.empty())
    file.remarks.push_back(remark);
  attachTrees(file);
  return file;
}

}  // namespace lumen::convert
