// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/flat_region.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

#include "converters/geometry/exact_predicates.h"

namespace lumen::convert {
namespace {

using Point = Eigen::Vector2d;

constexpr double kLoopClearance = 0.6;  // edges: nearer to a loop triangles get flat
constexpr double kMostInner = 4000;     // points; beyond, the lattice is coarser

bool isOn(const Point& a, const Point& b, const Point& p) {
  return orientation(a, b, p) == 0 && (p - a).dot(p - b) <= 0;
}

// True if the closed segments have a point in common.
bool segmentsMeet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const int abc = orientation(a, b, c), abd = orientation(a, b, d);
  const int cda = orientation(c, d, a), cdb = orientation(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return isOn(a, b, c) || isOn(a, b, d) || isOn(c, d, a) || isOn(c, d, b);
}

bool isInside(const Loop2& loop, const Point& p) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point &a = loop[i], &b = loop[(i + 1) % loop.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    const int side = orientation(a, b, p);
    if ((b.y() > a.y()) == (side > 0)) inside = !inside;
  }
  return inside;
}

double distanceTo(const Loop2& loop, const Point& p) {
  double least = (p - loop[0]).norm();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point &a = loop[i], along = loop[(i + 1) % loop.size()] - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - a - t * along).norm());
  }
  return least;
}

// Indices of the points around a region, holes joined to the outer loop by bridges there and back.
using Ring = std::vector<std::uint32_t>;

bool crossesRing(const std::vector<Point>& point, const Ring& ring, std::uint32_t from,
                 std::uint32_t to) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = point[ring[i]], &b = point[ring[(i + 1) % ring.size()]];
    const bool touches = a == point[from] || b == point[from] || a == point[to] || b == point[to];
    if (!touches && segmentsMeet(point[from], point[to], a, b)) return true;
  }
  return false;
}

// True if the line from corner i of the ring to `p` begins within the region.
bool opensTo(const std::vector<Point>& point, const Ring& ring, std::size_t i, const Point& p) {
  const std::size_t n = ring.size();
  const Point &before = point[ring[(i + n - 1) % n]], &at = point[ring[i]],
              &after = point[ring[(i + 1) % n]];
  if (orientation(before, at, after) > 0)
    return orientation(at, after, p) > 0 && orientation(before, at, p) > 0;
  return orientation(at, after, p) > 0 || orientation(before, at, p) > 0;
}

// Joins a hole to the ring by the shortest bridge that crosses nothing; false if there is none.
bool joinHole(const std::vector<Point>& point, const Ring& hole, Ring& ring) {
  struct Bridge {
    double length;
    std::size_t ring, hole;
  };
  std::vector<Bridge> bridges;
  for (std::size_t i = 0; i < ring.size(); ++i)
    for (std::size_t k = 0; k < hole.size(); ++k)
      bridges.push_back({(point[ring[i]] - point[hole[k]]).squaredNorm(), i, k});
  std::stable_sort(bridges.begin(), bridges.end(),
                   [](const Bridge& a, const Bridge& b) { return a.length < b.length; });
  for (const Bridge& bridge : bridges) {
    const std::uint32_t from = ring[bridge.ring], to = hole[bridge.hole];
    if (!opensTo(point, ring, bridge.ring, point[to]) || crossesRing(point, ring, from, to) ||
        crossesRing(point, hole, from, to))
      continue;
    Ring detour;
    for (std::size_t k = 0; k <= hole.size(); ++k)
      detour.push_back(hole[(bridge.hole + k) % hole.size()]);
    detour.push_back(from);
    ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(bridge.ring) + 1, detour.begin(),
                detour.end());
    return true;
  }
  return false;
}

bool isEar(const std::vector<Point>& point, const Ring& ring, std::size_t i) {
  const std::size_t n = ring.size();
  const Point &a = point[ring[(i + n - 1) % n]], &b = point[ring[i]], &c = point[ring[(i + 1) % n]];
  if (orientation(a, b, c) <= 0) return false;
  return std::none_of(ring.begin(), ring.end(), [&](std::uint32_t v) {
    const Point& p = point[v];
    return p != a && p != b && p != c && orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 &&
           orientation(c, a, p) >= 0;
  });
}

