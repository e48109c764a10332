// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/pushed_tool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace lumen::test {

namespace {

constexpr int kPoints = 200;
constexpr double kAside = 0.2;    // of the radius
constexpr double kAdvance = 0.5;  // of the least radius: a step

using Point = std::array<double, 3>;

/// The nodes from a root to a tip, and how far along each of them is.
class ToolPath {
public:
  ToolPath(const blob_model* model, std::uint32_t tip) {
    for (auto node = static_cast<std::int32_t>(tip); node >= 0; node = m_nodes.back().parent) {
      m_index.push_back(static_cast<std::uint32_t>(node));
      m_nodes.push_back(blob_model_node(model, m_index.back()));
    }
    std::reverse(m_index.begin(), m_index.end());
    std::reverse(m_nodes.begin(), m_nodes.end());
    m_along.push_back(0);
    for (std::size_t i = 1; i < m_nodes.size(); ++i) {
      const double *a = m_nodes[i - 1].centre, *b = m_nodes[i].centre;
      m_along.push_back(m_along.back() + std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
    }
  }

  [[nodiscard]] std::uint32_t root() const { return m_index.front(); }
  [[nodiscard]] double length() const { return m_along.back(); }
  [[nodiscard]] const blob_node& tip() const { return m_nodes.back(); }
  [[nodiscard]] double leastRadius() const {
    return std::min_element(m_nodes.begin(), m_nodes.end(),
                            [](const auto& a, const auto& b) { return a.radius < b.radius; })
        ->radius;
  }

  /// From the tip to a node, along the way; infinite if the node is not on it.
  [[nodiscard]] double fromTip(std::uint32_t node) const {
    const auto found = std::find(m_index.begin(), m_index.end(), node);
    if (found == m_index.end()) return std::numeric_limits<double>::infinity();
    return length() - m_along[static_cast<std::size_t>(found - m_index.begin())];
  }

  struct Station {
    Point place;
    double radius;
  };
  /// Where a point is that has come so far.
  [[nodiscard]] Station at(double along) const {
    const auto next = std::upper_bound(m_along.begin() + 1, m_along.end() - 1, along);
    const auto i = static_cast<std::size_t>(next - m_along.begin());
    const blob_node &a = m_nodes[i - 1], &b = m_nodes[i];
    const double edge = m_along[i] - m_along[i - 1];
    const double t = edge > 0 ? std::clamp((along - m_along[i - 1]) / edge, 0.0, 1.0) : 1.0;
    Station station{{}, a.radius + t * (b.radius - a.radius)};
    for (std::size_t k = 0; k < 3; ++k)
      station.place[k] = a.centre[k] + t * (b.centre[k] - a.centre[k]);
    return station;
  }

private:
  std::vector<std::uint32_t> m_index;
  std::vector<blob_node> m_nodes;
  std::vector<double> m_along;
};

/// A point in a ball around zero, the same on every machine.
Point inBall(std::mt19937& random, double radius) {
  const auto uniform = [&random] { return 2 * (static_cast<double>(random()) / 4294967295.0) - 1; };
  for (;;) {
    const Point p = {uniform(), uniform(), uniform()};
    if (p[0] * p[0] + p[1] * p[1] + p[2] * p[2] <= 1)
      return {radius * p[0], radius * p[1], radius * p[2]};
  }
}

/// How far outside a point is, mm; 0 inside.
double outside(const blob_model* model, const Point& point, std::uint32_t cursor) {
  blob_sample sample;
  blob_query(model, BLOB_DISTANCE_EXACT, point.data(), &cursor, &sample);
  return (sample.state & BLOB_INSIDE) != 0 ? 0 : sample.distance;
}

/// Puts one point to a place of the way, displaced, and back inside if it is outside.
Point contact(const blob_model* model, const ToolPath::Station& station, std::mt19937& random,
              std::uint32_t& cursor, PushedTool& tool) {
  Point point = inBall(random, kAside * station.radius);
  for (std::size_t k = 0; k < 3; ++k) point[k] += station.place[k];
  blob_sample sample;
  blob_query(model, BLOB_BLENDED, point.data(), &cursor, &sample);
  if ((sample.state & BLOB_INSIDE) != 0) return point;
  tool.pushedBack = std::max(tool.pushedBack, outside(model, point, cursor));
  for (std::size_t k = 0; k < 3; ++k) point[k] -= sample.distance * sample.normal[k];
  cursor = blob_cursor_follow(model, point.data(), cursor);
  const double left = outside(model, point, cursor);
  if (left > tool.outside) {
    tool.outside = left;
    tool.outsideNode = cursor;
    std::copy(point.begin(), point.end(), tool.outsideAt);
  }
  return point;
}

/// One push along a way, by a tool whose points are so far apart.
PushedTool push(const blob_model* model, std::uint32_t tip, double spacing) {
  const ToolPath path(model, tip);
  PushedTool tool;
  tool.tip = tip;
  tool.length = path.length();
  std::mt19937 random(1);
  std::vector<std::uint32_t> cursors(kPoints, path.root());
  const double steps = std::ceil(path.length() / (kAdvance * path.leastRadius()));
  Point head{};
  for (double step = 0; step <= steps; ++step)
    for (int i = 0; i < kPoints; ++i) {
      const double along = path.length() * step / steps - spacing * i;
      if (along < 0) break;  // not yet in
      const Point place =
          contact(model, path.at(along), random, cursors[static_cast<std::size_t>(i)], tool);
      if (i == 0) head = place;
    }
  const double* end = path.tip().centre;
  tool.fromTip = std::hypot(head[0] - end[0], head[1] - end[1], head[2] - end[2]);
  tool.cursorFromTip = path.fromTip(cursors.front());
  return tool;
}

}  // namespace

std::vector<PushedTool> pushToEveryTip(const blob_model* model) {
  const auto count = static_cast<std::uint32_t>(blob_model_describe(model).node_count);
  std::vector<bool> hasChild(count, false);
  for (std::uint32_t node = 0; node < count; ++node)
    if (const std::int32_t parent = blob_model_node(model, node).parent; parent >= 0)
      hasChild[static_cast<std::size_t>(parent)] = true;
  std::vector<std::uint32_t> tips;
  double longest = 0;
  for (std::uint32_t node = 0; node < count; ++node) {
    if (hasChild[node] || blob_model_node(model, node).parent < 0) continue;
    tips.push_back(node);
    longest = std::max(longest, ToolPath(model, node).length());
  }
  std::vector<PushedTool> tools;
  for (const std::uint32_t tip : tips) tools.push_back(push(model, tip, longest / (kPoints - 1)));
  return tools;
}

std::vector<std::uint32_t> firstClosedNodes(const blob_model* model) {
  constexpr int kSteps = 64;
  const std::size_t count = blob_model_describe(model).node_count;
  std::vector<std::uint32_t> cursors(count), closed;
  std::vector<bool> isBeyond(count, false);
  for (std::uint32_t node = 0; node < count; ++node) {
    const blob_node to = blob_model_node(model, node);
    const bool isRoot = to.parent < 0;
    const auto parent = isRoot ? node : static_cast<std::uint32_t>(to.parent);
    const blob_node from = blob_model_node(model, parent);
    std::uint32_t& cursor = cursors[node] = isRoot ? node : cursors[parent];
    bool isOpen = true;
    for (int i = isRoot ? kSteps : 1; i <= kSteps; ++i) {
      double p[3];
      for (int k = 0; k < 3; ++k)
        p[k] = from.centre[k] + (to.centre[k] - from.centre[k]) * i / kSteps;
      isOpen = blob_inside(model, BLOB_BLENDED, p, &cursor) != 0 && isOpen;
    }
    isBeyond[node] = !isRoot && isBeyond[parent];
    if (isOpen || isBeyond[node]) continue;
    isBeyond[node] = true;
    closed.push_back(node);
  }
  return closed;
}

}  // namespace lumen::test
