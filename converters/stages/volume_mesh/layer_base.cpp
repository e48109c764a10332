// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/volume_mesh/layer_base.h"

#include <algorithm>
#include <map>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/io/mesh/volume_mesh.h"
#include "converters/stages/surface/separated_field.h"
#include "formats/case/case_field.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

// Least cosine between a direction and the normals around its vertex, below which it is turned.
constexpr double kLeastCosine = 0.5;
constexpr int kMostTurns = 60;
// Greatest distance from the field's surface at which its gradient counts, in radii.
constexpr double kOnField = 0.05;

bool isFlat(const SurfaceMesh& surface, std::size_t triangle) {
  const FaceKind kind = surface.groups[surface.group[triangle]].kind;
  return kind == FaceKind::Inlet || kind == FaceKind::Outlet;
}

/// The edges of flat ends on the base, by the vertex at which they begin as the end sees them.
using RimEdges = std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>>;  // by group

RimEdges rimEdges(const SurfaceMesh& surface, const std::vector<std::uint32_t>& inBase) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> wall;
  for (std::size_t t = 0; t < surface.triangle.size(); ++t)
    for (std::size_t k = 0; k < 3 && !isFlat(surface, t); ++k)
      wall[{surface.triangle[t][k], surface.triangle[t][(k + 1) % 3]}] = true;
  RimEdges edges;
  for (std::size_t t = 0; t < surface.triangle.size(); ++t)
    for (std::size_t k = 0; k < 3 && isFlat(surface, t); ++k) {
      const std::uint32_t from = surface.triangle[t][k], to = surface.triangle[t][(k + 1) % 3];
      if (wall.count({to, from}) > 0) edges[surface.group[t]][inBase[from]] = inBase[to];
    }
  return edges;
}

LayerRim rimOf(const std::map<std::uint32_t, std::uint32_t>& next, std::uint32_t group,
               const TriangleMesh& mesh) {
  LayerRim rim;
  rim.group = group;
  std::uint32_t at = next.begin()->first;
  do {
    rim.loop.push_back(at);
    rim.centre += mesh.position[at];
    const auto found = next.find(at);
    if (found == next.end() || rim.loop.size() > next.size())
      throw failed("the rim of a flat end of the surface is not closed");
    at = found->second;
  } while (at != rim.loop.front());
  if (rim.loop.size() != next.size()) throw failed("a flat end of the surface has several rims");
  rim.centre /= static_cast<double>(rim.loop.size());
  for (std::size_t k = 0; k < rim.loop.size(); ++k)
    rim.normal += (mesh.position[rim.loop[k]] - rim.centre)
                      .cross(mesh.position[rim.loop[(k + 1) % rim.loop.size()]] - rim.centre);
  rim.normal.normalize();
  return rim;
}

/// Unit normals of the triangles around each vertex.
std::vector<std::vector<Vector3d>> normalsAround(const TriangleMesh& mesh) {
  std::vector<std::vector<Vector3d>> around(mesh.position.size());
  for (const Triangle& t : mesh.triangle) {
    const Vector3d normal = vectorArea(mesh, t).stableNormalized();
    for (const std::uint32_t v : t) around[v].push_back(normal);
  }
  return around;
}

Vector3d inPlane(const Vector3d& direction, const Vector3d* plane) {
  if (plane == nullptr) return direction.normalized();
  const Vector3d flat = direction - direction.dot(*plane) * *plane;
  return flat.norm() > 0 ? flat.normalized() : flat;
}

/// An outward direction turned until its angles with all normals are small, or the best one met.
Vector3d turned(Vector3d direction, const std::vector<Vector3d>& normals, const Vector3d* plane) {
  Vector3d best = direction;
  double most = -2;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const Vector3d* worst = &normals.front();
    for (const Vector3d& n : normals)
      if (n.dot(direction) < worst->dot(direction)) worst = &n;
    const double least = worst->dot(direction);
    if (least > most) {
      most = least;
      best = direction;
    }
    if (least >= kLeastCosine) break;
    direction = inPlane(direction + (kLeastCosine - least + 0.1) * *worst, plane);
  }
  return best;
}

}  // namespace

LayerBase layerBase(const SurfaceMesh& surface) {
  LayerBase base;
  std::vector<std::uint32_t> inBase(surface.position.size(), kAbsent);
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    if (isFlat(surface, t)) continue;
    Triangle triangle = surface.triangle[t];
    for (std::uint32_t& v : triangle) {
      if (inBase[v] == kAbsent) {
        inBase[v] = static_cast<std::uint32_t>(base.vertex.size());
        base.vertex.push_back(v);
        base.mesh.position.push_back(toEigen(surface.position[v]));
      }
      v = inBase[v];
    }
    base.mesh.triangle.push_back(triangle);
    base.group.push_back(surface.group[t]);
  }
  base.rimOf.assign(base.vertex.size(), kAbsent);
  for (const auto& [group, next] : rimEdges(surface, inBase)) {
    base.rims.push_back(rimOf(next, group, base.mesh));
    for (const std::uint32_t v : base.rims.back().loop) {
      if (base.rimOf[v] != kAbsent) throw failed("two flat ends of the surface meet");
      base.rimOf[v] = static_cast<std::uint32_t>(base.rims.size() - 1);
    }
  }
  return base;
}

std::vector<Vector3d> layerDirections(const LayerBase& base, const SurfaceMesh& surface,
                                      const formats::Case& source, double gap) {
  const field::BlendedField blended = formats::caseField(source);
  SeparationOptions separation;
  separation.gap = gap;
  const SeparatedField field(source, blended, separation);
  const std::vector<std::vector<Vector3d>> normals = normalsAround(base.mesh);
  std::vector<Vector3d> direction(base.vertex.size());
  tbb::parallel_for(std::size_t{0}, base.vertex.size(), [&](std::size_t v) {
    const std::uint32_t node = surface.node[base.vertex[v]];
    const SeparatedSample sample = field.at(base.mesh.position[v], node);
    const bool isOnField = std::abs(sample.distance) < kOnField * field.radius(node);
    Vector3d out = toEigen(surface.normal[base.vertex[v]]);
    if (isOnField && sample.gradient.norm() > 0) out = sample.gradient;
    const Vector3d* const plane =
        base.rimOf[v] == kAbsent ? nullptr : &base.rims[base.rimOf[v]].normal;
    direction[v] = -turned(inPlane(out, plane), normals[v], plane);
  });
  return direction;
}

}  // namespace lumen::convert
