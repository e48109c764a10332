// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The hit of a ray on a triangle: its distance (T. Moeller and B. Trumbore, "Fast, minimum storage
/// ray/triangle intersection", 1997), and whether it comes from behind. Empty without a hit.
std::optional<RayHit> meet(const Vector3d& origin, const Vector3d& direction,
                           const std::array<Vector3d, 3>& corner) {
  const auto& [a, b, c] = corner;
  const Vector3d ab = b - a, ac = c - a;
  const Vector3d across = direction.cross(ac);
  const double det = ab.dot(across);
  if (det == 0) return {};
  const Vector3d from = origin - a;
  const double u = from.dot(across) / det;
  if (!(u >= 0 && u <= 1)) return {};
  const Vector3d q = from.cross(ab);
  const double v = direction.dot(q) / det;
  if (!(v >= 0 && u + v <= 1)) return {};
  return RayHit{ac.dot(q) / det, 0, det < 0};
}

float below(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}

float above(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

}  // namespace

/// A ray, prepared for tests against boxes.
class TriangleTree::Ray {
public:
  Ray(const Vector3d& origin, const Vector3d& direction) {
    for (std::size_t a = 0; a < 3; ++a) {
      m_origin[a] = origin[static_cast<Eigen::Index>(a)];
      const double along = direction[static_cast<Eigen::Index>(a)];
      m_inverse[a] = std::abs(along) > 1 / kSteep ? 1 / along : std::copysign(kSteep, along);
    }
  }

  /// Distance at which the ray enters a box, or a value beyond all triangles if it misses. Boxes
  /// enclose their content with a margin larger than the rounding errors here.
  [[nodiscard]] double entry(const Box3f& box) const {
    double from = 0, to = kInfinity;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<Eigen::Index>(k);
      const double one = (double{box.low[a]} - m_origin[k]) * m_inverse[k];
      const double two = (double{box.high[a]} - m_origin[k]) * m_inverse[k];
      from = std::max(from, std::min(one, two));
      to = std::min(to, std::max(one, two));
    }
    return from <= to ? from : kInfinity;
  }

private:
  static constexpr double kSteep = 1e30;  // reciprocal of a component that is almost 0
  std::array<double, 3> m_origin{}, m_inverse{};
};

double TriangleTree::squaredDistance(const Box3f& box, const Vector3d& point) {
  double sum = 0;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double at = point[a];
    const double apart = std::max({double{box.low[a]} - at, at - double{box.high[a]}, 0.0});
    sum += apart * apart;
  }
  return sum;
}

// The point of a triangle that is nearest to `p` (C. Ericson, "Real-time collision detection",
// 2005, section 5.1.5).
Vector3d nearestPointOnTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                                const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 - d3 > 0 ? Vector3d(a + d1 / (d1 - d3) * ab) : a;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 - d6 > 0 ? Vector3d(a + d2 / (d2 - d6) * ac) : a;
  const double va = d3 * d6 - d5 * d4, along = d4 - d3, back = d5 - d6;
  if (va <= 0 && along >= 0 && back >= 0)
    return along + back > 0 ? Vector3d(b + along / (along + back) * (c - b)) : b;
  const double sum = va + vb + vc;
  return sum > 0 ? Vector3d(a + ab * (vb / sum) + ac * (vc / sum)) : a;
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) : m_mesh(mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.triangle.size());
  std::vector<Box3f> boxes(count);
  std::vector<Vector3d> centre(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vector3d a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    centre[t] = (a + b + c) / 3;
    boxes[t].low = a.cwiseMin(b).cwiseMin(c).unaryExpr(&below);
    boxes[t].high = a.cwiseMax(b).cwiseMax(c).unaryExpr(&above);
  }
  m_tree = Tree(boxes, centre);
  m_corner.reserve(count);
  for (const std::uint32_t t : m_tree.items())
    m_corner.push_back({corner(t, 0), corner(t, 1), corner(t, 2)});
}

