// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/closed_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

// A cap is flat: its triangles' normals agree within 2 degrees ...
const double kFlat = std::cos(2 * std::numbers::pi / 180);
// ... it is bounded by edges of more than 45 degrees, for nine tenths of its outline ...
const double kSharp = std::cos(45 * std::numbers::pi / 180);
constexpr double kSharpShare = 0.9;
// ... and round: 4 pi area / outline^2 is 1 for a disc, 0.79 for a square, 0.81 for an ellipse of
// 2:1
constexpr double kRound = 0.75;

// A blunt cap, smoothed and uneven as of a segmentation: its normals agree within 25 degrees ...
const double kNearlyFlat = std::cos(25 * std::numbers::pi / 180);
// ... triangles of a region that is no cap are not tried as the beginning of another, and on rough
// surfaces the triangles that are examined number at most this multiple of all ...
constexpr std::size_t kMostLooksPerTriangle = 20;
// ... and this many rounds lead from a seed on the rim to the mean of the whole cap.
constexpr int kPasses = 5;
// ... it fills an ellipse of up to 2.5:1 of its own moments (a square does by 0.95) ...
constexpr double kFull = 0.9, kLongest = 2.5;
// ... and nine tenths of the surface around it, between these multiples of its radius, have turned
// by 45 degrees.
constexpr double kRimFrom = 1.1, kRimTo = 1.4;
// Fewer triangles, in the cap or around it, do not distinguish a smoothed rim from a bend of few
// facets.
constexpr std::size_t kFewest = 16;
// Largest sum of the normals around a cap across its own, as a share of the area there; all around
// a tube the sum is zero.
constexpr double kUneven = 0.3;

/// Twice the area times the normal.
Vector3d areaVector(const TriangleMesh& mesh, const Triangle& t) {
  const Vector3d& a = mesh.position[t[0]];
  return (mesh.position[t[1]] - a).cross(mesh.position[t[2]] - a);
}

/// The loops of edges that only one triangle has, each against the direction of its triangles.
std::vector<std::vector<std::uint32_t>> openLoops(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> next(mesh.position.size(), kNothing);
  forEachEdge(edgeUses(mesh.triangle), [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1)
      next[endOf(mesh.triangle, edge[0].side)] = startOf(mesh.triangle, edge[0].side);
  });
  std::vector<std::vector<std::uint32_t>> loops;
  for (std::uint32_t v = 0; v < next.size(); ++v) {
    std::vector<std::uint32_t> loop;
    for (std::uint32_t at = v; next[at] != kNothing; at = std::exchange(next[at], kNothing))
      loop.push_back(at);
    if (loop.size() >= 3) loops.push_back(std::move(loop));
  }
  return loops;
}

/// Closes one opening by a fan around the middle of its outline.
void addFan(ClosedMesh& out, const std::vector<std::uint32_t>& loop) {
  TriangleMesh& mesh = out.mesh;
  Vector3d middle = Vector3d::Zero();
  double outline = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector3d a = mesh.position[loop[i]], b = mesh.position[loop[(i + 1) % loop.size()]];
    middle += (b - a).norm() * 0.5 * (a + b);
    outline += (b - a).norm();
  }
  if (outline > 0) middle /= outline;
  const auto apex = static_cast<std::uint32_t>(mesh.position.size());
  mesh.position.push_back(middle);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    mesh.triangle.push_back({loop[i], loop[(i + 1) % loop.size()], apex});
    out.end.push_back(static_cast<std::uint32_t>(out.ends.size()));
  }
  MeshEnd end;
  end.wasOpen = true;
  out.ends.push_back(end);
}

/// Centre, normal and radius of an end from its triangles.
void measure(MeshEnd& end, const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  Vector3d sum = Vector3d::Zero(), centre = Vector3d::Zero();
  double area = 0;
  for (const std::uint32_t t : triangles) {
    const Triangle& corners = mesh.triangle[t];
    const Vector3d twice = areaVector(mesh, corners);
    const double size = 0.5 * twice.norm();
    area += size;
    sum += twice;
    centre += size / 3 *
              (mesh.position[corners[0]] + mesh.position[corners[1]] + mesh.position[corners[2]]);
  }
  if (area > 0) end.centre = centre / area;
  if (sum.norm() > 0) end.normal = sum.normalized();
  end.radius = std::sqrt(area / std::numbers::pi);
}

