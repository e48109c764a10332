// SPDX-License-Identifier: Apache-2.0
// Declared in self_intersections.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Geometry>

#include "converters/geometry/exact_predicates.h"
#include "converters/geometry/self_intersections.h"

namespace lumen::convert {
namespace {

using Point = Eigen::Vector3d;
using TrianglePoints = std::array<Point, 3>;
using Flat = std::array<Eigen::Vector2d, 3>;

Eigen::Vector2d drop(const Point& p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

Flat drop(const TrianglePoints& t, int axis) {
  return {drop(t[0], axis), drop(t[1], axis), drop(t[2], axis)};
}

// An axis whose projection keeps the triangle's area; empty if it has no area.
std::optional<int> projectionAxis(const TrianglePoints& t) {
  int widest = 0;
  (t[1] - t[0]).cross(t[2] - t[0]).cwiseAbs().maxCoeff(&widest);
  for (const int axis : {widest, (widest + 1) % 3, (widest + 2) % 3})
    if (orientation(drop(t[0], axis), drop(t[1], axis), drop(t[2], axis)) != 0) return axis;
  return std::nullopt;
}

// True if no two of the signs are opposite.
bool agree(int a, int b, int c) {
  return std::min({a, b, c}) >= 0 || std::max({a, b, c}) <= 0;
}

bool isInBox(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (p.array() >= a.array().min(b.array())).all() &&
         (p.array() <= a.array().max(b.array())).all();
}

bool segmentsMeet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                  const Eigen::Vector2d& d) {
  const int abc = orientation(a, b, c), abd = orientation(a, b, d);
  const int cda = orientation(c, d, a), cdb = orientation(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && isInBox(a, b, c)) || (abd == 0 && isInBox(a, b, d)) ||
         (cda == 0 && isInBox(c, d, a)) || (cdb == 0 && isInBox(c, d, b));
}

bool isInTriangle(const Flat& t, const Eigen::Vector2d& p) {
  return agree(orientation(t[0], t[1], p), orientation(t[1], t[2], p), orientation(t[2], t[0], p));
}

bool segmentMeetsFlat(const Flat& t, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return isInTriangle(t, a) || segmentsMeet(a, b, t[0], t[1]) || segmentsMeet(a, b, t[1], t[2]) ||
         segmentsMeet(a, b, t[2], t[0]);
}

// Sides of a and b with respect to the triangle's plane.
bool segmentMeetsTriangle(const TrianglePoints& t, const Point& a, const Point& b, int sideA,
                          int sideB) {
  if (sideA * sideB > 0) return false;
  if (sideA == 0 && sideB == 0) {
    const int axis = projectionAxis(t).value_or(0);
    return segmentMeetsFlat(drop(t, axis), drop(a, axis), drop(b, axis));
  }
  return agree(orientation(a, b, t[0], t[1]), orientation(a, b, t[1], t[2]),
               orientation(a, b, t[2], t[0]));
}

bool flatTrianglesMeet(const TrianglePoints& one, const TrianglePoints& other) {
  const int axis = projectionAxis(one).value_or(0);
  const Flat a = drop(one, axis), b = drop(other, axis);
  for (std::size_t i = 0; i < 3; ++i)
    if (segmentMeetsFlat(a, b[i], b[(i + 1) % 3])) return true;
  return isInTriangle(b, a[0]);
}

bool trianglesMeet(const TrianglePoints& one, const TrianglePoints& other) {
  std::array<int, 3> sideOther{}, sideOne{};
  for (std::size_t i = 0; i < 3; ++i) sideOther[i] = orientation(one[0], one[1], one[2], other[i]);
  const auto [low, high] = std::minmax_element(sideOther.begin(), sideOther.end());
  if (*low > 0 || *high < 0) return false;
  if (*low == 0 && *high == 0) return flatTrianglesMeet(one, other);
  for (std::size_t i = 0; i < 3; ++i)
    sideOne[i] = orientation(other[0], other[1], other[2], one[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (segmentMeetsTriangle(one, other[i], other[j], sideOther[i], sideOther[j]) ||
        segmentMeetsTriangle(other, one[i], one[j], sideOne[i], sideOne[j]))
      return true;
  }
  return false;
}

// Two triangles on the edge from t[0] to t[1], with tips t[2] and `tip`.
bool isFolded(const TrianglePoints& t, const Point& tip) {
  if (orientation(t[0], t[1], t[2], tip) != 0) return false;
  const int axis = projectionAxis(t).value_or(0);
  const Flat flat = drop(t, axis);
  return orientation(flat[0], flat[1], flat[2]) * orientation(flat[0], flat[1], drop(tip, axis)) >
         0;
}

// The triangle, turned so that its corner `first` comes first.
Triangle turned(const Triangle& t, std::size_t first) {
  return {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
}

std::size_t indexOf(const Triangle& t, std::uint32_t vertex) {
  return static_cast<std::size_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
}

TrianglePoints cornersOf(const TriangleMesh& mesh, const Triangle& t) {
  return {mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]};
}

// Sides of two points with respect to the triangle's plane.
std::array<int, 2> sidesOf(const TrianglePoints& t, const Point& a, const Point& b) {
  return {orientation(t[0], t[1], t[2], a), orientation(t[0], t[1], t[2], b)};
}

// A triangle whose other corners lie on one side of the other's plane has the vertex alone there.
bool meetBeyondVertex(const TriangleMesh& mesh, const Triangle& one, const Triangle& other,
                      std::uint32_t shared) {
  const TrianglePoints a = cornersOf(mesh, turned(one, indexOf(one, shared)));
  const TrianglePoints b = cornersOf(mesh, turned(other, indexOf(other, shared)));
  const auto [b1, b2] = sidesOf(a, b[1], b[2]);
  if (b1 * b2 > 0) return false;
  const auto [a1, a2] = sidesOf(b, a[1], a[2]);
  if (a1 * a2 > 0) return false;
  return segmentMeetsTriangle(a, b[1], b[2], b1, b2) || segmentMeetsTriangle(b, a[1], a[2], a1, a2);
}

}  // namespace

bool hasArea(const TriangleMesh& mesh, const Triangle& triangle) {
  return projectionAxis(cornersOf(mesh, triangle)).has_value();
}

bool intersect(const TriangleMesh& mesh, const Triangle& one, const Triangle& other) {
  const auto isShared = [&other](std::uint32_t v) { return indexOf(other, v) < 3; };
  const auto count = std::count_if(one.begin(), one.end(), isShared);
  if (count == 0) return trianglesMeet(cornersOf(mesh, one), cornersOf(mesh, other));
  if (count == 3) return true;
  if (count == 1)
    return meetBeyondVertex(mesh, one, other, *std::find_if(one.begin(), one.end(), isShared));
  const auto tip =
      static_cast<std::size_t>(std::find_if_not(one.begin(), one.end(), isShared) - one.begin());
  const auto otherTip = *std::find_if_not(other.begin(), other.end(),
                                          [&one](std::uint32_t v) { return indexOf(one, v) < 3; });
  return isFolded(cornersOf(mesh, turned(one, (tip + 1) % 3)), mesh.position[otherTip]);
}

}  // namespace lumen::convert
