// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/openfoam_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "converters/base/vectors.h"
#include "converters/export/shared/surface.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/triangle_tree.h"

namespace lumen::convert {

namespace {

constexpr double kAcross = 10;        // cells across a vessel that resolve a parabola of speeds
constexpr double kMostAtWall = 1e6;   // cells: some 2 GB and half an hour for the mesh
constexpr double kMostInBlock = 3e5;  // cells before they are halved
// Layers of the finest cells on both sides of the wall while the mesh is made: nCellsBetweenLevels
// and the wall's own.
constexpr double kLayers = 8;

Eigen::Vector3d at(const SurfaceMesh& surface, std::uint32_t vertex) {
  return toEigen(surface.position[vertex]);
}

double areaOf(const SurfaceMesh& surface) {
  double area = 0;
  for (const Triangle& t : surface.triangle)
    area +=
        0.5 *
        (at(surface, t[1]) - at(surface, t[0])).cross(at(surface, t[2]) - at(surface, t[0])).norm();
  return area;
}

TriangleMesh trianglesOf(const SurfaceMesh& surface) {
  TriangleMesh mesh;
  for (std::uint32_t v = 0; v < surface.position.size(); ++v)
    mesh.position.push_back(at(surface, v));
  mesh.triangle = surface.triangle;
  return mesh;
}

}  // namespace

FoamCells foamCells(const SurfaceMesh& surface, double least) {
  const Box3d box = boundingBox(surface);
  FoamCells cells;
  cells.atWall = std::max(2 * least / kAcross, std::sqrt(kLayers * areaOf(surface) / kMostAtWall));
  cells.acrossThinnest = 2 * least / cells.atWall;
  // one halving at least: cells in the middle of vessels may be larger than those at walls
  const double edge = std::max(2 * cells.atWall, std::cbrt(box.size().prod() / kMostInBlock));
  cells.level = static_cast<int>(std::ceil(std::log2(edge / cells.atWall) - 1e-9));
  // no face of a cell may lie in a flat end, so the block begins at an uneven share of a cell
  // before the surface
  constexpr double kMargin = 1.37;
  cells.low = box.low - Eigen::Vector3d::Constant(kMargin * cells.edge());
  for (int a = 0; a < 3; ++a)
    cells.count[static_cast<std::size_t>(a)] =
        static_cast<int>(std::ceil((box.high[a] - cells.low[a]) / cells.edge() + kMargin));
  return cells;
}

std::vector<Eigen::Vector3d> deepestPoints(const formats::CenterlineTree& tree,
                                           const SurfaceMesh& surface, const ExportFrame& frame,
                                           const Progress& progress) {
  DisjointSets sets(tree.nodeCount());
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if (tree.parent[n] != formats::kNoParent)
      sets.join(static_cast<std::uint32_t>(tree.parent[n]), n);
  for (const auto& [a, b] : tree.links) sets.join(a, b);
  const TriangleMesh mesh = trianglesOf(surface);
  const TriangleTree triangles(mesh);
  struct Deepest {
    double depth = 0;
    Eigen::Vector3d point;
  };
  std::map<std::uint32_t, Deepest> deepest;  // keys: the tree's least node
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    progress.check();
    const Eigen::Vector3d centre = frame.position(toEigen(tree.centre[n]));
    Deepest& best = deepest[sets.find(n)];
    const double depth = triangles.nearest(centre).distance;
    if (depth > best.depth && triangles.contains(centre)) best = {depth, centre};
  }
  std::vector<Eigen::Vector3d> points;
  for (const auto& [least, best] : deepest)
    if (best.depth > 0) points.push_back(best.point);
  return points;
}

}  // namespace lumen::convert
