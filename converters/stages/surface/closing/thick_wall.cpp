// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/thick_wall.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/closing/cut_ends.h"
#include "converters/stages/surface/closing/flat_region.h"
#include "converters/stages/surface/remesh/remesh_target.h"
#include "converters/stages/surface/surface_fans.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

// Ratio of path to width at which the walls of two legs of a fork of 20 degrees come apart: 1 /
// sin(10 degrees).
constexpr double kLeastPathWidths = 6;
constexpr double kAnywhere = std::numeric_limits<double>::infinity();
constexpr double kReachThicknesses = 3;  // thicknesses: no wall reaches farther
constexpr double kOnEdge = 1e-6;         // share of a triangle: a foot so near to an edge is on it
constexpr double kRoundingFactor = 1 + 1e-9;  // factor of a thickness that is interpolated
constexpr double kOnWall = 1e-9;              // mm: where the line to the foot has no direction

// The corners' angles are the weights (J. Baerentzen and H. Aanaes, *Signed distance computation
// using the angle weighted pseudonormal*, 2005).
std::vector<Eigen::Vector3d> vertexNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> normal(mesh.position.size(), Eigen::Vector3d::Zero());
  for (const Triangle& t : mesh.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d &here = mesh.position[t[i]], a = mesh.position[t[(i + 1) % 3]] - here,
                            b = mesh.position[t[(i + 2) % 3]] - here;
      const Eigen::Vector3d across = a.cross(b);
      const double sine = across.norm();
      if (sine > 0) normal[t[i]] += std::atan2(sine, a.dot(b)) / sine * across;
    }
  for (Eigen::Vector3d& n : normal) n.normalize();
  return normal;
}

}  // namespace

OffsetField::OffsetField(const formats::Case& source, const field::BlendedField& field, double gap,
                         const CaseSurface& inner, const Length& thickness, Touching touching)
    : SeparatedField(source, field,
                     {.gap = gap,
                      .offset = thickness.mm,
                      .offsetShare = thickness.radii,
                      .leastPath = kLeastPathWidths,
                      .isUnion = touching == Touching::Share}),
      m_inner(inner),
      m_tree(inner.mesh),
      m_normal(vertexNormals(inner.mesh)) {
  m_thickness = vesselRadii(inner, *this);
  for (double& t : m_thickness) t = thickness.at(t);
  gradeLengths(inner.mesh, m_thickness);
  m_thickest = *std::max_element(m_thickness.begin(), m_thickness.end());
  const BoxTree<float>& boxes = m_tree.boxes();
  m_thickestBelow.assign(boxes.nodes().size(), 0);
  for (auto i = static_cast<std::uint32_t>(m_thickestBelow.size()); i-- > 0;) {
    double& most = m_thickestBelow[i];
    const BoxTree<float>::Node& node = boxes.node(i);
    if (node.count == 0) most = std::max(m_thickestBelow[i + 1], m_thickestBelow[node.at]);
    for (std::uint32_t k = node.at; k < node.at + node.count; ++k)
      for (const std::uint32_t v : inner.mesh.triangle[boxes.items()[k]])
        most = std::max(most, kRoundingFactor * m_thickness[v]);
  }
}

bool OffsetField::isOther(std::uint32_t a, std::uint32_t b) const {
  const auto others = touching(a);
  return std::binary_search(others.begin(), others.end(), b);
}

OffsetField::Foot OffsetField::footOn(std::uint32_t triangle, const Eigen::Vector3d& at,
                                      const Eigen::Vector3d& point) const {
  const Triangle& t = m_inner.mesh.triangle[triangle];
  const auto& p = m_inner.mesh.position;
  const Eigen::Vector3d u = p[t[1]] - p[t[0]], v = p[t[2]] - p[t[0]], w = at - p[t[0]];
  const Eigen::Vector3d normal = u.cross(v);
  const double area = normal.squaredNorm();
  Eigen::Vector3d share(1, 0, 0);
  if (area > 0) {
    share[1] = w.cross(v).dot(normal) / area;
    share[2] = u.cross(w).dot(normal) / area;
    share[0] = 1 - share[1] - share[2];
  }
  Foot foot;
  Eigen::Index nearest = 0;
  share.maxCoeff(&nearest);
  foot.node = m_inner.node[t[static_cast<std::size_t>(nearest)]];
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    foot.thickness += share[static_cast<Eigen::Index>(i)] * m_thickness[t[i]];
    outward += share[static_cast<Eigen::Index>(i)] * m_normal[t[i]];
  }
  if (share.minCoeff() > kOnEdge) outward = normal;
  const Eigen::Vector3d fromFoot = point - at;
  const double distance = fromFoot.norm();
  const bool isInside = fromFoot.dot(outward) < 0;
  foot.distance = isInside ? -distance : distance;
  foot.gradient =
      distance > kOnWall ? Eigen::Vector3d(fromFoot / foot.distance) : outward.normalized();
  return foot;
}

