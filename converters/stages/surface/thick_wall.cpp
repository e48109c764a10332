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

void liftOuter(const CaseSurface& inner, CaseSurface& outer, const SheetField& field,
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
    const SheetOptions& wall = field.options();
    for (const std::uint32_t v : moved) {
      const SheetSample sample = field.at(outer.mesh.position[v], outer.node[v]);
      const double thickness = wall.offset + wall.offsetShare * field.radius(sample.node);
      outer.mesh.position[v] =
          roundedToFloats(outer.mesh.position[v] + kLift * thickness * sample.gradient);
    }
  }
}

}  // namespace lumen::convert
