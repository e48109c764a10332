// SPDX-License-Identifier: Apache-2.0
// The course of a vessel inside of a surface, before it gets nodes.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/io/centerline/centerline_file.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct VesselLine {
  std::string label;
  std::vector<Eigen::Vector3d> point;  ///< mm, LPS, away from the parent, on whose line it begins
  std::vector<double> depth;           ///< mm, at each point, of a line that is complete
  int parent = -1;                     ///< a line before this one, or -1
  int meets = -1;                      ///< the line that the last point joins: a loop; or -1
  bool isSac = false;
  bool reachesStart = false;  ///< its first point is where the lumen ends, not a place in it
  bool reachesEnd = false;    ///< its last point is where the lumen ends, not a place in it
};

/// The surface of vessels, with distances to its wall, which leaves out flat ends.
class LumenGeometry {
public:
  /// `surface` must stay; not all of it is ends.
  explicit LumenGeometry(const ClosedMesh& surface)
      : m_surface(surface),
        m_wall(extractWall(surface)),
        m_tree(surface.mesh),
        m_wallTree(m_wall) {}
  LumenGeometry(const LumenGeometry&) = delete;
  LumenGeometry& operator=(const LumenGeometry&) = delete;
  [[nodiscard]] const ClosedMesh& surface() const { return m_surface; }
  [[nodiscard]] const TriangleTree& tree() const { return m_tree; }
  /// Distance to the wall, mm; flat ends are no wall.
  [[nodiscard]] double depth(const Eigen::Vector3d& point) const {
    return m_wallTree.nearest(point).distance;
  }
  /// The triangle is part of a vessel's wall, and not of a flat end.
  [[nodiscard]] bool isWall(std::uint32_t triangle) const {
    return m_surface.end[triangle] == ClosedMesh::kWall;
  }

private:
  static TriangleMesh extractWall(const ClosedMesh& surface);
  const ClosedMesh& m_surface;
  TriangleMesh m_wall;
  TriangleTree m_tree, m_wallTree;
};

/// Lengths from the first point to each, mm.
std::vector<double> lengthsAlong(std::span<const Eigen::Vector3d> line);

/// The place at `length` mm along a polyline of two points or more with these lengths.
Eigen::Vector3d placeAt(std::span<const Eigen::Vector3d> line, std::span<const double> lengths,
                        double length);

/// The widths of the lumen along a line, mm: at each point its depth, or that of another point of
/// the line less half the distance to it along the line, so that round ends are not thin.
std::vector<double> widthsAlong(std::span<const Eigen::Vector3d> line, const LumenGeometry& lumen);

/// The unit direction of a line at one of its points, over `reach` mm on either side.
Eigen::Vector3d lineDirection(std::span<const Eigen::Vector3d> line, std::size_t i, double reach);

/// Distance of a point from a line, mm, and the line's nearest point.
std::pair<double, std::size_t> distanceTo(std::span<const Eigen::Vector3d> line,
                                          const Eigen::Vector3d& point);

/// Spacing of the points of evenly(), as a share of the width.
constexpr double kLineStep = 0.25;

/// Resamples a line by points that are a quarter of its width apart; both ends stay.
std::vector<Eigen::Vector3d> evenly(std::span<const Eigen::Vector3d> line,
                                    const LumenGeometry& lumen);

/// Measures the depths of a line whose points no longer change.
void measureDepths(VesselLine& line, const LumenGeometry& lumen);

/// Moves the points of a line, but the first and the last, into the middle of the lumen: to the
/// centroids of the sections across it, as far as 1.6 times the median of each section's rays.
/// Points that lie within the lumen of `parent` (which may be null, and is complete), and its wall
/// around them, stay on a smooth curve.
void centre(VesselLine& line, const VesselLine* parent, const LumenGeometry& lumen);

/// Removes the tip of a path through voxels: the points that are nearer to its last point than the
/// wall is; `atStart`: to its first.
void trim(VesselLine& line, bool atStart, const LumenGeometry& lumen);

/// The flat end that a tip lies at, nearer to its centre than 1.5 of its radii: the nearest one; null
/// if there is none.
const MeshEnd* endAt(const Eigen::Vector3d& tip, const ClosedMesh& surface);

/// Extends a line to the end of its lumen: straight on to the wall, or to the centre of a flat end
/// there, if that is within `reach` depths.
void extend(VesselLine& line, bool atStart, double reach, const LumenGeometry& lumen);

// The courses of all vessels inside of a surface: found, or from a centerline of another program.

struct VesselLines {
  std::vector<VesselLine> lines;   ///< parents first
  std::vector<std::string> notes;  ///< remarks for the user, a sentence each
};

/// The vessels of each connected part of the inside (docs/method.md, section 10): from its widest
/// flat end, or else from its widest tip. `grid` is that of insideGrid(). `allOpenings`: a line leads to
/// each opening, however short it is. Throws Error(Cancelled).
VesselLines findLines(const LumenGeometry& lumen, const VolumeGeometry& grid, bool allOpenings,
                      Progress& progress);

/// The chains of a centerline (mm, LPS), without their parts outside. Throws Error(InvalidInput),
/// `name` (of its file, printable) first, if less than half of its points lie inside; the message
/// reports if more would with x and y negated or in another unit.
VesselLines clipLines(const CenterlineFile& centerline, const std::string& name,
                      const LumenGeometry& lumen);

// The lines of vessels as a tree of nodes with wall points.

/// Tree and wall points of the lines, a branch each, in their order. Nodes are a width apart; those
/// of a child within its parent's lumen are bridged and have no points. Wall points are where rays
/// from a node's centre first meet the wall, without those that belong to nodes near by along the
/// tree: those more than three quarters of the distance towards them, by power. So another vessel's
/// wall, which no ray reaches, and the far wall of a fork belong to no node. No radius is below
/// `least`, mm: where a line passes so near to the wall, nothing shows how wide the lumen is.
/// Throws Error(Cancelled).
formats::Case nodesOnLines(const std::vector<VesselLine>& lines, const LumenGeometry& lumen,
                           double least, Progress& progress);

}  // namespace lumen::convert
