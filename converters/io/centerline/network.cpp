// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/statistics.h"
#include "converters/base/text.h"
#include "converters/io/centerline/tree_of_lines.h"

namespace lumen::convert {
namespace {

using Index = std::int32_t;

constexpr double kSameNode = 1e-3;  // of the step behind a node
// Relative error of chords: programs smooth the courses that they measure.
constexpr double kChordError = 0.1;
constexpr double kIsOne = 0.02;
constexpr double kBetter = 0.5;         // error of factors that count, beside that without them
constexpr double kLargestRatio = 1e12;  // of squared lengths, far beyond any voxel
constexpr std::size_t kLeastEdges = 3;  // for each factor

std::size_t nodeSlot(Index index) {
  return static_cast<std::size_t>(index);
}

Eigen::Vector3d spanOf(const Network& network, const NetworkEdge& edge) {
  return network.nodes[nodeSlot(edge.to)].position - network.nodes[nodeSlot(edge.from)].position;
}

// Points of an edge from its first node to its last, without those that repeat these.
std::vector<CurvePoint> interiorOf(const Network& network, const NetworkEdge& edge) {
  std::vector<CurvePoint> course = edge.course;
  const auto from = [&](Index node, const CurvePoint& end) {
    return (network.nodes[nodeSlot(node)].position - end.position).norm();
  };
  if (!course.empty() && from(edge.from, course.front()) + from(edge.to, course.back()) >
                             from(edge.to, course.front()) + from(edge.from, course.back()))
    std::reverse(course.begin(), course.end());
  const auto repeats = [&](Index node, const CurvePoint& end, const CurvePoint& next) {
    return from(node, end) <= kSameNode * (next.position - end.position).norm();
  };
  const std::size_t count = course.size();
  if (count > 1) {
    const bool isLast = repeats(edge.to, course[count - 1], course[count - 2]);
    const bool isFirst = repeats(edge.from, course[0], course[1]);
    if (isLast) course.pop_back();
    if (isFirst) course.erase(course.begin());
    return course;
  }
  const Eigen::Vector3d span = spanOf(network, edge);
  const double length = span.norm();
  if (count == 1 || !(edge.radius > 0) || !(length > 0)) return course;
  for (const bool atEnd : {false, true}) {
    const CurvePoint& node = network.nodes[nodeSlot(atEnd ? edge.to : edge.from)];
    const double away = std::min(node.radius, length / 3) * (atEnd ? -1 : 1);
    course.push_back({node.position + span * (away / length), edge.radius});
  }
  return course;
}

// Nodes without radius take the widest of their edges.
void fillNodes(Network& network) {
  std::vector<double> widest(network.nodes.size(), 0);
  for (const NetworkEdge& edge : network.edges) {
    const bool has = !edge.course.empty();
    for (const bool atEnd : {false, true}) {
      double& radius = widest[nodeSlot(atEnd ? edge.to : edge.from)];
      const double here =
          has ? (atEnd ? edge.course.back().radius : edge.course.front().radius) : 0;
      radius = std::max({radius, edge.radius, here});
    }
  }
  for (std::size_t n = 0; n < widest.size(); ++n)
    if (!(network.nodes[n].radius > 0)) network.nodes[n].radius = widest[n];
}

LineSet linesOfNetwork(const Network& network) {
  LineSet set;
  set.isDirected = false;
  const auto add = [&](const CurvePoint& point) {
    set.points.push_back({point.position, point.radius, kNoPoint, 0, kNoVessel});
    return static_cast<Index>(set.points.size() - 1);
  };
  for (const CurvePoint& node : network.nodes) add(node);
  for (const NetworkEdge& edge : network.edges) {
    std::vector<Index>& line = set.lines.emplace_back();
    line.push_back(edge.from);
    for (const CurvePoint& point : interiorOf(network, edge)) line.push_back(add(point));
    line.push_back(edge.to);
  }
  return set;
}

std::size_t nodesWithoutEdges(const Network& network) {
  std::vector<bool> isUsed(network.nodes.size(), false);
  for (const NetworkEdge& edge : network.edges)
    isUsed[nodeSlot(edge.from)] = isUsed[nodeSlot(edge.to)] = true;
  return static_cast<std::size_t>(std::count(isUsed.begin(), isUsed.end(), false));
}

// Squares of spans, divided by the squares of their chords.
std::vector<Eigen::Vector3d> squaredSpans(const Network& network) {
  std::vector<Eigen::Vector3d> spans;
  for (const NetworkEdge& edge : network.edges) {
    const Eigen::Vector3d span = spanOf(network, edge);
    if (!(edge.chord > 0)) continue;
    const Eigen::Vector3d squares = (span / edge.chord).cwiseAbs2();
    if (squares.sum() >= 1 / kLargestRatio && squares.sum() <= kLargestRatio)
      spans.push_back(squares);
  }
  return spans;
}

// Median of the differences of chords by squared factors from those stated.
double errorOf(const std::vector<Eigen::Vector3d>& spans, const Eigen::Vector3d& squares) {
  std::vector<double> errors;
  for (const Eigen::Vector3d& span : spans)
    errors.push_back(std::abs(std::sqrt(std::max(0.0, span.dot(squares))) - 1));
  return upperMedian(errors);
}

}  // namespace

std::optional<Eigen::Vector3d> voxelsOfNetwork(const Network& network) {
  const std::vector<Eigen::Vector3d> spans = squaredSpans(network);
  if (spans.empty()) return {};
  const double asStated = errorOf(spans, Eigen::Vector3d::Ones());
  if (asStated <= kIsOne) return {};
  Eigen::Vector3d best = Eigen::Vector3d::Ones();
  double error = asStated;
  // cubes, voxels of other height, and any others: the fewest factors that state the lengths
  for (const std::array<int, 3>& factorOf : {std::array{0, 0, 0}, {0, 0, 1}, {0, 1, 2}}) {
    const int count = factorOf[2] + 1;
    if (spans.size() < kLeastEdges * static_cast<std::size_t>(count)) break;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (const Eigen::Vector3d& span : spans) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(count);
      for (int a = 0; a < 3; ++a) row[factorOf[std::size_t(a)]] += span[a];
      normal += row * row.transpose();
      right += row;
    }
    const Eigen::VectorXd solved = normal.ldlt().solve(right);
    Eigen::Vector3d squares;
    for (int a = 0; a < 3; ++a) squares[a] = solved[factorOf[std::size_t(a)]];
    if (!squares.allFinite() || !((squares.array() > 0).all()) ||
        squares.maxCoeff() > kLargestRatio || errorOf(spans, squares) >= kBetter * error)
      continue;
    best = squares;
    error = errorOf(spans, squares);
  }
  if (error > kChordError || error >= asStated) return {};
  return Eigen::Vector3d(best.cwiseSqrt());
}

