// SPDX-License-Identifier: Apache-2.0
// Cheapest paths between voxels: E. W. Dijkstra, "A note on two problems in connexion with graphs",
// 1959.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace lumen::convert {

/// Verdict on a voxel that a search has reached.
enum class SearchStep : std::uint8_t { GoOn, GoNoFurther, Stop };

/// Cheapest paths from one voxel to others, over voxels that the caller numbers. Buffers are reused
/// by the next search.
class CheapestPaths {
public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr float kInfiniteCost = std::numeric_limits<float>::infinity();

  explicit CheapestPaths(std::size_t count = 0)
      : m_cost(count, kInfiniteCost), m_before(count, kNone) {}

  [[nodiscard]] std::size_t count() const { return m_cost.size(); }

  /// Excludes a voxel that was not reached from every search, unless the search begins there.
  void block(std::uint32_t i) { m_cost[i] = -kInfiniteCost; }

  /// Forgets the paths of the previous search; blocked voxels stay blocked.
  void clear() {
    for (const std::uint32_t i : m_reached) {
      m_cost[i] = kInfiniteCost;
      m_before[i] = kNone;
    }
    m_reached.clear();
    m_queue.clear();
  }

  /// Visits voxels by rising cost of the path to them, then by their number. `eachStep(i, reach)`
  /// calls `reach(j, step)` for the voxels j beside i, where step() >= 0 is the cost of the step,
  /// infinite if it is impossible; step() is called only if j may gain by it, and reach() returns
  /// whether it did. `visit(i, cost)` returns a SearchStep. Voxels of the previous search stay
  /// reached, until clear().
  template <class EachStep, class Visit>
  void run(std::uint32_t start, const EachStep& eachStep, const Visit& visit) {
    reach(start, kNone, 0);
    while (!m_queue.empty()) {
      const auto [cost, i] = m_queue.front();
      std::pop_heap(m_queue.begin(), m_queue.end(), std::greater<>());
      m_queue.pop_back();
      if (cost > m_cost[i]) continue;
      const SearchStep then = visit(i, cost);
      if (then == SearchStep::Stop) return;
      if (then == SearchStep::GoNoFurther) continue;
      eachStep(i, [this, here = i, so = cost](std::uint32_t j, const auto& step) {
        if (!(so < m_cost[j])) return false;
        const float there = so + step();
        if (!(there < m_cost[j])) return false;
        reach(j, here, there);
        return true;
      });
    }
  }

  /// Voxels that were reached, in the order in which they first were.
  [[nodiscard]] const std::vector<std::uint32_t>& reached() const { return m_reached; }
  [[nodiscard]] float cost(std::uint32_t i) const { return m_cost[i]; }
  /// The predecessor on the cheapest path; kNone for the first voxel, and for those not reached.
  [[nodiscard]] std::uint32_t before(std::uint32_t i) const { return m_before[i]; }

  /// The path to a voxel that was reached, from the first voxel for which isStart() holds, or else
  /// from the start of the search.
  template <class IsStart>
  [[nodiscard]] std::vector<std::uint32_t> pathTo(std::uint32_t i, const IsStart& isStart) const {
    std::vector<std::uint32_t> path;
    for (; i != kNone; i = m_before[i]) {
      path.push_back(i);
      if (isStart(i)) break;
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

private:
  void reach(std::uint32_t i, std::uint32_t from, float cost) {
    if (m_before[i] == kNone) m_reached.push_back(i);
    m_cost[i] = cost;
    m_before[i] = from;
    m_queue.emplace_back(cost, i);
    std::push_heap(m_queue.begin(), m_queue.end(), std::greater<>());
  }

  std::vector<float> m_cost;
  std::vector<std::uint32_t> m_before;
  std::vector<std::uint32_t> m_reached;
  std::vector<std::pair<float, std::uint32_t>> m_queue;  ///< a heap, the cheapest first
};

}  // namespace lumen::convert
