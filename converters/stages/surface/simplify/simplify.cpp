// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/deviation.h"
#include "converters/stages/surface/remesh/mend_crossings.h"
#include "converters/stages/surface/simplify/close_sheets.h"
#include "converters/stages/surface/simplify/collapse_edges.h"

namespace lumen::convert {
namespace {

constexpr double kBoundShare = 0.9;  // share for vertices that went; the rest is for places between
// Distance of two sheets that could meet, in allowed errors: each may bend by more than its own
// between its vertices.
constexpr double kCloseErrors = 4;
// Distance of sheets that do not meet before a surface has an eighth of its triangles, in radii.
constexpr double kFar = 0.5;
constexpr std::size_t kFewerWhereFar = 8;
constexpr int kMostAttempts = 3;
constexpr std::size_t kMostCounted = 1'000'000;

std::size_t countCrossings(const CaseSurface& surface, const Progress& progress) {
  return selfIntersections(surface.mesh, kMostCounted, &progress).pairs.size();
}

/// How close vertices are to others that they could meet within bounds, by vertex.
std::vector<float> closeWithin(const CaseSurface& surface, std::vector<double> allowed) {
  for (double& mm : allowed) mm *= kCloseErrors;
  return closeVertices(surface.mesh, allowed);
}

/// Makes the vertices of a surface close that are near crossing triangles of one made from it.
void markNear(const CaseSurface& surface, const CaseSurface& made, const SelfIntersections& found,
              std::vector<float>& closeFrom) {
  std::vector<Box3d> boxes;
  for (const auto& pair : found.pairs)
    for (const std::uint32_t t : pair) {
      Box3d& box = boxes.emplace_back(boxOf(made.mesh, made.mesh.triangle[t]));
      const double margin = box.size().maxCoeff();
      box.add(box.low, margin);
      box.add(box.high, margin);
    }
  const BoxSet near(std::move(boxes));
  closeFrom.resize(surface.mesh.position.size(), kNotClose);
  tbb::parallel_for(std::size_t{0}, closeFrom.size(), [&](std::size_t v) {
    Box3d point;
    point.add(surface.mesh.position[v]);
    if (near.meets(point)) closeFrom[v] = 0;
  });
}

/// Collapses edges down to a number of triangles, wherever the surface may then lie; returns, by
/// triangle, which are near others. Triangles far from others meet none as long as they are small.
std::vector<std::uint8_t> collapseTo(CaseSurface& surface, const SeparatedField& field,
                                     std::size_t triangles, Progress& progress) {
  const std::size_t small = surface.mesh.triangle.size() / kFewerWhereFar;
  if (triangles < small) {
    CollapseRules rules{{}, small, {}};
    std::vector<double> reach;
    for (const std::uint32_t node : surface.node) reach.push_back(kFar * field.radius(node));
    rules.closeFrom = closeVertices(surface.mesh, reach);
    collapseEdges(surface, rules, progress);
  }
  return collapseEdges(surface, {{}, triangles, {}}, progress);
}

/// Smooths places where triangles pass through others, if that helps and leaves none farther off than
/// the farthest was.
void smooth(CaseSurface& surface, SelfIntersections found, const SeparatedField& field,
            const SurfaceError& allowed, SimplifyReport& report, Progress& progress) {
  CaseSurface smoothed = surface;
  smoothCrossings(smoothed, found, progress);
  if (!found.pairs.empty()) return;
  const FieldError error = fieldErrorOf(smoothed, field, allowed, progress);
  if (error.greatest > report.error.greatest) return;
  surface = std::move(smoothed);
  report = {error, 0};
}

std::vector<bool> flatGroups(const CaseSurface& surface) {
  std::vector<bool> isFlat(surface.groups.size(), false);
  for (const SurfaceEnd& end : surface.ends)
    isFlat[end.group] = surface.groups[end.group].kind != FaceKind::Cap;
  return isFlat;
}

}  // namespace

SimplifyReport simplifyToField(CaseSurface& surface, const SeparatedField& field,
                               const SurfaceError& allowed, std::size_t triangles,
                               Progress& progress) {
  progress.begin("triangles", 0);
  roundToFloats(surface.mesh);
  const CaseSurface given = surface;
  SimplifyReport report;
  const bool isBounded = std::isfinite(allowed.mm);
  CollapseRules rules{{}, triangles, {}};
  if (isBounded)
    for (const std::uint32_t node : surface.node)
      rules.allowed.push_back(kBoundShare * chordAt(field, node, allowed));
  if (isBounded) rules.closeFrom = closeWithin(surface, rules.allowed);
  for (int attempt = 1;; ++attempt) {
    std::vector<std::uint8_t> isClose = isBounded || attempt == kMostAttempts
                                            ? collapseEdges(surface, rules, progress)
                                            : collapseTo(surface, field, triangles, progress);
    report.error = splitFarEdges(surface, field, allowed, isClose, progress);
    const SelfIntersections found = selfIntersections(surface.mesh, kMostCounted, &progress);
    report.crossings = found.pairs.size();
    if (report.crossings > 0) smooth(surface, found, field, allowed, report, progress);
    if (report.crossings == 0 || attempt == kMostAttempts) break;
    // between sheets that did not seem close: once more, looking there, and then everywhere
    if (attempt + 1 == kMostAttempts)
      rules.closeFrom.clear();
    else
      markNear(given, surface, found, rules.closeFrom);
    surface = given;
  }
  if (report.crossings > 0) {
    surface = given;
    report.error = fieldErrorOf(surface, field, allowed, progress);
    report.crossings = countCrossings(surface, progress);
  }
  progress.end();
  return report;
}

double distanceBetween(const CaseSurface& one, const CaseSurface& other) {
  return distanceBetween(one.mesh, one.group, other.mesh, other.group, flatGroups(one));
}

double simplify(CaseSurface& surface, const SimplifyOptions& options, Progress& progress) {
  if (options.triangles >= surface.mesh.triangle.size() ||
      (options.triangles == 0 && !(options.maxError > 0)))
    return 0;
  const CaseSurface before = surface;
  double bound = kBoundShare * options.maxError;
  for (int attempt = 1;; ++attempt) {
    constexpr int kTries = 5;
    CollapseRules rules{{}, options.triangles, {}};
    if (bound > 0) {
      rules.allowed.assign(surface.mesh.position.size(), bound);
      rules.closeFrom = closeWithin(surface, rules.allowed);
    }
    collapseEdges(surface, rules, progress);
    if (!rules.closeFrom.empty() && countCrossings(surface, progress) > 0) {
      surface = before;
      rules.closeFrom.clear();
      collapseEdges(surface, rules, progress);
    }
    progress.check();
    const double error = distanceBetween(surface, before);
    if (!(options.maxError > 0) || error <= options.maxError) return error;
    bound *= kBoundShare * options.maxError / error;
    surface = before;
    if (attempt == kTries) return 0;
  }
}

void addCoarserLevels(std::vector<DetailLevel>& levels, int count, Progress& progress) {
  while (static_cast<int>(levels.size()) < count) {
    CaseSurface next = levels.back().surface;
    collapseEdges(next, {{}, next.mesh.triangle.size() / 4, {}}, progress);
    levels.push_back({std::move(next), -1});
  }
}

}  // namespace lumen::convert