// Clips the ear with the greatest least angle again and again; false where none is left.
bool clipEars(const std::vector<Point>& point, Ring ring, std::vector<Triangle>& triangle) {
  while (ring.size() >= 3) {
    const std::size_t n = ring.size();
    double best = -1;
    std::size_t chosen = n;
    for (std::size_t i = 0; i < n; ++i) {
      const Point &a = point[ring[(i + n - 1) % n]], &b = point[ring[i]],
                  &c = point[ring[(i + 1) % n]];
      const double shape = std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) /
                           ((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm());
      if (shape > best && isEar(point, ring, i)) {
        best = shape;
        chosen = i;
      }
    }
    if (chosen == n) return false;
    triangle.push_back({ring[(chosen + n - 1) % n], ring[chosen], ring[(chosen + 1) % n]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
  return true;
}

// Points of a triangular lattice in the region, off its loops.
std::vector<Point> latticeWithin(const Loop2& outer, const std::vector<Loop2>& holes, double edge) {
  Point low = outer[0], high = outer[0];
  for (const Point& p : outer) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Point size = high - low;
  edge = std::max(edge, std::sqrt(size.x() * size.y() / (kRowHeight * kMostInner)));
  const auto isFree = [&](const Point& p) {
    return isInside(outer, p) && distanceTo(outer, p) >= kLoopClearance * edge &&
           std::none_of(holes.begin(), holes.end(), [&](const Loop2& hole) {
             return isInside(hole, p) || distanceTo(hole, p) < kLoopClearance * edge;
           });
  };
  const int rows = static_cast<int>(size.y() / (kRowHeight * edge)) + 1;
  const int columns = static_cast<int>(size.x() / edge) + 2;
  std::vector<Point> points;
  for (int row = -rows / 2 - 1; row <= rows / 2 + 1; ++row)
    for (int column = -columns / 2 - 1; column <= columns / 2 + 1; ++column) {
      const Point offset((column + 0.5 * (row & 1)) * edge, row * kRowHeight * edge);
      const Point p = 0.5 * (low + high) + offset;
      if (isFree(p)) points.push_back(p);
    }
  return points;
}

}  // namespace

bool isSimple(const Loop2& loop) {
  const std::size_t n = loop.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Point &a = loop[i], &b = loop[(i + 1) % n];
    if (a == b || isOn(a, b, loop[(i + 2) % n]) || isOn(b, loop[(i + 2) % n], a)) return false;
    for (std::size_t k = i + 2; k < n && k + 1 < n + i; ++k)
      if (segmentsMeet(a, b, loop[k], loop[(k + 1) % n])) return false;
  }
  return true;
}

double signedArea(const Loop2& loop) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Point a = loop[i] - loop[0], b = loop[i + 1] - loop[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

bool isWithin(const Loop2& inner, const Loop2& outer) {
  if (!isInside(outer, inner[0])) return false;
  for (std::size_t i = 0; i < inner.size(); ++i)
    for (std::size_t k = 0; k < outer.size(); ++k)
      if (segmentsMeet(inner[i], inner[(i + 1) % inner.size()], outer[k],
                       outer[(k + 1) % outer.size()]))
        return false;
  return true;
}

FlatMesh triangulateRegion(const Loop2& outer, const std::vector<Loop2>& holes, double edge) {
  FlatMesh mesh;
  mesh.point = outer;
  Ring ring;
  for (std::uint32_t i = 0; i < outer.size(); ++i) ring.push_back(i);
  if (!isSimple(outer) || !(signedArea(outer) > 0)) return {};
  for (const Loop2& hole : holes) {
    if (!isSimple(hole) || !(signedArea(hole) < 0) || !isWithin(hole, outer)) return {};
    Ring around;
    for (const Point& p : hole) {
      around.push_back(static_cast<std::uint32_t>(mesh.point.size()));
      mesh.point.push_back(p);
    }
    if (!joinHole(mesh.point, around, ring)) return {};
  }
  if (!clipEars(mesh.point, ring, mesh.triangle)) return {};
  addInnerPoints(mesh, latticeWithin(outer, holes, edge));
  return mesh;
}

}  // namespace lumen::convert