template <class Visit>
void TriangleTree::eachOnRay(const Vector3d& origin, const Vector3d& direction, double least,
                             const double& most, Visit&& visit) const {
  struct Waiting {
    std::uint32_t node;
    double from;
  };
  const Ray ray(origin, direction);
  const auto waiting = [&](std::uint32_t i) { return Waiting{i, ray.entry(m_tree.node(i).box)}; };
  std::array<Waiting, Tree::kDeepest> stack;
  stack[0] = waiting(0);
  std::size_t depth = 1;
  while (depth > 0) {
    const Waiting here = stack[--depth];
    if (here.from == kInfinity || here.from > most) continue;
    const Tree::Node& node = m_tree.node(here.node);
    for (std::uint32_t k = node.at; k < node.at + node.count; ++k) {
      auto hit = meet(origin, direction, m_corner[k]);
      if (!hit || !(hit->distance >= least)) continue;
      hit->triangle = m_tree.items()[k];
      visit(*hit);
    }
    if (node.count > 0) continue;
    // the nearer child last, so that it is visited first
    const Waiting one = waiting(here.node + 1), two = waiting(node.at);
    const bool oneFirst = one.from < two.from;
    if (one.from != kInfinity || two.from != kInfinity) {
      stack[depth++] = oneFirst ? two : one;
      stack[depth++] = oneFirst ? one : two;
    }
  }
}

std::optional<RayHit> TriangleTree::firstHit(const Vector3d& origin, const Vector3d& direction,
                                             double least) const {
  std::optional<RayHit> best;
  double most = kInfinity;
  eachOnRay(origin, direction, least, most, [&](const RayHit& hit) {
    if (hit.distance > most || (best && hit.distance == most && hit.triangle > best->triangle))
      return;
    best = hit;
    most = hit.distance;
  });
  return best;
}

bool TriangleTree::isFree(const Vector3d& from, const Vector3d& to) const {
  const double length = (to - from).norm();
  if (!(length > 0)) return true;
  bool isMet = false;
  double most = length;
  eachOnRay(from, (to - from) / length, 0, most, [&](const RayHit& hit) {
    if (hit.distance > length) return;
    isMet = true;
    most = -kInfinity;
  });
  return !isMet;
}

int TriangleTree::winding(const Vector3d& origin, const Vector3d& direction) const {
  int turns = 0;
  const double most = kInfinity;
  eachOnRay(origin, direction, 0, most, [&](const RayHit& hit) { turns += hit.leaves ? 1 : -1; });
  return turns;
}

bool TriangleTree::contains(const Vector3d& point) const {
  // unlike the usual directions of a mesh's edges
  static const std::array<Vector3d, 3> kRays = {Vector3d(0.8017, 0.3119, 0.5099).normalized(),
                                                Vector3d(-0.4211, 0.8563, 0.2987).normalized(),
                                                Vector3d(-0.2903, -0.4421, 0.8487).normalized()};
  int votes = 0;
  for (const Vector3d& ray : kRays) votes += winding(point, ray) != 0 ? 1 : 0;
  return votes >= 2;
}

NearestPoint TriangleTree::nearest(const Vector3d& point, double reach) const {
  NearestPoint best;
  double most = reach * reach;
  visitNear(point, most, [&](std::uint32_t t, const Vector3d& at, double squared) {
    if (squared == most && best.distance < kInfinity && t > best.triangle) return;
    most = squared;
    best = {std::sqrt(squared), t, at};
  });
  return best;
}

Vector3d TriangleTree::normal(std::uint32_t triangle) const {
  const Vector3d n =
      (corner(triangle, 1) - corner(triangle, 0)).cross(corner(triangle, 2) - corner(triangle, 0));
  const double length = n.norm();
  return length > 0 ? Vector3d(n / length) : Vector3d(Vector3d::Zero());
}

}  // namespace lumen::convert
