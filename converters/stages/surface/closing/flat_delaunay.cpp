// SPDX-License-Identifier: Apache-2.0
// Declared in flat_region.h.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "converters/geometry/exact_predicates.h"
#include "converters/stages/surface/closing/flat_region.h"

namespace lumen::convert {
namespace {

using Point = Eigen::Vector2d;

constexpr int kSmoothings = 6;      // by then points hardly move
constexpr double kRounding = 1e-9;  // a sine: angles that add up to 180 degrees but for rounding

double cross(const Point& a, const Point& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// A flat mesh whose edges know their triangles.
class FlatEdges {
public:
  explicit FlatEdges(FlatMesh& mesh) : m_mesh(mesh), m_firstNew(mesh.point.size()) {
    for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t) enter(t);
  }

  /// Nothing where the point is in no triangle, or on an edge.
  void insert(const Point& p) {
    const std::uint32_t t = locate(p);
    if (t >= m_mesh.triangle.size()) return;
    const Triangle old = m_mesh.triangle[t];
    const auto v = static_cast<std::uint32_t>(m_mesh.point.size());
    m_mesh.point.push_back(p);
    replace(t, {old[0], old[1], v});
    add({old[1], old[2], v});
    add({old[2], old[0], v});
    for (std::size_t i = 0; i < 3; ++i) m_doubtful.emplace_back(old[i], old[(i + 1) % 3]);
    flip();
  }

  void flipAll() {
    for (const Triangle& t : m_mesh.triangle)
      for (std::size_t i = 0; i < 3; ++i) m_doubtful.emplace_back(t[i], t[(i + 1) % 3]);
    flip();
  }

  /// Moves each new point to the middle of its neighbours, if no triangle turns over.
  void smooth() {
    std::vector<std::vector<std::uint32_t>> fan(m_mesh.point.size());
    for (std::uint32_t t = 0; t < m_mesh.triangle.size(); ++t)
      for (const std::uint32_t v : m_mesh.triangle[t]) fan[v].push_back(t);
    for (std::size_t v = m_firstNew; v < fan.size(); ++v) {
      Point sum = Point::Zero();  // sum of all corners: each neighbour twice
      for (const std::uint32_t t : fan[v])
        for (const std::uint32_t w : m_mesh.triangle[t])
          if (w != v) sum += m_mesh.point[w];
      const Point before = m_mesh.point[v];
      m_mesh.point[v] = sum / (2.0 * static_cast<double>(fan[v].size()));
      const bool isGood = std::all_of(fan[v].begin(), fan[v].end(), [this](std::uint32_t t) {
        const Triangle& corner = m_mesh.triangle[t];
        return side(corner[0], corner[1], m_mesh.point[corner[2]]) > 0;
      });
      if (!isGood) m_mesh.point[v] = before;
    }
  }

  void split(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t *one = find(a, b), *other = find(b, a);
    if (one == nullptr || other == nullptr) return;
    const std::uint32_t t = *one, u = *other, c = opposite(t, a, b), d = opposite(u, a, b);
    const auto v = static_cast<std::uint32_t>(m_mesh.point.size());
    m_mesh.point.push_back(0.5 * (m_mesh.point[a] + m_mesh.point[b]));
    replace(t, {a, v, c});
    replace(u, {b, v, d});
    add({v, b, c});
    add({v, a, d});
  }

private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }
  [[nodiscard]] const std::uint32_t* find(std::uint32_t a, std::uint32_t b) const {
    const auto found = m_triangleOf.find(key(a, b));
    return found == m_triangleOf.end() ? nullptr : &found->second;
  }
  [[nodiscard]] int side(std::uint32_t a, std::uint32_t b, const Point& p) const {
    return orientation(m_mesh.point[a], m_mesh.point[b], p);
  }
  [[nodiscard]] std::uint32_t opposite(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
    const Triangle& corner = m_mesh.triangle[t];
    return *std::find_if(corner.begin(), corner.end(),
                         [&](std::uint32_t v) { return v != a && v != b; });
  }
  void enter(std::uint32_t t) {
    const Triangle& corner = m_mesh.triangle[t];
    for (std::size_t i = 0; i < 3; ++i) m_triangleOf[key(corner[i], corner[(i + 1) % 3])] = t;
  }
  void add(const Triangle& corner) {
    m_mesh.triangle.push_back(corner);
    enter(static_cast<std::uint32_t>(m_mesh.triangle.size() - 1));
  }
  [[nodiscard]] bool isIn(std::uint32_t t, const Point& p) const {
    const Triangle& c = m_mesh.triangle[t];
    return side(c[0], c[1], p) > 0 && side(c[1], c[2], p) > 0 && side(c[2], c[0], p) > 0;
  }
  // The triangle around a point: by a walk from the last one, through edges that the point is
  // behind, or, if it ends at the boundary, by examining all. The number of triangles if none.
  [[nodiscard]] std::uint32_t locate(const Point& p) const {
    const auto count = static_cast<std::uint32_t>(m_mesh.triangle.size());
    std::uint32_t t = count - 1;
    for (std::uint32_t step = 0; step < count && !isIn(t, p); ++step) {
      const Triangle& c = m_mesh.triangle[t];
      const std::uint32_t* next = nullptr;
      for (std::size_t i = 0; i < 3 && next == nullptr; ++i)
        if (side(c[i], c[(i + 1) % 3], p) < 0) next = find(c[(i + 1) % 3], c[i]);
      if (next == nullptr) break;
      t = *next;
    }
    if (isIn(t, p)) return t;
    for (t = 0; t < count && !isIn(t, p);) ++t;
    return t;
  }
  // Edges of the old triangle are overwritten by whoever has them now, or erased.
  void replace(std::uint32_t t, const Triangle& corner) {
    const Triangle old = m_mesh.triangle[t];
    for (std::size_t i = 0; i < 3; ++i) m_triangleOf.erase(key(old[i], old[(i + 1) % 3]));
    m_mesh.triangle[t] = corner;
    enter(t);
  }

