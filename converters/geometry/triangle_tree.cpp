// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

float below(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}

float above(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

}  // namespace

double TriangleTree::squaredDistance(const Box3f& box, const Vector3d& point) {
  double sum = 0;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double at = point[a];
    const double apart = std::max({double{box.low[a]} - at, at - double{box.high[a]}, 0.0});
    sum += apart * apart;
  }
  return sum;
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
  m_wide = WideBoxTree(m_tree);
  const auto leaves = m_wide.leaves();
  m_block.resize(leaves.size() - 1);
  for (std::size_t leaf = 0; leaf < m_block.size(); ++leaf)
    for (std::uint32_t k = leaves[leaf]; k < leaves[leaf + 1]; ++k)
      m_block[leaf].set(k - leaves[leaf],
                        {corner(m_tree.items()[k], 0), corner(m_tree.items()[k], 1),
                         corner(m_tree.items()[k], 2)});
}

template <class Visit>
void TriangleTree::eachOnRay(const Vector3d& origin, const Vector3d& direction, double least,
                             const double& most, Visit&& visit) const {
  const BoxRay ray(origin, direction);
  const auto leaves = m_wide.leaves();
  BlockHits hits;
  m_wide.visit(
      most,
      [&](const WideNode& node, double limit, auto& out) { return ray.entries(node, limit, out); },
      [&](std::uint32_t leaf) {
        meetBlock(m_block[leaf], origin, direction, hits);
        const std::uint32_t first = leaves[leaf], count = leaves[leaf + 1] - first;
        for (std::uint32_t k = 0; k < count; ++k)
          if (hits.distance[k] >= least)
            visit(RayHit{hits.distance[k], m_tree.items()[first + k], hits.det[k] < 0});
      });
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
  BlockPoints points;
  const auto leaves = m_wide.leaves();
  m_wide.visit(
      most,
      [&](const WideNode& node, double limit, auto& out) {
        return boxesNear(node, point, limit, out);
      },
      [&](std::uint32_t leaf) {
        nearestInBlock(m_block[leaf], point, points);
        const std::uint32_t first = leaves[leaf], count = leaves[leaf + 1] - first;
        for (std::uint32_t k = 0; k < count; ++k) {
          const double squared = points.squared[k];
          const std::uint32_t t = m_tree.items()[first + k];
          if (!(squared <= most) ||
              (squared == most && best.distance < kInfinity && t > best.triangle))
            continue;
          most = squared;
          best = {std::sqrt(squared), t, {points.at[0][k], points.at[1][k], points.at[2][k]}};
        }
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
