// SPDX-License-Identifier: Apache-2.0
// Size of the cells inside vessels, and the points from which the inside is found.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/export/shared/frame.h"
#include "converters/io/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Cubes around a surface, halved `level` times at it. Lengths are in the unit of the surface.
struct FoamCells {
  double atWall = 0;                              ///< edge of the cells at the wall
  int level = 0;                                  ///< halvings
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< least corner of the block
  std::array<int, 3> count{};                     ///< number of its cells, before they are halved
  double acrossThinnest = 0;                      ///< cells across the thinnest vessel

  [[nodiscard]] double edge() const { return atWall * (1 << level); }  ///< the block's cells'
};

/// Ten cells across the thinnest vessel, of the radius `least`; fewer where more than about a
/// million would be needed.
FoamCells foamCells(const SurfaceMesh& surface, double least);

/// The node's centre that lies deepest inside each connected tree with a surface, by tree.
/// `surface`: closed, in `frame`; so are the points.
std::vector<Eigen::Vector3d> deepestPoints(const formats::CenterlineTree& tree,
                                           const SurfaceMesh& surface, const ExportFrame& frame,
                                           const Progress& progress);

}  // namespace lumen::convert