template <class Takes>
OffsetField::Foot OffsetField::nearestFoot(const Eigen::Vector3d& point, double reach,
                                           const Takes& takes) const {
  double most = reach * reach, nearest = std::numeric_limits<double>::infinity(), least = nearest;
  Foot best, plain;
  const auto visit = [&](std::uint32_t t, const Eigen::Vector3d& at, double squared) {
    const double distance = std::sqrt(squared);
    if (distance >= nearest && distance - m_thickest >= least) return;
    const Foot foot = footOn(t, at, point);
    if (!takes(foot.node)) return;
    if (distance < nearest) {
      nearest = distance;
      plain = foot;
    }
    if (distance - foot.thickness >= least) return;
    least = distance - foot.thickness;
    best = foot;
    // a greater distance cannot give a lesser d - t, whatever the thickness
    most = std::min(most, (least + m_thickest) * (least + m_thickest));
  };
  // neither nearer than the nearest foot, nor with less of d - t than the best one
  const auto enters = [&](std::uint32_t node, double squared) {
    const double distance = std::sqrt(squared);
    return distance < nearest || distance - m_thickestBelow[node] < least;
  };
  m_tree.visitNear(point, most, visit, enters);
  // inside the lumen the nearest point determines the depth
  return plain.distance < 0 ? plain : best;
}

SeparatedSample OffsetField::sampleFrom(const Eigen::Vector3d& point, const Foot& own) const {
  SeparatedSample sample;
  sample.wall = own.distance - own.thickness;
  sample.distance = sample.wall;
  sample.gradient = own.gradient;
  sample.node = own.node;
  if (!mayTouch(own.node) || own.distance > kReachThicknesses * m_thickest) return sample;
  const double reach = std::max(own.distance, 0.0) + m_thickest + options().gap;
  const Foot other =
      nearestFoot(point, reach, [&](std::uint32_t node) { return isOther(own.node, node); });
  if (other.node == kNone) return sample;
  const double harmonic = 1 / (1 / own.thickness + 1 / other.thickness);
  const double apart =
      (own.distance / own.thickness - other.distance / other.thickness) * harmonic +
      0.5 * options().gap;
  if (apart <= sample.distance) return sample;
  const Eigen::Vector3d gradient = own.gradient / own.thickness - other.gradient / other.thickness;
  sample.distance = apart;
  sample.isSeparated = true;
  sample.other = other.node;
  if (gradient.norm() > 0) sample.gradient = gradient.normalized();
  return sample;
}

OffsetField::Foot OffsetField::ownFoot(const Eigen::Vector3d& point, std::uint32_t node) const {
  return nearestFoot(point, kAnywhere, [&](std::uint32_t other) { return !isOther(node, other); });
}

double OffsetField::fromLumen(const Eigen::Vector3d& point, std::uint32_t node) const {
  return ownFoot(point, node).distance;
}

SeparatedSample OffsetField::at(const Eigen::Vector3d& point, std::uint32_t node) const {
  return sampleFrom(point, ownFoot(point, node));
}

SeparatedSample OffsetField::deepest(const Eigen::Vector3d& point, std::uint32_t /*node*/) const {
  return sampleFrom(point, nearestFoot(point, kAnywhere, [](std::uint32_t) { return true; }));
}

bool OffsetField::isReached(const Eigen::Vector3d& /*point*/, std::uint32_t from,
                            std::uint32_t to) const {
  return !isOther(from, to);
}