/// For each side of each triangle, the triangle across it; kNothing where there is none.
std::vector<std::array<std::uint32_t, 3>> oppositeTriangles(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> opposite = oppositeSides(mesh.triangle);
  std::vector<std::array<std::uint32_t, 3>> across(mesh.triangle.size(),
                                                   {kNothing, kNothing, kNothing});
  for (std::size_t side = 0; side < opposite.size(); ++side)
    if (opposite[side] != kNoSide) across[side / 3][side % 3] = opposite[side] / 3;
  return across;
}

/// Finds the caps that a closed surface has.
class FlatEnds {
public:
  explicit FlatEnds(ClosedMesh& out)
      : m_out(out),
        m_opposite(oppositeTriangles(out.mesh)),
        m_isSeen(out.mesh.triangle.size(), false) {
    for (const Triangle& t : out.mesh.triangle)
      m_normal.push_back(areaVector(out.mesh, t).normalized());
  }

  void find() {
    for (std::uint32_t t = 0; t < m_isSeen.size(); ++t) {
      if (m_isSeen[t] || m_out.end[t] != ClosedMesh::kWall) continue;
      grow(t);
      if (!isCap()) continue;
      MeshEnd end;
      measure(end, m_out.mesh, m_region);
      for (const std::uint32_t inside : m_region)
        m_out.end[inside] = static_cast<std::uint32_t>(m_out.ends.size());
      m_out.ends.push_back(end);
    }
    findBlunt();
  }

private:
  void findBlunt() {
    m_isSeen.assign(m_isSeen.size(), false);
    std::vector<std::uint32_t> visit(m_isSeen.size(), 0);
    std::uint32_t round = 0;
    std::size_t looks = 0;
    for (std::uint32_t t = 0; t < m_isSeen.size(); ++t) {
      if (m_isSeen[t] || m_out.end[t] != ClosedMesh::kWall) continue;
      if (looks > kMostLooksPerTriangle * m_isSeen.size()) return;
      MeshEnd end;
      end.normal = m_normal[t];
      for (int pass = 0; pass < kPasses; ++pass) {
        growAround(t, Vector3d(end.normal), kNearlyFlat, visit, ++round);
        looks += m_region.size();
        if (m_region.size() < kFewest) break;
        measure(end, m_out.mesh, m_region);
      }
      const bool isEnd = fillsEllipse(end) && turnsAround(end, visit, ++round);
      if (isEnd) {  // with its bumps and half of its rim
        growAround(t, Vector3d(end.normal), kSharp, visit, ++round);
        measure(end, m_out.mesh, m_region);
      }
      for (const std::uint32_t inside : m_region) {
        if (isEnd) m_out.end[inside] = static_cast<std::uint32_t>(m_out.ends.size());
        m_isSeen[inside] = true;
      }
      if (isEnd) m_out.ends.push_back(end);
    }
  }

  /// The region of a triangle in which normals have at least `least` along a direction; `visit` is
  /// set to `round` there.
  void growAround(std::uint32_t seed, const Vector3d& normal, double least,
                  std::vector<std::uint32_t>& visit, std::uint32_t round) {
    m_region.assign(1, seed);
    visit[seed] = round;
    for (std::size_t k = 0; k < m_region.size(); ++k)
      for (const std::uint32_t other : m_opposite[m_region[k]])
        if (other != kNothing && visit[other] != round && m_out.end[other] == ClosedMesh::kWall &&
            m_normal[other].dot(normal) > least) {
          visit[other] = round;
          m_region.push_back(other);
        }
  }

  /// Whether the region is as large as the ellipse that has its moments, and not long.
  [[nodiscard]] bool fillsEllipse(const MeshEnd& end) const {
    if (m_region.size() < kFewest) return false;
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    double area = 0;
    for (const std::uint32_t t : m_region) {
      const Triangle& corners = m_out.mesh.triangle[t];
      const double size = 0.5 * areaVector(m_out.mesh, corners).norm();
      area += size;
      // the middles of the sides, a third of the area each, have the moments of the triangle
      for (std::size_t i = 0; i < 3; ++i) {
        const Vector3d p =
            0.5 * (m_out.mesh.position[corners[i]] + m_out.mesh.position[corners[(i + 1) % 3]]) -
            end.centre;
        moments += size / 3 * p * p.transpose();
      }
    }
    if (!(area > 0)) return false;
    const Vector3d wide =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments / area, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return wide[1] * kLongest * kLongest > wide[2] &&
           area >= kFull * 4 * std::numbers::pi * std::sqrt(wide[1] * wide[2]);
  }

