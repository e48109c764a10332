// SPDX-License-Identifier: Apache-2.0
// The surface of a case as closed 2-manifolds, ready for use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/stages/surface/closing/wall_thickness.h"
#include "converters/stages/surface/remesh/remesh_target.h"
#include "converters/stages/surface/reported_places.h"
#include "converters/stages/surface/simplify/split_edges.h"
#include "converters/stages/surface/surface_options.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct ClosedSurfaceOptions {
  /// Gap between touching vessels, mm; nothing: a tenth of the voxel size, or where the case has
  /// none, a twentieth of the least radius. closedSurface() throws Error(Usage) for a gap wider than
  /// the widest vessel.
  std::optional<double> gap;
  EdgeLength edge;
  bool open = false;                ///< flat ends are left out
  std::vector<EndLength> extend;    ///< flow extensions
  std::optional<Length> thickness;  ///< thickness of a wall around the lumen: the solid is the wall
  Touching touching = Touching::Share;  ///< walls of vessels that touch
  /// Greatest distance from the field: as few triangles as it allows, instead of edges of equal
  /// lengths. Around a wall of some thickness, the distance from the surface with all triangles.
  std::optional<SurfaceError> maxError;
  /// Greatest number of triangles: as many are dropped as it takes, wherever the surface may then
  /// lie, unless its topology and its rims need more.
  std::optional<std::int64_t> maxTriangles;
  /// Where neither of these is stated, and no thickness: as few triangles as kUsualSurfaceError
  /// allows.
  bool fewTriangles = false;
  /// Adds the surface with edges of equal lengths as a level before the one that maxError or
  /// maxTriangles simplify.
  bool withWhole = false;
  int levels = 1;  ///< number of levels of detail

  static ClosedSurfaceOptions withFewTriangles() {
    ClosedSurfaceOptions options;
    options.fewTriangles = true;
    return options;
  }
};

/// Results besides the surface, and its differences from the field. Places are in mm, LPS.
struct SurfaceReport {
  double gap = 0;                           ///< mm
  std::size_t trees = 0;                    ///< closed surfaces, one for each connected tree
  std::size_t vertices = 0, triangles = 0;  ///< counts of the finest level
  std::size_t flatEnds = 0, roundedEnds = 0;
  std::size_t openedEdges = 0;        ///< tree edges that the field closes
  std::vector<Eigen::Vector3d> cuts;  ///< where a lumen that runs into itself was cut
  std::vector<Overlap> overlaps;      ///< deepest first
  std::size_t offField = 0;           ///< vertices with no surface of the field near by
  std::size_t sharpTriangles = 0;     ///< with an angle under 15 degrees
  double leastAngle = 0;              ///< degrees, of all triangles of the finest level
  double volume = 0, area = 0;        ///< mm^3, mm^2, of the finest level, before ends are opened
  std::size_t crossings = 0;          ///< pairs of triangles that pass through each other
  std::optional<WallThickness> wall;  ///< where a thickness was asked for
  /// By level: greatest distance from the surface with all triangles, mm; below 0: it has all. With
  /// `fieldError`, that of the first level is from the field.
  std::vector<double> errors;
  std::optional<FieldError> fieldError;  ///< of a surface that maxError made, without a wall
  std::vector<std::string> messages;     ///< sentences about ends and extensions
};

struct ClosedSurface {
  std::vector<SurfaceMesh> levels;  ///< the finest first
  SurfaceReport report;
};

/// The blended surface of a case, docs/method.md, section 5: for each connected tree a closed,
/// oriented 2-manifold whose genus is the number of loops that links close, with planar ends.
/// Vertices lie within 1e-3 of the local radius of the blended field, but on ends and where vessels
/// overlap. Throws Error(InvalidInput) if the case has no models or the surface would not fit into
/// memory, Error(Usage) for options that do not go together, and Error(Cancelled). A wall is closed
/// whatever its thickness. Between lumens that touch it is half as thick as asked for, or more, and
/// with Touching::Apart each lumen has a third of that, and a gap in the middle.
ClosedSurface closedSurface(const formats::Case& source, const ClosedSurfaceOptions& options,
                            Progress& progress);

/// A preview of the blended surface, in a tenth of the time: the extracted surface, with triangles
/// of any shape, within a few per cent of a radius of the field's surface, and with the ends of the
/// field.
SurfaceMesh quickSurface(const formats::Case& source, Progress& progress);

}  // namespace lumen::convert
