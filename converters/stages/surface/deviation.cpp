// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

namespace lumen::convert {
namespace {

constexpr int kDeepest = 16;    // halvings of an edge
constexpr int kMostParts = 64;  // parts of an edge
constexpr double kDenser = 3;   // points that measure, than those that decide

// Calls visit(point) for the points of a triangle whose edges are divided into `parts`, and for its
// middle if it is none of them, until it returns false; without corners. True if it never did.
template <class Visit>
bool eachPoint(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
               int parts, const Visit& visit) {
  const Eigen::Vector3d u = (b - a) / parts, v = (c - a) / parts;
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; i + j <= parts; ++j) {
      const bool isCorner = (i == 0 || i == parts) && (j == 0 || j == parts);
      if (!isCorner && !visit(Eigen::Vector3d(a + i * u + j * v))) return false;
    }
  return parts % 3 == 0 || visit(Eigen::Vector3d((a + b + c) / 3));
}

double longestEdge(const TriangleMesh& mesh, const Triangle& t) {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i)
    square = std::max(square, (mesh.position[t[i]] - mesh.position[t[(i + 1) % 3]]).squaredNorm());
  return std::sqrt(square);
}

int countSteps(double length, double spacing) {
  return std::clamp(static_cast<int>(std::ceil(length / spacing)), 2, kMostParts);
}

// The greatest distance of points of one surface from another, mm.
double farthest(const TriangleMesh& from, const std::vector<std::uint32_t>& group,
                const std::vector<bool>& isFree, const TriangleMesh& to) {
  const TriangleTree tree(to);
  std::vector<double> most(from.triangle.size(), 0);
  tbb::parallel_for(std::size_t{0}, most.size(), [&](std::size_t f) {
    if (isFree[group[f]]) return;
    const Triangle& t = from.triangle[f];
    const auto &a = from.position[t[0]], &b = from.position[t[1]], &c = from.position[t[2]];
    const NearestPoint middle = tree.nearest((a + b + c) / 3);
    const double finest = longestEdge(to, to.triangle[middle.triangle]);
    const auto look = [&](const Eigen::Vector3d& p) {
      most[f] = std::max(most[f], tree.nearest(p).distance);
      return true;
    };
    const double longest = longestEdge(from, t);
    for (const auto& corner : {a, b, c}) look(corner);
    eachPoint(a, b, c, countSteps(kDenser * longest, std::min(longest, finest)), look);
  });
  return most.empty() ? 0 : *std::max_element(most.begin(), most.end());
}

}  // namespace

Deviation::Deviation(const TriangleMesh& original, const std::vector<std::uint32_t>& group,
                     std::vector<bool> isFree, const std::vector<double>& spacing)
    : m_original(original),
      m_tree(original),
      m_isFree(std::move(isFree)),
      m_spacing(spacing),
      m_first(original.triangle.size(), kNone) {
  std::vector<bool> isSeen(original.position.size(), false);
  for (std::uint32_t f = 0; f < original.triangle.size(); ++f) {
    if (m_isFree[group[f]]) continue;
    const Triangle& t = original.triangle[f];
    const auto& p = original.position;
    add(f, group[f], (p[t[0]] + p[t[1]] + p[t[2]]) / 3);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = t[i], w = t[(i + 1) % 3];
      if (!isSeen[v]) add(f, group[f], p[v]);
      isSeen[v] = true;
      add(f, group[f], 0.5 * (p[v] + p[w]));
    }
  }
}

void Deviation::add(std::uint32_t face, std::uint32_t group, const Eigen::Vector3d& position) {
  m_points.push_back({position, group, m_first[face]});
  m_first[face] = static_cast<std::uint32_t>(m_points.size() - 1);
}

double Deviation::distance(const Eigen::Vector3d& p, std::uint32_t triangle) const {
  const Triangle& t = m_original.triangle[triangle];
  const auto& corner = m_original.position;
  return (nearestPointOnTriangle(p, corner[t[0]], corner[t[1]], corner[t[2]]) - p).norm();
}

// The distance from one triangle is greatest at an end, so an edge is near it if both ends are.
bool Deviation::isEdgeNear(const NearestPoint& a, const Eigen::Vector3d& atA, const NearestPoint& b,
                           const Eigen::Vector3d& atB, double bound, int depth) const {
  if (a.distance > bound || b.distance > bound) return false;
  if (distance(atA, b.triangle) <= bound || distance(atB, a.triangle) <= bound) return true;
  if (a.distance + b.distance + (atB - atA).norm() <= 2 * bound) return true;
  if (depth == 0) return false;
  const Eigen::Vector3d middle = 0.5 * (atA + atB);
  const NearestPoint there = m_tree.nearest(middle, bound);
  return isEdgeNear(a, atA, there, middle, bound, depth - 1) &&
         isEdgeNear(there, middle, b, atB, bound, depth - 1);
}

// The distance between two surfaces of triangles that lie over each other is greatest at a vertex
// of one, or where an edge of one crosses an edge of the other.
bool Deviation::isNear(const GroupedFace& face, double bound) const {
  if (m_isFree[face.group]) return true;
  const auto& p = m_original.position;
  const Triangle& t = face.corner;
  std::array<NearestPoint, 3> near;
  for (std::size_t i = 0; i < 3; ++i) near[i] = m_tree.nearest(p[t[i]], bound);
  for (std::size_t i = 0; i < 3; ++i)
    if (!isEdgeNear(near[i], p[t[i]], near[(i + 1) % 3], p[t[(i + 1) % 3]], bound, kDeepest))
      return false;
  const double spacing = std::min({m_spacing[t[0]], m_spacing[t[1]], m_spacing[t[2]]});
  const int parts = countSteps(longestEdge(m_original, t), spacing);
  return eachPoint(p[t[0]], p[t[1]], p[t[2]], parts, [&](const Eigen::Vector3d& point) {
    return m_tree.nearest(point, bound).distance <= bound;
  });
}

bool Deviation::isWithin(double bound, std::span<const std::uint32_t> before,
                         std::span<const GroupedFace> now) {
  m_newFace.clear();
  const auto& corner = m_original.position;
  for (const std::uint32_t face : before)
    for (std::uint32_t i = m_first[face]; i != kNone; i = m_points[i].next) {
      double least = std::numeric_limits<double>::infinity();
      std::uint32_t nearest = kNone;
      for (const GroupedFace& f : now) {
        if (f.group != m_points[i].group) continue;
        const Eigen::Vector3d& p = m_points[i].position;
        const Eigen::Vector3d at = nearestPointOnTriangle(p, corner[f.corner[0]],
                                                          corner[f.corner[1]], corner[f.corner[2]]);
        const double square = (at - p).squaredNorm();
        if (square >= least) continue;
        least = square;
        nearest = f.index;
      }
      if (!(least <= bound * bound)) return false;
      m_newFace.emplace_back(i, nearest);
    }
  return std::all_of(now.begin(), now.end(),
                     [&](const GroupedFace& face) { return isNear(face, bound); });
}

void Deviation::keep(std::span<const std::uint32_t> before) {
  for (const std::uint32_t face : before) m_first[face] = kNone;
  for (const auto& [point, face] : m_newFace) {
    m_points[point].next = m_first[face];
    m_first[face] = point;
  }
}

double distanceBetween(const TriangleMesh& one, const std::vector<std::uint32_t>& groupOfOne,
                       const TriangleMesh& other, const std::vector<std::uint32_t>& groupOfOther,
                       const std::vector<bool>& isFree) {
  return std::max(farthest(one, groupOfOne, isFree, other),
                  farthest(other, groupOfOther, isFree, one));
}

}  // namespace lumen::convert
