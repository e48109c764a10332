// SPDX-License-Identifier: Apache-2.0
// Decimation of a surface, with its measured error.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/remesh/remesh_mesh.h"
#include "converters/stages/surface/separated_field.h"

namespace lumen::convert {

// Collapsing the edges of a surface, the cheapest first.

struct CollapseBounds {
  double maxError = 0;        ///< mm, in both directions, from the mesh as given; 0: no bound
  std::size_t triangles = 0;  ///< ends at this number
};

/// Collapses edges of a mesh without boundary, each onto one of its ends, in the order of the root
/// mean square distance of the vertex that stays from the planes of the faces that were merged into
/// it: in mm, or in targets where there is no bound. No collapse breaks the rules of RemeshMesh,
/// makes a face sharper than 15 degrees that was not, or makes one that runs through another; with
/// a bound, none moves the surface farther away than this. Targets are the lengths of edges. Throws
/// Error(Cancelled).
void collapseCheapest(RemeshMesh& mesh, const CollapseBounds& bounds, const Progress& progress);

/// When decimation ends: at whichever comes first.
struct DecimateOptions {
  double maxError = 0;        ///< mm, from the original surface; 0: no bound
  std::size_t triangles = 0;  ///< ends at this number
};

/// Collapses edges in the order of M. Garland and P. Heckbert, Surface simplification using quadric
/// error metrics, 1997, where the surface stays within `maxError` of the original, in both
/// directions, and gets no new intersections with itself (docs/method.md, section 5, Triangles).
/// Topology, groups and the planes of ends are kept; at least eight edges are left of a rim.
/// Returns the measured distance, mm. Throws Error(Cancelled).
double decimate(CaseSurface& surface, const SeparatedField& field, const DecimateOptions& options,
                Progress& progress);

/// The greatest distance between a surface and the one that it was made from, in both directions,
/// mm, without flat ends.
double distanceBetween(const CaseSurface& one, const CaseSurface& other);

/// A mesh of a surface, and its distance from the surface with all triangles.
struct DetailLevel {
  CaseSurface surface;
  double error = -1;  ///< mm; negative: not measured
};

/// Adds levels to the first one until there are `count`: each has about a quarter of the triangles
/// of its predecessor, or as few as its topology, its rims and its neighbours allow. Throws
/// Error(Cancelled).
void addCoarserLevels(std::vector<DetailLevel>& levels, int count, const SeparatedField& field,
                      Progress& progress);

}  // namespace lumen::convert