void takeOwnFrame(std::string_view text, CenterlineFile& file) {
  constexpr std::size_t kHead = 256;  // limit of the comment's place
  if (text.substr(0, kHead).find(kOwnCenterline) == text.npos) return;
  file.unit = 1;
  file.axes = CenterlineAxes::Lps;
}

CenterlineFile treeOfNetwork(Network network, const std::string& name) {
  if (network.edges.empty())
    throw invalidInput(name + ": has " + counted(network.nodes.size(), "node", "nodes") +
                       " but no edges; expected edges, which are the vessels");
  const std::optional<Eigen::Vector3d> voxels = voxelsOfNetwork(network);
  if (voxels) {
    for (CurvePoint& node : network.nodes) node.position = node.position.cwiseProduct(*voxels);
    for (NetworkEdge& edge : network.edges)
      for (CurvePoint& point : edge.course) point.position = point.position.cwiseProduct(*voxels);
  }
  fillNodes(network);
  const LineSet lines = linesOfNetwork(network);
  CenterlineFile file = treeOfGraph(lines, name);
  if (file.points.empty())
    throw invalidInput(name +
                       ": all of its edges lie at one place each; expected edges with a "
                       "length");
  if (voxels)
    file.remarks.push_back("by the lengths of its edges, places are voxels of " +
                           spacingText(*voxels, 4) + "; they are multiplied by these");
  if (const std::size_t left = nodesWithoutEdges(network); left > 0)
    file.remarks.push_back(counted(left, "node has", "nodes have") + " no edge, and " +
                           (left == 1 ? "is" : "are") + " left out");
  return file;
}

}  // namespace lumen::convert