  /// Whether the surface continues backwards around the region.
  [[nodiscard]] bool turnsAround(const MeshEnd& end, std::vector<std::uint32_t>& visit,
                                 std::uint32_t round) const {
    std::vector<std::uint32_t> open = m_region;
    for (const std::uint32_t t : open) visit[t] = round;
    double rim = 0, turned = 0;
    std::size_t count = 0;
    Vector3d sum = Vector3d::Zero();
    for (std::size_t k = 0; k < open.size(); ++k)
      for (const std::uint32_t other : m_opposite[open[k]]) {
        if (other == kNothing || visit[other] == round) continue;
        visit[other] = round;
        const Triangle& corners = m_out.mesh.triangle[other];
        const Vector3d middle = (m_out.mesh.position[corners[0]] + m_out.mesh.position[corners[1]] +
                                 m_out.mesh.position[corners[2]]) /
                                    3 -
                                end.centre;
        const double away = middle.norm();
        if (away > kRimTo * end.radius) continue;
        open.push_back(other);
        if (away < kRimFrom * end.radius) continue;
        const double size = areaVector(m_out.mesh, corners).norm();
        rim += size;
        ++count;
        sum += size * (m_normal[other] - m_normal[other].dot(end.normal) * end.normal);
        if (m_normal[other].dot(end.normal) < kSharp && middle.dot(end.normal) < 0) turned += size;
      }
    return count >= kFewest && turned >= kSharpShare * rim && sum.norm() < kUneven * rim;
  }

  /// The flat region of a triangle.
  void grow(std::uint32_t seed) {
    m_region.assign(1, seed);
    m_isSeen[seed] = true;
    for (std::size_t k = 0; k < m_region.size(); ++k)
      for (const std::uint32_t other : m_opposite[m_region[k]])
        if (other != kNothing && !m_isSeen[other] && m_out.end[other] == ClosedMesh::kWall &&
            m_normal[other].dot(m_normal[seed]) > kFlat) {
          m_isSeen[other] = true;
          m_region.push_back(other);
        }
    m_seed = seed;
  }

  [[nodiscard]] bool isCap() const {
    double area = 0, outline = 0, sharp = 0;
    for (const std::uint32_t t : m_region) {
      const Triangle& corners = m_out.mesh.triangle[t];
      area += 0.5 * areaVector(m_out.mesh, corners).norm();
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t other = m_opposite[t][i];
        if (other == kNothing || m_normal[other].dot(m_normal[m_seed]) > kFlat) continue;
        const Vector3d side =
            m_out.mesh.position[corners[(i + 1) % 3]] - m_out.mesh.position[corners[i]];
        outline += side.norm();
        const bool isConvex = side.cross(m_normal[t]).dot(m_normal[other]) > 0;
        if (isConvex && m_normal[other].dot(m_normal[t]) < kSharp) sharp += side.norm();
      }
    }
    return m_region.size() >= 4 && sharp >= kSharpShare * outline &&
           4 * std::numbers::pi * area >= kRound * outline * outline;
  }

  ClosedMesh& m_out;
  std::vector<std::array<std::uint32_t, 3>> m_opposite;
  std::vector<bool> m_isSeen;
  std::vector<Vector3d> m_normal;
  std::vector<std::uint32_t> m_region;
  std::uint32_t m_seed = 0;
};

}  // namespace

ClosedMesh closeMesh(TriangleMesh mesh) {
  ClosedMesh out;
  out.mesh = std::move(mesh);
  out.end.assign(out.mesh.triangle.size(), ClosedMesh::kWall);
  for (const auto& loop : openLoops(out.mesh)) addFan(out, loop);
  if (signedVolume(out.mesh) < 0)
    for (Triangle& t : out.mesh.triangle) std::swap(t[1], t[2]);
  std::vector<std::vector<std::uint32_t>> ofEnd(out.ends.size());
  for (std::uint32_t t = 0; t < out.end.size(); ++t)
    if (out.end[t] != ClosedMesh::kWall) ofEnd[out.end[t]].push_back(t);
  for (std::size_t i = 0; i < out.ends.size(); ++i) measure(out.ends[i], out.mesh, ofEnd[i]);
  FlatEnds(out).find();
  return out;
}

}  // namespace lumen::convert