namespace {

constexpr std::size_t kMostLiftedPairs = 100'000;

using Rims = std::vector<std::vector<std::uint32_t>>;

// One surface of both, without the faces of their flat ends.
CaseSurface bothWalls(const CaseSurface& inner, const CaseSurface& outer) {
  CaseSurface both;
  both.groups = {{"wall", FaceKind::Wall}, {"outer-wall", FaceKind::Wall}};
  const auto append = [&both](const CaseSurface& part, std::uint32_t wall) {
    const auto base = static_cast<std::uint32_t>(both.mesh.position.size());
    both.mesh.position.insert(both.mesh.position.end(), part.mesh.position.begin(),
                              part.mesh.position.end());
    both.node.insert(both.node.end(), part.node.begin(), part.node.end());
    for (std::size_t t = 0; t < part.mesh.triangle.size(); ++t) {
      const FaceKind kind = part.groups[part.group[t]].kind;
      if (kind == FaceKind::Inlet || kind == FaceKind::Outlet) continue;
      auto [a, b, c] = part.mesh.triangle[t];
      if (wall == 0) std::swap(b, c);
      both.mesh.triangle.push_back({base + a, base + b, base + c});
      both.group.push_back(wall);
    }
  };
  append(inner, 0);
  append(outer, 1);
  return both;
}

std::vector<bool> isOnFlatEnd(const CaseSurface& surface) {
  std::vector<bool> result(surface.mesh.position.size(), false);
  for (std::size_t t = 0; t < surface.mesh.triangle.size(); ++t) {
    const FaceKind kind = surface.groups[surface.group[t]].kind;
    if (kind != FaceKind::Inlet && kind != FaceKind::Outlet) continue;
    for (const std::uint32_t v : surface.mesh.triangle[t]) result[v] = true;
  }
  return result;
}

bool haveSameEnds(const CaseSurface& inner, const CaseSurface& outer) {
  return std::equal(inner.ends.begin(), inner.ends.end(), outer.ends.begin(), outer.ends.end(),
                    [](const SurfaceEnd& a, const SurfaceEnd& b) {
                      return a.group == b.group && a.branch == b.branch && a.node == b.node &&
                             a.centre == b.centre && a.normal == b.normal;
                    }) &&
         inner.groups == outer.groups;
}

// The flat ring between two rims of one end; `outer` runs counter-clockwise seen from outside.
void joinRims(SurfaceFans& fans, const SurfaceEnd& end, const std::vector<std::uint32_t>& inner,
              const std::vector<std::uint32_t>& outer, const std::string& name) {
  const auto [along, across] = planeBasis(end.normal);
  std::vector<std::uint32_t> number = outer;
  number.insert(number.end(), inner.rbegin(), inner.rend());
  Loop2 points;
  for (const std::uint32_t v : number) {
    const Eigen::Vector3d offset = fans.surface().mesh.position[v] - end.centre;
    points.emplace_back(along.dot(offset), across.dot(offset));
  }
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(outer.size());
  const Loop2 around(points.begin(), middle), hole(middle, points.end());
  double length = 0;
  for (std::size_t i = 0; i < around.size(); ++i)
    length += (around[(i + 1) % around.size()] - around[i]).norm();
  const FlatMesh ring =
      triangulateRegion(around, {hole}, length / static_cast<double>(around.size()));
  if (ring.triangle.empty())
    throw failed("the wall at " + formats::printable(name) +
                 " cannot be closed: its inner and outer rim meet; expected a thicker wall");
  for (std::size_t i = number.size(); i < ring.point.size(); ++i)
    number.push_back(fans.addVertex(
        end.centre + ring.point[i].x() * along + ring.point[i].y() * across, end.node));
  for (const Triangle& t : ring.triangle)
    fans.add({number[t[0]], number[t[1]], number[t[2]]}, end.group);
}

}  // namespace

CaseSurface thickWall(const CaseSurface& inner, const CaseSurface& outer) {
  if (!haveSameEnds(inner, outer))
    throw failed("the inner and the outer surface of the wall have not the same ends");
  const Rims innerRims = findRims(inner), outerRims = findRims(outer);
  CaseSurface solid = bothWalls(inner, outer);
  SurfaceFans fans(solid);
  const auto base = static_cast<std::uint32_t>(inner.mesh.position.size());
  for (std::size_t e = 0; e < inner.ends.size(); ++e) {
    if (innerRims[e].empty() || outerRims[e].empty()) continue;
    SurfaceEnd end = inner.ends[e];
    const FaceGroup& group = inner.groups[end.group];
    end.group = static_cast<std::uint32_t>(solid.groups.size());
    solid.groups.push_back(group);
    solid.ends.push_back(end);
    std::vector<std::uint32_t> outerRim = outerRims[e];
    for (std::uint32_t& v : outerRim) v += base;
    joinRims(fans, end, innerRims[e], outerRim, group.name);
  }
  fans.compact();
  return solid;
}

void liftOuter(const CaseSurface& inner, CaseSurface& outer, const SeparatedField& field,
               const Progress& progress) {
  constexpr int kMostLifts = 10;
  constexpr double kLift = 0.1;  // thicknesses
  const auto base = static_cast<std::uint32_t>(inner.mesh.position.size());
  const std::vector<bool> isFixed = isOnFlatEnd(outer);
  for (int lift = 0; lift < kMostLifts; ++lift) {
    const CaseSurface both = bothWalls(inner, outer);
    std::vector<std::uint32_t> moved;
    for (const auto& [a, b] : selfIntersections(both.mesh, kMostLiftedPairs, &progress).pairs) {
      if (both.group[a] == both.group[b]) continue;
      for (const std::uint32_t v : both.mesh.triangle[both.group[a] == 1 ? a : b])
        if (!isFixed[v - base]) moved.push_back(v - base);
    }
    if (moved.empty()) return;
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    const SeparationOptions& wall = field.options();
    for (const std::uint32_t v : moved) {
      const SeparatedSample sample = field.at(outer.mesh.position[v], outer.node[v]);
      const double thickness = wall.offset + wall.offsetShare * field.radius(sample.node);
      outer.mesh.position[v] =
          roundedToFloats(outer.mesh.position[v] + kLift * thickness * sample.gradient);
    }
  }
}

}  // namespace lumen::convert