  // True if the angles opposite to the edge add up to more than 180 degrees and it can be flipped.
  [[nodiscard]] bool isBad(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                           std::uint32_t d) const {
    const Point ca = m_mesh.point[a] - m_mesh.point[c], cb = m_mesh.point[b] - m_mesh.point[c];
    const Point da = m_mesh.point[a] - m_mesh.point[d], db = m_mesh.point[b] - m_mesh.point[d];
    const double sine = cross(ca, cb) * db.dot(da) + cross(db, da) * ca.dot(cb);
    const double size = ca.norm() * cb.norm() * da.norm() * db.norm();
    return sine < -kRounding * size && side(a, d, m_mesh.point[c]) > 0 &&
           side(d, b, m_mesh.point[c]) > 0;
  }

  void flip() {
    while (!m_doubtful.empty()) {
      const auto [a, b] = m_doubtful.back();
      m_doubtful.pop_back();
      const std::uint32_t *one = find(a, b), *other = find(b, a);
      if (one == nullptr || other == nullptr) continue;
      const std::uint32_t t = *one, u = *other, c = opposite(t, a, b), d = opposite(u, a, b);
      if (!isBad(a, b, c, d)) continue;
      for (const auto& edge : {std::pair{a, b}, std::pair{b, a}})
        m_triangleOf.erase(key(edge.first, edge.second));
      m_mesh.triangle[t] = {a, d, c};
      m_mesh.triangle[u] = {d, b, c};
      enter(t);
      enter(u);
      for (const auto& edge : {std::pair{a, d}, std::pair{d, b}, std::pair{b, c}, std::pair{c, a}})
        m_doubtful.push_back(edge);
    }
  }

  FlatMesh& m_mesh;
  std::size_t m_firstNew;
  std::unordered_map<std::uint64_t, std::uint32_t> m_triangleOf;  ///< by directed edge
  std::vector<std::pair<std::uint32_t, std::uint32_t>> m_doubtful;
};

}  // namespace

void addInnerPoints(FlatMesh& mesh, const std::vector<Eigen::Vector2d>& points) {
  FlatEdges edges(mesh);
  edges.flipAll();
  for (const Point& p : points) edges.insert(p);
  for (int round = 0; round < kSmoothings; ++round) {
    edges.smooth();
    edges.flipAll();
  }
}

void splitEdge(FlatMesh& mesh, std::uint32_t a, std::uint32_t b) {
  FlatEdges(mesh).split(a, b);
}

}  // namespace lumen::convert
