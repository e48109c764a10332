// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "converters/stages/surface/deviation.h"
#include "converters/stages/surface/remesh/mend_crossings.h"
#include "converters/stages/surface/simplify/collapse_edges.h"

namespace lumen::convert {
namespace {

constexpr double kFirstKept = 1;     // radii around a crossing; twice as many each time
constexpr int kMostAttempts = 9;     // then the whole surface stays
constexpr int kPerNumber = 3;        // attempts at one number of triangles; then twice as many
constexpr double kBoundShare = 0.9;  // share for vertices that went; the rest is for places between

/// Makes a surface by make(surface, isKept, places, factor) from `given`, again and again with more of
/// it kept, until search(surface) finds no crossings; `places` are the boxes of what is kept, and a
/// number of triangles that is asked for counts `factor` times. Returns the pairs that are left, none
/// or those that `given` has.
template <class Make, class Search>
std::size_t withoutCrossings(CaseSurface& surface, const SeparatedField& field, Progress& progress,
                             const Make& make, const Search& search) {
  const CaseSurface given = surface;
  std::vector<Box3d> places;
  double reach = kFirstKept;
  for (int attempt = 1;; ++attempt, reach *= 2) {
    if (attempt % kPerNumber == 1) reach = kFirstKept;
    surface = given;
    make(surface, verticesIn(given, places), places, std::size_t{1} << (attempt - 1) / kPerNumber);
    progress.check();
    const SelfIntersections left = search(surface);
    if (left.pairs.empty()) return 0;
    if (attempt == kMostAttempts) break;
    addPlaces(surface, field, left, reach, places);
  }
  surface = given;
  return selfIntersections(surface.mesh, SIZE_MAX, &progress).pairs.size();
}

void collapse(CaseSurface& surface, const SeparatedField& field, const SimplifyOptions& options,
              Progress& progress) {
  CrossingSearch crossings;
  withoutCrossings(
      surface, field, progress,
      [&](CaseSurface& made, std::vector<std::uint8_t> isKept, const std::vector<Box3d>&,
          std::size_t factor) {
        CollapseRules rules{{}, factor * options.triangles, std::move(isKept)};
        if (options.maxError > 0) rules.allowed.assign(made.mesh.position.size(), options.maxError);
        collapseEdges(made, rules, progress);
      },
      [&](CaseSurface& made) { return crossings.find(made.mesh, progress); });
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
  SimplifyReport report;
  CrossingSearch crossings;
  report.crossings = withoutCrossings(
      surface, field, progress,
      [&](CaseSurface& made, std::vector<std::uint8_t> isKept, const std::vector<Box3d>& places,
          std::size_t factor) {
        CollapseRules rules{{}, factor * triangles, std::move(isKept)};
        if (std::isfinite(allowed.mm))
          for (const std::uint32_t node : made.node)
            rules.allowed.push_back(kBoundShare * chordAt(field, node, allowed));
        collapseEdges(made, rules, progress);
        report.error = splitFarEdges(made, field, allowed, places, progress);
      },
      [&](CaseSurface& made) {
        SelfIntersections left = mendCrossings(made, field, crossings, progress);
        if (!left.pairs.empty() && smoothCrossings(made, left, progress) > 0)
          report.error = fieldErrorOf(made, field, allowed, progress);
        return left;
      });
  progress.end();
  return report;
}

double distanceBetween(const CaseSurface& one, const CaseSurface& other) {
  return distanceBetween(one.mesh, one.group, other.mesh, other.group, flatGroups(one));
}

double simplify(CaseSurface& surface, const SeparatedField& field, const SimplifyOptions& options,
                Progress& progress) {
  if (options.triangles >= surface.mesh.triangle.size() ||
      (options.triangles == 0 && !(options.maxError > 0)))
    return 0;
  const CaseSurface before = surface;
  double bound = kBoundShare * options.maxError;
  for (int attempt = 1;; ++attempt) {
    constexpr int kTries = 5;
    collapse(surface, field, {bound, options.triangles}, progress);
    progress.check();
    const double error = distanceBetween(surface, before);
    if (!(options.maxError > 0) || error <= options.maxError) return error;
    bound *= kBoundShare * options.maxError / error;
    surface = before;
    if (attempt == kTries) return 0;
  }
}

void addCoarserLevels(std::vector<DetailLevel>& levels, int count, const SeparatedField& field,
                      Progress& progress) {
  while (static_cast<int>(levels.size()) < count) {
    CaseSurface next = levels.back().surface;
    collapse(next, field, {0, next.mesh.triangle.size() / 4}, progress);
    levels.push_back({std::move(next), -1});
  }
}

}  // namespace lumen::convert
