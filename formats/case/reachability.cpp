// SPDX-License-Identifier: Apache-2.0
#include "formats/case/reachability.h"

#include <algorithm>
#include <cmath>

#include "formats/case/topology.h"

namespace lumen::formats {
namespace {

/// Length of a step, as a share of the lesser radius. Steps of an eighth passed over walls in a
/// case of 165 vessels that a tool with finer steps met.
constexpr double kStep = 0.03125;
/// Steps along one edge: bounds the work where an edge is long and thin beyond reason.
constexpr double kMostSteps = 512;

field::Vec centreOf(const CenterlineTree& tree, std::uint32_t node) {
  const Vec3f& c = tree.centre[node];
  return {double{c.x}, double{c.y}, double{c.z}};
}

/// A pushed point and its cursor.
class Pushed {
public:
  Pushed(const CenterlineTree& tree, const field::BlendedField& field,
         const ReportClosedPlace& report)
      : m_tree(tree), m_field(field), m_report(report) {}

  /// Puts the point at a node's own centre.
  void put(std::uint32_t node) {
    m_cursor = node;
    moveTo(centreOf(m_tree, node));
  }

  /// Pushes the point along the edge that leads to a node, with the cursor of the node's parent.
  /// True if the point stayed inside.
  bool along(std::uint32_t node, std::uint32_t cursor) {
    const auto parent = static_cast<std::uint32_t>(m_tree.parent[node]);
    const field::Vec from = centreOf(m_tree, parent), to = centreOf(m_tree, node);
    const double length = std::hypot(to.x - from.x, to.y - from.y, to.z - from.z);
    const double radius = double{std::min(m_tree.radius[node], m_tree.radius[parent])};
    const double count = std::clamp(std::ceil(length / (kStep * radius)), 1.0, kMostSteps);
    m_cursor = cursor;
    bool isOpen = true;
    for (double i = 1; i <= count; ++i) {
      const double t = i / count;
      moveTo({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y),
              from.z + t * (to.z - from.z)});
      if (isInside()) continue;
      isOpen = false;
      if (!report(node)) break;
    }
    return isOpen;
  }

  [[nodiscard]] bool isInside() const {
    return m_field.blended<1>(m_place, m_cursor).value > m_field.level();
  }
  [[nodiscard]] bool report(std::uint32_t node) const {
    return m_report({node, m_place, m_cursor});
  }
  [[nodiscard]] std::uint32_t cursor() const { return m_cursor; }

private:
  void moveTo(const field::Vec& place) {
    m_place = place;
    m_cursor = m_field.follow(place, m_cursor);
  }

  const CenterlineTree& m_tree;
  const field::BlendedField& m_field;
  const ReportClosedPlace& m_report;
  field::Vec m_place{};
  std::uint32_t m_cursor = 0;
};

}  // namespace

void findClosedPlaces(const CenterlineTree& tree, const field::BlendedField& field,
                      const ReportClosedPlace& report, const std::function<void()>& check) {
  std::vector<std::uint32_t> cursor(tree.nodeCount());
  Pushed point(tree, field, report);
  for (std::uint32_t node = 0; node < cursor.size(); ++node) {
    if (check) check();
    if (tree.parent[node] == kNoParent) {
      point.put(node);
      if (!point.isInside()) static_cast<void>(point.report(node));
    } else if (!point.along(node, cursor[static_cast<std::size_t>(tree.parent[node])])) {
      point.put(node);
    }
    cursor[node] = point.cursor();
  }
}

Reachability measureReachability(const CenterlineTree& tree, const field::BlendedField& field,
                                 const std::function<void()>& check) {
  Reachability result;
  std::vector<std::int32_t>& barrier = result.barrierOf;
  barrier.assign(tree.nodeCount(), -1);
  std::vector<ClosedPlace> closed;  // in node order
  findClosedPlaces(
      tree, field,
      [&](const ClosedPlace& place) {
        closed.push_back(place);
        return false;
      },
      check);
  auto next = closed.begin();
  for (std::uint32_t node = 0; node < barrier.size(); ++node) {
    const bool isClosed = next != closed.end() && next->node == node;
    if (tree.parent[node] != kNoParent)
      barrier[node] = barrier[static_cast<std::size_t>(tree.parent[node])];
    if (isClosed && barrier[node] < 0) {
      barrier[node] = static_cast<std::int32_t>(result.barriers.size());
      result.barriers.push_back({node, next->place, 0});
    }
    if (isClosed) ++next;
    const double length = edgeLength(tree, node);
    result.total += length;
    const auto before = static_cast<std::size_t>(barrier[node]);
    (barrier[node] < 0 ? result.reachable : result.barriers[before].beyond) += length;
  }
  return result;
}

}  // namespace lumen::formats
