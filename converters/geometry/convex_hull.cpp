// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/convex_hull.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "converters/geometry/exact_predicates.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

struct Face {
  Triangle corner{};
  std::array<std::uint32_t, 3> beyond{};  ///< the face across the side from corner i to the next
  std::vector<std::uint32_t> outside;     ///< points that only this face is known to be seen from
  bool isAlive = true;
  std::uint32_t seenAt = 0;  ///< the last point from which it was looked at, plus one
};

/// A side on the edge of the faces that a point sees.
struct RimSide {
  std::uint32_t from, to;
  std::uint32_t face;  ///< the face beyond, which stays
};

class Quickhull {
public:
  explicit Quickhull(std::span<const Vector3d> points) : m_points(points) {}

  std::vector<Triangle> run() {
    const std::optional<std::array<std::uint32_t, 4>> corners = firstCorners();
    if (!corners) return {};
    begin(*corners);
    // faces are only appended, so this meets every one
    for (std::uint32_t f = 0; f < m_faces.size(); ++f)
      while (m_faces[f].isAlive && !m_faces[f].outside.empty()) addPoint(farthest(f), f);
    std::vector<Triangle> triangles;
    for (const Face& face : m_faces)
      if (face.isAlive) triangles.push_back(face.corner);
    return triangles;
  }

private:
  [[nodiscard]] bool sees(std::uint32_t point, const Triangle& t) const {
    return orientation(m_points[t[0]], m_points[t[1]], m_points[t[2]], m_points[point]) < 0;
  }

  [[nodiscard]] std::optional<std::array<std::uint32_t, 4>> firstCorners() const {
    if (m_points.size() < 4) return std::nullopt;
    std::uint32_t a = 0, b = 0;
    for (std::uint32_t i = 1; i < m_points.size(); ++i) {
      if (m_points[i].x() < m_points[a].x()) a = i;
      if (m_points[i].x() > m_points[b].x()) b = i;
    }
    if (a == b) b = argMax([&](std::uint32_t i) { return (at(i) - at(a)).squaredNorm(); });
    const std::uint32_t c =
        argMax([&](std::uint32_t i) { return (at(i) - at(a)).cross(at(b) - at(a)).squaredNorm(); });
    const Vector3d normal = (at(b) - at(a)).cross(at(c) - at(a));
    const std::uint32_t d =
        argMax([&](std::uint32_t i) { return std::abs(normal.dot(at(i) - at(a))); });
    const int side = orientation(at(a), at(b), at(c), at(d));
    if (side == 0) return std::nullopt;
    return side > 0 ? std::array{a, b, c, d} : std::array{a, c, b, d};
  }

  // The tetrahedron; the fourth corner lies behind the first three.
  void begin(const std::array<std::uint32_t, 4>& p) {
    m_faces.resize(4);
    m_faces[0].corner = {p[0], p[1], p[2]};
    m_faces[0].beyond = {1, 2, 3};
    for (std::uint32_t i = 0; i < 3; ++i) {
      Face& face = m_faces[i + 1];
      face.corner = {p[(i + 1) % 3], p[i], p[3]};
      face.beyond = {0, (i + 2) % 3 + 1, (i + 1) % 3 + 1};
    }
    for (std::uint32_t i = 0; i < m_points.size(); ++i) assign(i, {0, 1, 2, 3});
  }

  void assign(std::uint32_t point, std::span<const std::uint32_t> faces) {
    for (const std::uint32_t f : faces)
      if (sees(point, m_faces[f].corner)) {
        m_faces[f].outside.push_back(point);
        return;
      }
  }
  void assign(std::uint32_t point, std::initializer_list<std::uint32_t> faces) {
    assign(point, std::span(faces.begin(), faces.size()));
  }

  [[nodiscard]] std::uint32_t farthest(std::uint32_t f) const {
    const Face& face = m_faces[f];
    const Vector3d normal =
        (at(face.corner[1]) - at(face.corner[0])).cross(at(face.corner[2]) - at(face.corner[0]));
    std::uint32_t best = face.outside.front();
    for (const std::uint32_t i : face.outside)
      if (normal.dot(at(i) - at(best)) > 0) best = i;
    return best;
  }

  // Replaces all faces that the point sees by triangles from the edge of these to the point.
  void addPoint(std::uint32_t point, std::uint32_t first) {
    std::vector<std::uint32_t> seen;
    const std::vector<RimSide> rim = findRim(point, first, seen);
    const auto base = static_cast<std::uint32_t>(m_faces.size());
    const auto count = static_cast<std::uint32_t>(rim.size());
    std::vector<std::uint32_t> added;
    for (std::uint32_t i = 0; i < count; ++i) {
      Face face;
      face.corner = {rim[i].from, rim[i].to, point};
      face.beyond = {rim[i].face, base + (i + 1) % count, base + (i + count - 1) % count};
      m_faces.push_back(std::move(face));
      added.push_back(base + i);
      Face& other = m_faces[rim[i].face];
      for (std::size_t k = 0; k < 3; ++k)
        if (other.corner[k] == rim[i].to && other.corner[(k + 1) % 3] == rim[i].from)
          other.beyond[k] = base + i;
    }
    for (const std::uint32_t f : seen) {
      m_faces[f].isAlive = false;
      for (const std::uint32_t i : std::exchange(m_faces[f].outside, {}))
        if (i != point) assign(i, added);
    }
  }

  // The sides around the faces that a point sees, in order, counter-clockwise seen from outside.
  std::vector<RimSide> findRim(std::uint32_t point, std::uint32_t first,
                               std::vector<std::uint32_t>& seen) {
    struct Visit {
      std::uint32_t face, next, left;  ///< the next side to cross, and the number of those left
    };
    std::vector<RimSide> rim;
    std::vector<Visit> stack{{first, 0, 3}};
    m_faces[first].seenAt = point + 1;
    seen.push_back(first);
    while (!stack.empty()) {
      Visit& top = stack.back();
      if (top.left == 0) {
        stack.pop_back();
        continue;
      }
      const std::uint32_t side = top.next, from = top.face;
      top.next = (side + 1) % 3;
      --top.left;
      const std::uint32_t f = m_faces[from].beyond[side];
      if (m_faces[f].seenAt == point + 1) continue;
      if (!sees(point, m_faces[f].corner)) {
        rim.push_back({m_faces[from].corner[side], m_faces[from].corner[(side + 1) % 3], f});
        continue;
      }
      m_faces[f].seenAt = point + 1;
      seen.push_back(f);
      std::uint32_t entered = 0;
      while (m_faces[f].beyond[entered] != from ||
             m_faces[f].corner[entered] != m_faces[from].corner[(side + 1) % 3])
        ++entered;
      stack.push_back({f, (entered + 1) % 3, 2});
    }
    return rim;
  }

  [[nodiscard]] const Vector3d& at(std::uint32_t i) const { return m_points[i]; }

  template <class Score>
  [[nodiscard]] std::uint32_t argMax(Score score) const {
    std::uint32_t best = 0;
    double most = score(0);
    for (std::uint32_t i = 1; i < m_points.size(); ++i)
      if (const double s = score(i); s > most) {
        most = s;
        best = i;
      }
    return best;
  }

  std::span<const Vector3d> m_points;
  std::vector<Face> m_faces;
};

}  // namespace

std::vector<Triangle> convexHull(std::span<const Eigen::Vector3d> points) {
  return Quickhull(points).run();
}

}  // namespace lumen::convert
