// SPDX-License-Identifier: Apache-2.0
// Repair of crossings between walls of vessels, where triangles are too coarse for the gap between
// them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/box.h"
#include "converters/geometry/box_tree.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/remesh/remesh_target.h"
#include "converters/stages/surface/separated_field.h"

namespace lumen::convert {

// Boxes in which something is the matter, few beside the triangles of a surface.

/// The box of a triangle's corners.
Box3d boxOf(const TriangleMesh& mesh, const Triangle& triangle);

/// Boxes, and whether another one meets any of them. Any number of threads may ask.
class BoxSet {
public:
  explicit BoxSet(std::vector<Box3d> boxes);
  [[nodiscard]] bool isEmpty() const { return m_boxes.empty(); }
  [[nodiscard]] bool meets(const Box3d& box) const;

private:
  std::vector<Box3d> m_boxes;
  BoxTree<double> m_tree;
};

/// The crossings among some triangles of a mesh, `isAmong` by triangle. Throws Error(Cancelled).
SelfIntersections crossingsAmong(const TriangleMesh& mesh, const std::vector<std::uint8_t>& isAmong,
                                 const Progress& progress);

/// Finds the crossings of meshes that are made one after another and share most triangles.
class CrossingSearch {
public:
  /// The pairs of triangles of a mesh that cross, as selfIntersections() finds them. In all meshes
  /// but the first, only triangles near those that the first one has not, or that cross there, are
  /// looked at. Throws Error(Cancelled).
  SelfIntersections find(const TriangleMesh& mesh, const Progress& progress);

private:
  void keep(const TriangleMesh& mesh, const SelfIntersections& found);
  [[nodiscard]] std::size_t bucketOf(std::uint64_t hash) const;
  [[nodiscard]] bool isKnown(const TriangleMesh& mesh, const Triangle& triangle) const;

  TriangleMesh m_first;
  /// Hashes of the first mesh's triangles that cross nothing, by the places of their corners, with
  /// their indices; ascending.
  std::vector<std::pair<std::uint64_t, std::uint32_t>> m_known;
  std::vector<std::uint32_t> m_start;  ///< place in m_known of the first hash of each bucket
};

/// Rounds all positions to floats, as files hold them, so that no crossing appears when they are
/// written. Then moves the triangles that pass through others back into their own lumens, in steps of a quarter
/// of the gap or of a fiftieth of the radius, whichever is more, until none does, or eight times.
/// Vertices of flat ends stay where they are. Returns the pairs that still intersect. After the first
/// search, by `search`, only triangles near those that were moved are looked at. Throws
/// Error(Cancelled).
SelfIntersections mendCrossings(CaseSurface& surface, const SeparatedField& field,
                                CrossingSearch& search, Progress& progress);

/// Takes a surface off its field where nothing else helps: moves the vertices of the crossing
/// triangles `found` to the middles of their neighbours until none cross. Leaves the surface as it was
/// if no fewer pairs are left; else `found` becomes those. Returns the number of moved vertices.
std::size_t smoothCrossings(CaseSurface& surface, SelfIntersections& found, Progress& progress);

// Remeshing that does not make a surface pass through itself.

/// Remaining faults after refine().
struct RefineReport {
  std::size_t offField = 0, sharp = 0;  ///< see RemeshReport
  std::size_t crossings = 0;            ///< pairs of triangles that pass through each other
};

/// Remeshes a surface that does not intersect itself (remesh.h) and mends crossings
/// (mend_crossings.h). Where some are left, the surface stays as it was given within a radius of
/// them, and all else is remeshed again; then within two, four and eight radii. Throws
/// Error(Cancelled).
RefineReport refine(CaseSurface& surface, const SeparatedField& field, const EdgeLength& edge,
                    Progress& progress);

}  // namespace lumen::convert
