// SPDX-License-Identifier: Apache-2.0
// The wall of a case as triangles.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

// The cell size of the polygonisation of a case, and its limits.

/// Bounds on the lattice that keep positions within int and a node's grid within memory.
constexpr double kMaxPosition = 1e8, kMaxAcross = 1e4;
constexpr std::size_t kMaxSamples = std::size_t{1} << 27;

/// Edge of a cell, mm, at a node of that radius: the case's, or a half, a quarter or an eighth of
/// it, so that the node is two cells wide.
double cellForRadius(double cell, double radius);

/// The greatest cell that leaves a node of that radius two cells wide, mm.
double coarsestCellFor(double radius);

/// Checks the lattice of `cell` mm. Throws Error(InvalidInput), with a cell that is large enough,
/// if it needs more samples at one node, or more triangles in all, than fit into memory. Reads the
/// tree only, so it takes no time.
void checkCell(const formats::Case& source, double cell);

struct PolygoniseOptions {
  /// Edge of a marching-cubes cell, mm; 0: the case's voxel size. Nodes narrower than two cells get
  /// a cell of a half, a quarter or an eighth, so that thin vessels stay whole and round.
  double cell = 0;
};

/// Losses of the patches of a branch against its surface.
struct BranchLosses {
  std::size_t nodes = 0;      ///< nodes that have a model
  std::size_t triangles = 0;  ///< triangles of its patches
  /// nodes of these whose lumen holds no corner of a cell: the cells are too coarse for them
  std::size_t missedNodes = 0;
  std::size_t lostTriangles = 0;  ///< dropped where the surface of the case is not near
  double thinnest = 0;            ///< the least radius of nodes with such losses, mm
  [[nodiscard]] bool any() const { return missedNodes > 0 || lostTriangles > 0; }
};

/// A surface in pieces. Each branch is a group of the surface, with its label and kind Wall, in the
/// tree's order; one without triangles too.
struct Patches {
  SurfaceMesh surface;
  std::vector<BranchLosses> losses;  ///< losses of each branch
};

/// The edge of a cell, mm: the options' value, or the voxel size. Throws as polygonise() does.
double chooseCell(const formats::Case& source, const PolygoniseOptions& options);

/// The surface of a case as patches, one for each node (docs/method.md, section 5). For each node
/// with blobs, marching cubes at the iso-level on a lattice that all nodes share, of the connected
/// component of the lumen at the node's centre. The patch is cut by the radical planes to the
/// node's neighbours, and the node's side kept; the rest is moved onto the surface of the blended
/// field, and dropped where there is none near by. A vessel's free end is cut flat at the end of
/// its last node's cylinder and left open; an aneurysm's dome stays whole.
///
/// Within a patch vertices are shared and the surface is an oriented 2-manifold with boundary.
/// Vertices lie within 1e-3 of the local radius of the surface of the case, but on free ends and
/// where the field itself jumps; patches of adjacent nodes meet in its curve on their radical
/// plane, and share no vertex. Normals are those of the blended field, outward.
///
/// Losses of a branch, where its cells are too coarse for thin vessels, are counted.
///
/// Throws Error(InvalidInput) if the case has no models, no voxel size while `cell` is 0, or at
/// once a cell that is too small for it, and Error(Cancelled).
Patches polygonise(const formats::Case& source, const PolygoniseOptions& options,
                   Progress& progress);

}  // namespace lumen::convert
