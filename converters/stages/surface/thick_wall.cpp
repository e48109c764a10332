// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/thick_wall.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/cut_ends.h"
#include "converters/stages/surface/flat_region.h"
#include "converters/stages/surface/surface_fans.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

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

void requireApart(const CaseSurface& solid, const formats::Case& source) {
  const SelfIntersections found = selfIntersections(solid.mesh);
  if (found.pairs.empty()) return;
  const std::uint32_t node = solid.node[solid.mesh.triangle[found.pairs[0][0]][0]];
  const std::string& label = source.tree.branches[source.tree.branch[node]].label;
  throw failed("the wall runs through itself at " + std::to_string(found.pairs.size()) +
               " pairs of triangles, first in branch " + formats::printable(label) +
               "; expected a thicker wall, or a shorter edge");
}

}  // namespace

CaseSurface thickWall(const CaseSurface& inner, const CaseSurface& outer,
                      const formats::Case& source) {
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
  requireApart(solid, source);
  return solid;
}

}  // namespace lumen::convert
