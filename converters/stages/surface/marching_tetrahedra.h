// SPDX-License-Identifier: Apache-2.0
// The surface between inside and outside on a complex of tetrahedra. Some edges are cut although
// both of their ends are inside.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lumen::convert {

/// A crossing of an edge: near its end `inside`, towards `outside`. An edge that is split has one
/// at each end.
struct Crossing {
  std::uint32_t inside = 0, outside = 0;
  friend bool operator==(const Crossing&, const Crossing&) = default;
  friend bool operator<(const Crossing& a, const Crossing& b) { return a.key() < b.key(); }

private:
  [[nodiscard]] std::uint64_t key() const { return std::uint64_t{inside} << 32 | outside; }
};

using CrossingTriangle = std::array<Crossing, 3>;

/// Edges with both ends inside that the surface crosses twice. Each has a point of its own between
/// the crossings, outside.
class SplitEdges {
public:
  /// Pairs (u, v) with u < v, in any order, with repetitions; `firstPoint` is the number of the
  /// first edge's point.
  SplitEdges(std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, std::uint32_t firstPoint);

  static constexpr std::uint32_t kNone = UINT32_MAX;
  /// The point on an edge, or kNone.
  [[nodiscard]] std::uint32_t pointOn(std::uint32_t u, std::uint32_t v) const;
  /// The edge that a point is on.
  [[nodiscard]] const std::pair<std::uint32_t, std::uint32_t>& edgeOf(std::uint32_t point) const {
    return m_edge[point - m_first];
  }
  [[nodiscard]] std::uint32_t firstPoint() const { return m_first; }
  [[nodiscard]] bool empty() const { return m_edge.empty(); }
  [[nodiscard]] std::size_t size() const { return m_edge.size(); }

private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> m_edge;  // ascending
  std::uint32_t m_first;
};

/// Adds the triangles of one tetrahedron of positive volume, counter-clockwise seen from outside.
/// isInside(vertex) is called for vertices below split.firstPoint(). A tetrahedron with split edges
/// is bisected at their points, the least edge first, so that neighbours agree about their face.
template <class IsInside>
void marchTetrahedron(const std::array<std::uint32_t, 4>& t, const SplitEdges& split,
                      const IsInside& isInside, std::vector<CrossingTriangle>& out);

// Implementation of the template.
namespace detail {

inline void marchUnsplit(const std::array<std::uint32_t, 4>& t, unsigned inside,
                         std::vector<CrossingTriangle>& out) {
  // even permutations that put one vertex, or the pair that is inside, first
  static constexpr std::uint8_t kFirst[4][4] = {
      {0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
  static constexpr std::uint8_t kPair[6][5] = {{0b0011, 0, 1, 2, 3}, {0b0101, 0, 2, 3, 1},
                                               {0b1001, 0, 3, 1, 2}, {0b0110, 1, 2, 0, 3},
                                               {0b1010, 1, 3, 2, 0}, {0b1100, 2, 3, 0, 1}};
  const auto cross = [&](std::uint8_t in, std::uint8_t outside) {
    return Crossing{t[in], t[outside]};
  };
  for (unsigned v = 0; v < 4; ++v) {
    const auto& p = kFirst[v];
    if (inside == 1U << v) out.push_back({cross(p[0], p[1]), cross(p[0], p[2]), cross(p[0], p[3])});
    if (inside == (15U ^ 1U << v))
      out.push_back({cross(p[1], p[0]), cross(p[3], p[0]), cross(p[2], p[0])});
  }
  for (const auto& p : kPair) {
    if (inside != p[0]) continue;
    const std::uint8_t a = p[1], b = p[2], c = p[3], d = p[4];
    out.push_back({cross(b, d), cross(b, c), cross(a, c)});
    out.push_back({cross(b, d), cross(a, c), cross(a, d)});
  }
}

}  // namespace detail

template <class IsInside>
void marchTetrahedron(const std::array<std::uint32_t, 4>& t, const SplitEdges& split,
                      const IsInside& isInside, std::vector<CrossingTriangle>& out) {
  unsigned inside = 0;
  for (unsigned v = 0; v < 4; ++v)
    if (t[v] < split.firstPoint() && isInside(t[v])) inside |= 1U << v;
  if (inside == 0) return;
  if (!split.empty()) {
    std::uint32_t least = SplitEdges::kNone;
    std::size_t at = 0, to = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        if ((inside >> i & 1U) == 0 || (inside >> j & 1U) == 0) continue;
        const std::uint32_t point = split.pointOn(t[i], t[j]);
        if (point >= least) continue;
        least = point;
        at = i;
        to = j;
      }
    if (least != SplitEdges::kNone) {
      std::array<std::uint32_t, 4> one = t, other = t;
      one[at] = least;
      other[to] = least;
      marchTetrahedron(one, split, isInside, out);
      marchTetrahedron(other, split, isInside, out);
      return;
    }
  }
  if (inside != 15) detail::marchUnsplit(t, inside, out);
}

}  // namespace lumen::convert
