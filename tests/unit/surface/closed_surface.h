// SPDX-License-Identifier: Apache-2.0
// Closed surfaces of synthetic cases, as rough as an extraction may leave them.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/random.h"
#include "converters/geometry/marching_cubes.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/patches/patch.h"
#include "converters/stages/surface/separated_field.h"
#include "formats/case/case_field.h"

namespace lumen::test {

/// A case with what asks about its surface.
struct FieldOfCase {
  std::unique_ptr<const formats::Case> kept;
  const formats::Case& source;
  field::BlendedField blended;
  convert::SeparatedField sheet;
  explicit FieldOfCase(formats::Case given, double gap = 0.02)
      : kept(std::make_unique<formats::Case>(std::move(given))),
        source(*kept),
        blended(formats::caseField(source)),
        sheet(source, blended, {gap, 0, 0}) {}
};

/// f - T at a point, with the cursor at the node of least power and what follows from it.
inline double valueAt(const field::BlendedField& field, const Eigen::Vector3d& p) {
  const field::Vec point{p.x(), p.y(), p.z()};
  const std::uint32_t node = field.follow(point, field.locate(point));
  return field.blended(point, node).value - field.level();
}

inline convert::SampleGrid gridOf(const FieldOfCase& of, double cell) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  const formats::CenterlineTree& tree = of.source.tree;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const Eigen::Vector3d c(tree.centre[n].x, tree.centre[n].y, tree.centre[n].z);
    const double reach = 3 * double{tree.radius[n]};
    low = low.cwiseMin(c - Eigen::Vector3d::Constant(reach));
    high = high.cwiseMax(c + Eigen::Vector3d::Constant(reach));
  }
  convert::SampleGrid grid;
  grid.cell = cell;
  const Eigen::Vector3i first = (low / cell).array().floor().cast<int>(),
                        last = (high / cell).array().ceil().cast<int>();
  grid.lowY = first.y();
  grid.lowZ = first.z();
  grid.rowsY = last.y() - first.y() + 1;
  grid.rowsZ = last.z() - first.z() + 1;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y) {
      grid.rows.push_back({first.x(), last.x() - first.x() + 1, grid.value.size()});
      for (int x = first.x(); x <= last.x(); ++x)
        grid.value.push_back(valueAt(of.blended, cell * Eigen::Vector3d(x, y, z)));
    }
  return grid;
}

/// The surface of the case by marching cubes, closed as the field closes it; each vertex moved in
/// any direction by up to `jitter` cells.
inline convert::CaseSurface closedSurface(const FieldOfCase& of, double cell, double jitter) {
  const convert::SampleGrid grid = gridOf(of, cell);
  std::vector<convert::SampleState> state;
  for (const double f : grid.value)
    state.push_back(f > 0 ? convert::SampleState::Inside : convert::SampleState::Outside);
  convert::CaseSurface surface;
  surface.mesh = convert::marchingCubes(
      grid, state, [](const Eigen::Vector3d&, double fa, const Eigen::Vector3d&, double fb) {
        return fa / (fa - fb);
      });
  Random random(7);
  for (Eigen::Vector3d& p : surface.mesh.position) {
    const auto shift = [&] { return jitter * cell * random.uniform(-1, 1) / 1.75; };
    const double x = shift(), y = shift(), z = shift();
    p += Eigen::Vector3d(x, y, z);
    const field::Vec point{p.x(), p.y(), p.z()};
    surface.node.push_back(of.blended.follow(point, of.blended.locate(point)));
  }
  surface.group.assign(surface.mesh.triangle.size(), 0);
  surface.groups = {{"wall", convert::FaceKind::Wall}};
  return surface;
}

/// Cuts the surface with the plane through `centre` normal to `normal`, drops what lies beyond, and
/// closes it with a fan of triangles, a group of its own.
inline void cutFlat(convert::CaseSurface& surface, const FieldOfCase& of, const std::string& name,
                    const Eigen::Vector3d& centre, const Eigen::Vector3d& normal) {
  // clip() knows no groups: each goes through it alone, but only the wall is cut.
  convert::TriangleMesh wall, rest = surface.mesh;
  wall.position = surface.mesh.position;
  std::vector<convert::Triangle> kept;
  std::vector<std::uint32_t> groups;
  for (std::size_t t = 0; t < surface.group.size(); ++t)
    if (surface.group[t] == 0) {
      wall.triangle.push_back(surface.mesh.triangle[t]);
    } else {
      kept.push_back(surface.mesh.triangle[t]);
      groups.push_back(surface.group[t]);
    }
  // Vertices of the other groups by place: clip() numbers them anew.
  convert::clip(wall, {normal, normal.dot(centre)}, 1e-4);
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::map<Eigen::Vector3d, std::uint32_t, decltype(less)> index(less);
  for (std::uint32_t v = 0; v < wall.position.size(); ++v) index.emplace(wall.position[v], v);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  for (const convert::Triangle& t : wall.triangle)
    for (std::size_t i = 0; i < 3; ++i) ++directed[{t[i], t[(i + 1) % 3]}];
  surface.mesh = wall;
  surface.group.assign(wall.triangle.size(), 0);
  for (std::size_t t = 0; t < kept.size(); ++t) {
    convert::Triangle& made = surface.mesh.triangle.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [place, isNew] = index.emplace(
          rest.position[kept[t][i]], static_cast<std::uint32_t>(surface.mesh.position.size()));
      if (isNew) surface.mesh.position.push_back(place->first);
      made[i] = place->second;
    }
    surface.group.push_back(groups[t]);
  }
  const auto group = static_cast<std::uint32_t>(surface.groups.size());
  surface.groups.push_back({name, convert::FaceKind::Outlet});
  const auto middle = static_cast<std::uint32_t>(surface.mesh.position.size());
  surface.mesh.position.push_back(centre);
  const auto isOnPlane = [&](std::uint32_t v) {
    return std::abs(normal.dot(surface.mesh.position[v] - centre)) < 2e-4;
  };
  for (const auto& [edge, count] : directed) {
    if (directed.contains({edge.second, edge.first}) || !isOnPlane(edge.first) ||
        !isOnPlane(edge.second))
      continue;
    surface.mesh.triangle.push_back({edge.second, edge.first, middle});
    surface.group.push_back(group);
  }
  surface.node.clear();
  for (Eigen::Vector3d& p : surface.mesh.position) {
    if (std::abs(normal.dot(p - centre)) < 2e-4) p -= normal.dot(p - centre) * normal;
    const field::Vec point{p.x(), p.y(), p.z()};
    surface.node.push_back(of.blended.follow(point, of.blended.locate(point)));
  }
  surface.ends.push_back({group, 0, surface.node[middle], centre, normal});
}

}  // namespace lumen::test
