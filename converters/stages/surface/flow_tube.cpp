// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/flow_tube.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "converters/base/vectors.h"
#include "converters/stages/surface/flat_region.h"

namespace lumen::convert {
namespace {

constexpr double kBlend = 1.5;     // radii until the section is round
constexpr double kSteepest = 1.0;  // slope of the wall at the rim: beyond 45 degrees it is no tube
constexpr int kSlopeSmoothings = 3;  // passes over the tangents, which triangles roughen
constexpr double kEvenAfter = 8;     // rows until the vertices of a ring are evenly spaced

using Vector = Eigen::Vector3d;

Eigen::Vector2d centroidOf(const Loop2& loop) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double total = 0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Eigen::Vector2d a = loop[i] - loop[0], b = loop[i + 1] - loop[0];
    const double area = a.x() * b.y() - a.y() * b.x();
    sum += area * (a + b) / 3;
    total += area;
  }
  return loop[0] + sum / total;
}

// Between entries i and i + 1 of a list that goes up by `period` all around.
double interpolate(const std::vector<double>& list, double i, double period) {
  const auto low = static_cast<std::size_t>(i);
  const auto at = [&](std::size_t k) {
    return list[k % list.size()] + period * double(k / list.size());
  };
  return at(low) + (i - double(low)) * (at(low + 1) - at(low));
}

Vector between(const std::vector<Vector>& list, double index) {
  const auto low = static_cast<std::size_t>(index) % list.size();
  const double share = index - std::floor(index);
  return (1 - share) * list[low] + share * list[(low + 1) % list.size()];
}

}  // namespace

FlowTube::FlowTube(const SurfaceFans& fans, const SurfaceEnd& end,
                   const std::vector<std::uint32_t>& rim)
    : m_end(end) {
  const TriangleMesh& mesh = fans.surface().mesh;
  const auto [along, across] = planeBasis(end.normal);
  m_along = along;
  m_across = across;
  Vector middle = Vector::Zero();
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vector& p = mesh.position[rim[i]];
    m_point.push_back(p);
    m_slope.push_back(slopeAt(fans, rim, i));
    const double length = (mesh.position[rim[(i + 1) % rim.size()]] - p).norm();
    m_share.push_back(m_length);
    m_length += length;
    middle += p;
  }
  for (double& share : m_share) share *= static_cast<double>(rim.size()) / m_length;
  smoothSlopes();
  Loop2 loop;
  for (const Vector& p : m_point) loop.push_back(flat(p));
  m_radius = std::sqrt(signedArea(loop) / M_PI);
  m_centre = centroidOf(loop);
  m_turn = measureTurn(loop);
}

std::size_t FlowTube::rows(double length) const {
  return static_cast<std::size_t>(std::max(1L, std::lround(length / (kRowHeight * edge()))));
}

Vector FlowTube::place(std::size_t j, std::size_t k, std::size_t rows, double length) const {
  const double n = double(around()), height = length * double(j) / double(rows);
  const double even = double(k) + 0.5 * double(j), blend = std::min(length, kBlend * m_radius);
  // at the rim vertices are where they are; farther out they are evenly spaced
  const double part = std::min(1.0, double(j) / kEvenAfter);
  const double at = (1 - part) * interpolate(m_share, even, n) + part * even;
  const double index = indexAt(at);
  const double t = std::min(1.0, height / blend);
  const double h00 = (1 + 2 * t) * (1 - t) * (1 - t), h10 = t * (1 - t) * (1 - t);
  const double angle = m_turn + 2 * M_PI * at / n;
  const Vector circle = m_end.centre + (m_centre.x() + m_radius * std::cos(angle)) * m_along +
                        (m_centre.y() + m_radius * std::sin(angle)) * m_across;
  return h00 * between(m_point, index) + h10 * blend * between(m_slope, index) +
         (1 - h00) * circle + height * m_end.normal;
}

Eigen::Vector2d FlowTube::flat(const Vector& p) const {
  return {m_along.dot(p - m_end.centre), m_across.dot(p - m_end.centre)};
}

Vector FlowTube::lift(const Eigen::Vector2d& p, double height) const {
  return m_end.centre + p.x() * m_along + p.y() * m_across + height * m_end.normal;
}

// Slope of the wall at the rim: sideways by this many mm for each mm along the normal.
Vector FlowTube::slopeAt(const SurfaceFans& fans, const std::vector<std::uint32_t>& rim,
                         std::size_t i) const {
  const TriangleMesh& mesh = fans.surface().mesh;
  const std::size_t n = rim.size();
  Vector normal = Vector::Zero();
  for (const std::uint32_t t : fans.of(rim[i])) {
    const Triangle& corner = mesh.triangle[t];
    if (fans.surface().group[t] != m_end.group)
      normal += (mesh.position[corner[1]] - mesh.position[corner[0]])
                    .cross(mesh.position[corner[2]] - mesh.position[corner[0]]);
  }
  const Vector tangent = mesh.position[rim[(i + 1) % n]] - mesh.position[rim[(i + n - 1) % n]];
  Vector ahead = normal.cross(tangent);
  if (ahead.dot(m_end.normal) < 0) ahead = -ahead;
  const double forward = ahead.dot(m_end.normal);
  if (!(forward > 0)) return Vector::Zero();
  Vector slope = ahead / forward - m_end.normal;
  // only the part across the rim counts: sliding along it changes no shape
  const Vector outward = tangent.cross(m_end.normal).normalized();
  slope = slope.dot(outward) * outward;
  return slope * std::min(1.0, kSteepest / std::max(slope.norm(), 1e-12));
}

void FlowTube::smoothSlopes() {
  const std::size_t n = m_slope.size();
  for (int round = 0; round < kSlopeSmoothings; ++round) {
    const std::vector<Vector> before = m_slope;
    for (std::size_t i = 0; i < n; ++i)
      m_slope[i] = 0.25 * before[(i + n - 1) % n] + 0.5 * before[i] + 0.25 * before[(i + 1) % n];
  }
}

// The angle on the circle at which the rim begins: the mean over all vertices.
double FlowTube::measureTurn(const Loop2& loop) const {
  double x = 0, y = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector2d offset = loop[i] - m_centre;
    const double angle = -2 * M_PI * m_share[i] / double(loop.size());
    x += std::cos(angle) * offset.x() - std::sin(angle) * offset.y();
    y += std::sin(angle) * offset.x() + std::cos(angle) * offset.y();
  }
  return std::atan2(y, x);
}

// The inverse of m_share: the rim's vertex, and the share of the step to the next, at a parameter.
double FlowTube::indexAt(double around) const {
  const double n = double(m_point.size());
  const double turns = std::floor(around / n), rest = around - turns * n;
  const auto above = std::upper_bound(m_share.begin(), m_share.end(), rest);
  const auto low = static_cast<std::size_t>(above - m_share.begin()) - 1;
  const double begin = m_share[low], end = low + 1 < m_share.size() ? m_share[low + 1] : n;
  return double(low) + (end > begin ? (rest - begin) / (end - begin) : 0);
}

}  // namespace lumen::convert
