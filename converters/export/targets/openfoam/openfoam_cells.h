// SPDX-License-Identifier: Apache-2.0
// Size of the cells inside vessels, the ends that are too thin for them, and the points from which
// the inside is found.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/export/shared/frame.h"
#include "converters/export/targets/openfoam/openfoam.h"
#include "converters/geometry/box.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/stages/editing/trim.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Cubes that are halved until enough of them lie across each vessel. Lengths are in mm.
struct FoamCells {
  double edge = 0;     ///< of the cubes before they are halved
  int across = 0;      ///< cells across a vessel at least, layers at the wall not counted
  int layers = 0;      ///< at the wall
  double count = 0;    ///< estimate of the number of cells
  int mostLevels = 0;  ///< halvings at most

  /// Halvings in a vessel of this radius: one at least, as cells in the middle may be larger.
  [[nodiscard]] int level(double radius) const;
  [[nodiscard]] double edgeAt(int level) const { return edge / (1 << level); }
};

/// The cells of snappyHexMesh for a tree: as many across each vessel as `grain` asks for, which is not
/// Prisms. Their number is estimated.
FoamCells foamCells(const formats::CenterlineTree& tree, FoamGrain grain);

/// Cells that a preset may have: more take hours.
double mostCells(FoamGrain grain);

/// The parts of a case that cells cannot resolve.
struct Unresolved {
  double radius = 0;  ///< mm: thinner ends are gone; 0: none
  std::vector<TrimmedEnd> ends;
  /// Labels of branches between which a link is gone: one of them is too thin there.
  std::vector<std::array<std::string, 2>> links;
};

/// Removes the thinnest ends of a case, and links at which a vessel is as thin, until the estimate of
/// foamCells() is at most mostCells(), or nothing can be removed. Returns what is gone.
Unresolved trimToCells(formats::Case& target, FoamGrain grain);

/// The block of cubes around a surface; `cells` and `box` in the same unit as the result.
struct FoamBlock {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = low;
  std::array<int, 3> count{};
};
FoamBlock foamBlock(const Box3d& box, double edge);

/// The node's centre that lies deepest inside each connected tree with a surface, by tree.
/// `surface`: closed, in `frame`; so are the points.
std::vector<Eigen::Vector3d> deepestPoints(const formats::CenterlineTree& tree,
                                           const SurfaceMesh& surface, const ExportFrame& frame,
                                           const Progress& progress);

}  // namespace lumen::convert
