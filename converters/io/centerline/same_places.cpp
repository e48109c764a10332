// SPDX-License-Identifier: Apache-2.0
// Points at equal places; declared in line_graph.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "converters/geometry/disjoint_sets.h"
#include "converters/io/centerline/line_graph.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Index = std::int32_t;

// Share of the steps beside an end within which another point is at its place: ten times nearer
// than the next point of either line.
constexpr double kSameShare = 0.1;

// Points in cubic cells of one size.
class Cells {
public:
  explicit Cells(double size) : m_size(size) {}

  void add(const Vector3d& p, Index point) { m_points[cellOf(p)].push_back(point); }

  template <class Visit>
  void forNear(const Vector3d& p, const Visit& visit) const {
    const Cell middle = cellOf(p);
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = m_points.find({middle[0] + x, middle[1] + y, middle[2] + z});
          if (found == m_points.end()) continue;
          for (const Index point : found->second) visit(point);
        }
  }

private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t hash = 0;
      for (const std::int64_t c : cell)
        hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15U;
      return static_cast<std::size_t>(hash ^ hash >> 29);
    }
  };
  [[nodiscard]] Cell cellOf(const Vector3d& p) const {
    constexpr double kFarthest = 9e18;  // still an integer
    Cell cell;
    for (std::size_t a = 0; a < 3; ++a)
      cell[a] = static_cast<std::int64_t>(
          std::clamp(std::floor(p[static_cast<Eigen::Index>(a)] / m_size), -kFarthest, kFarthest));
    return cell;
  }

  double m_size;
  std::unordered_map<Cell, std::vector<Index>, Hash> m_points;
};

class Merger {
public:
  explicit Merger(const LineSet& set)
      : m_set(set),
        m_sets(set.points.size()),
        m_step(set.points.size(), std::numeric_limits<double>::infinity()) {}

  std::vector<Index> merged() {
    measure();
    mergeRounded();
    mergeEnds();
    std::vector<Index> node(m_set.points.size());
    for (std::size_t i = 0; i < node.size(); ++i)
      node[i] = static_cast<Index>(m_sets.find(static_cast<std::uint32_t>(i)));
    return node;
  }

private:
  [[nodiscard]] const Vector3d& at(Index point) const {
    return m_set.points[std::size_t(point)].position;
  }
  void join(Index a, Index b) {
    m_sets.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
  }

  // The least step beside each point, the ends, and the rounding of the coordinates.
  void measure() {
    double largest = 0;
    for (const std::vector<Index>& line : m_set.lines) {
      for (std::size_t i = 0; i < line.size(); ++i) {
        largest = std::max(largest, at(line[i]).cwiseAbs().maxCoeff());
        if (i == 0) continue;
        const double step = (at(line[i]) - at(line[i - 1])).norm();
        if (!(step > 0)) continue;
        for (const Index point : {line[i], line[i - 1]})
          m_step[std::size_t(point)] = std::min(m_step[std::size_t(point)], step);
      }
      if (line.empty()) continue;
      m_ends.insert(line.front());
      m_ends.insert(line.back());
    }
    m_rounding = 2 * double{std::numeric_limits<float>::epsilon()} * largest;
  }

  // Merges points whose places differ by rounding.
  void mergeRounded() {
    if (!(m_rounding > 0)) m_rounding = std::numeric_limits<double>::min();
    Cells cells(m_rounding);
    for (const std::vector<Index>& line : m_set.lines)
      for (const Index point : line) {
        if (m_sets.find(static_cast<std::uint32_t>(point)) != static_cast<std::uint32_t>(point))
          continue;
        bool isNew = true;
        cells.forNear(at(point), [&](Index other) {
          if (other == point || (at(other) - at(point)).norm() > m_rounding) return;
          join(other, point);
          m_step[std::size_t(other)] =
              std::min(m_step[std::size_t(other)], m_step[std::size_t(point)]);
          isNew = false;
        });
        if (isNew && m_seen.insert(point).second) cells.add(at(point), point);
      }
  }

  // Merges ends with points that are far nearer than the next point of either line. Points with steps
  // of one power of two lie in one set of cells, so that few of them share a cell.
  void mergeEnds() {
    std::map<int, Cells> levels;
    const auto levelOf = [](double step) { return std::ilogb(step) + 1; };
    for (const Index point : m_seen) {
      const double step = m_step[std::size_t(point)];
      if (!std::isfinite(step)) continue;
      const int level = levelOf(step);
      levels.try_emplace(level, kSameShare * std::ldexp(1.0, level))
          .first->second.add(at(point), point);
    }
    for (const Index end : m_ends) {
      const double step = m_step[std::size_t(end)];
      for (const auto& [level, cells] : levels)
        cells.forNear(at(end), [&](Index other) {
          const double nearer = std::min(step, m_step[std::size_t(other)]);
          if ((at(other) - at(end)).norm() <= kSameShare * nearer) join(end, other);
        });
    }
  }

  const LineSet& m_set;
  DisjointSets m_sets;
  std::vector<double> m_step;
  std::set<Index> m_ends, m_seen;
  double m_rounding = 0;
};

}  // namespace

std::vector<std::int32_t> samePlaces(const LineSet& set) {
  return Merger(set).merged();
}

}  // namespace lumen::convert
