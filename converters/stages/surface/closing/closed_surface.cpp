// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/closed_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/geometry/self_intersections.h"
#include "converters/geometry/triangle_quality.h"
#include "converters/stages/surface/closing/cut_ends.h"
#include "converters/stages/surface/closing/end_planes.h"
#include "converters/stages/surface/closing/flow_extension.h"
#include "converters/stages/surface/closing/thick_wall.h"
#include "converters/stages/surface/closing/wall_thickness.h"
#include "converters/stages/surface/extract.h"
#include "converters/stages/surface/remesh/mend_crossings.h"
#include "converters/stages/surface/remesh/remesh_target.h"
#include "converters/stages/surface/reported_places.h"
#include "converters/stages/surface/simplify/simplify.h"
#include "converters/stages/surface/to_surface_mesh.h"
#include "formats/case/case_field.h"

namespace lumen::convert {
namespace {

// Edges of the lattice in radii: half of them would give no truer topology, at four times the cost.
constexpr double kLatticeShare = 1.0;
// The same where edges are split until they follow the field, which needs chords of 75 degrees or
// less around a vessel.
constexpr double kErrorLatticeShare = 1.2;
// Distance by which touching lumens are drawn apart, in wall thicknesses, so that each keeps a
// third of it as its wall.
constexpr double kSharedWall = 0.5;
// Prolongation of a lumen behind its ends while its wall is made, in radii: a cell of the lattice.
constexpr double kBeyondEnds = 1;
// Reduction of a wall's thickness that is allowed in the middle of a triangle, as a share of it.
constexpr double kWallSag = 0.03;
constexpr std::size_t kMostCrossings = 1'000'000;
// Edges of the preview's lattice in radii: twice the others, they take a quarter of the time, and a
// vessel still has six sides or more.
constexpr double kQuickShare = 2.0;

/// A gap is drawn from the lumens of both vessels, so one wider than the widest leaves nothing.
/// Surfaces around it take a time that grows with its cube.
void requireGap(const formats::Case& source, const ClosedSurfaceOptions& options) {
  const auto& radius = source.tree.radius;
  const double widest = 2 * double{*std::max_element(radius.begin(), radius.end())};
  if (options.gap && !(*options.gap >= 0 && *options.gap <= widest))
    throw Error(ErrorKind::Usage, "gap: found " + shownNumber(*options.gap) +
                                      " mm, expected at most " + shownNumber(widest) +
                                      " mm, the diameter of the widest vessel");
}

double chooseGap(const formats::Case& source, const ClosedSurfaceOptions& options) {
  if (options.gap) return *options.gap;
  if (source.metadata.voxelSize) return 0.1 * *source.metadata.voxelSize;
  const auto& radius = source.tree.radius;
  return 0.05 * double{*std::min_element(radius.begin(), radius.end())};
}

// Two walls need more of it than none.
SeparationOptions chooseGaps(const formats::Case& source, const ClosedSurfaceOptions& options) {
  const Length wall = options.thickness.value_or(Length{});
  return {.gap = std::max(chooseGap(source, options), kSharedWall * wall.mm),
          .gapShare = kSharedWall * wall.radii};
}

EdgeLength edgeOf(const ClosedSurfaceOptions& options) {
  EdgeLength edge = options.edge;
  const Length wall = options.thickness.value_or(Length{});
  edge.sag = {kWallSag * wall.mm, kWallSag * wall.radii};
  return edge;
}

class ClosedSurfaceMaker {
public:
  ClosedSurfaceMaker(const formats::Case& source, const ClosedSurfaceOptions& options,
                     Progress& progress)
      : m_source(source),
        m_options(options),
        m_error(errorOf(options)),
        m_progress(progress),
        m_blended(formats::caseField(source)),
        m_field(source, m_blended, chooseGaps(source, options)) {}

  ClosedSurface run() {
    SurfaceReport& report = m_result.report;
    report.gap = m_field.options().gap;
    std::vector<DetailLevel> levels = leveled(m_options.thickness ? wall() : lumen());
    for (DetailLevel& level : levels) {
      if (!m_options.extend.empty()) extend(level.surface);
      if (m_result.levels.empty()) noteShape(level.surface.mesh);
      if (m_options.open && !m_options.thickness) openEnds(level.surface);
      m_result.levels.push_back(toSurfaceMesh(level.surface, m_field,
                                              isByError() ? Normals::OfField : Normals::OfTriangles,
                                              m_progress));
      report.errors.push_back(level.error);
    }
    report.vertices = m_result.levels.front().position.size();
    report.triangles = m_result.levels.front().triangle.size();
    return std::move(m_result);
  }

private:
  // The lumen's surface with ends, before the requested changes.
  CaseSurface lumen() {
    const CaseSurface whole = extract(m_field, m_result.report);
    std::vector<EndPlane> planes = endPlanes(m_source);
    CaseSurface surface = whole;
    EndsReport ends = cut(surface, planes);
    RefineReport found = giveTriangles(surface);
    if (found.crossings > 0 && keepCrossingEndsRound(whole, planes)) {
      surface = whole;
      ends = cut(surface, planes);
      found = giveTriangles(surface);
    }
    noteEnds(std::move(ends));
    noteFaults(found);
    m_result.report.crossings = found.crossings;
    m_result.report.overlaps = findOverlaps(surface, m_field);
    note(stretchesWithoutWall(surface, m_source.tree));
    return surface;
  }

  // Gives the lumen's surface the triangles that are asked for.
  RefineReport giveTriangles(CaseSurface& surface) {
    if (!isByError()) return refine(surface, m_field, edgeOf(m_options), m_progress);
    const SimplifyReport made =
        hasError() ? simplifyToField(surface, m_field, allowed(), 0, m_progress)
                   : simplifyToField(surface, m_field, {.mm = INFINITY},
                                     static_cast<std::size_t>(*m_options.maxTriangles), m_progress);
    m_result.report.fieldError = made.error;
    return {0, 0, made.crossings};
  }

  // Whether the error or a number, and not the length of edges, chooses the triangles.
  [[nodiscard]] bool isByError() const {
    return (hasError() || m_options.maxTriangles) && !m_options.thickness && !m_options.withWhole;
  }
  [[nodiscard]] bool hasError() const { return m_error != SurfaceError{}; }
  static SurfaceError errorOf(const ClosedSurfaceOptions& options) {
    if (options.maxError) return *options.maxError;
    const bool isUsual = options.fewTriangles && !options.maxTriangles && !options.thickness;
    return isUsual ? kUsualSurfaceError : SurfaceError{};
  }

  void noteShape(const TriangleMesh& mesh) {
    SurfaceReport& report = m_result.report;
    report.leastAngle = triangleQuality(mesh).leastAngle;
    report.volume = signedVolume(mesh);
    for (const Triangle& t : mesh.triangle) report.area += vectorArea(mesh, t).norm();
  }

  EndsReport cut(CaseSurface& surface, const std::vector<EndPlane>& planes) {
    const std::array<FieldSurface, 1> one{{{&surface, &m_field}}};
    return cutEnds(one, planes, m_progress);
  }

  // Marks the ends whose flat faces pass through a wall, as behind a tight bend; true if there are
  // any. `surface` is not cut yet: it is cut again here, for a copy would be in memory all the time.
  bool keepCrossingEndsRound(CaseSurface surface, std::vector<EndPlane>& planes) {
    cut(surface, planes);
    std::vector<bool> crosses(surface.groups.size(), false);
    for (const auto& pair : selfIntersections(surface.mesh, kMostCrossings, &m_progress).pairs)
      for (const std::uint32_t t : pair) crosses[surface.group[t]] = true;
    bool isAny = false;
    for (const SurfaceEnd& end : surface.ends)
      for (EndPlane& plane : planes) {
        if (!crosses[end.group] || plane.branch != end.branch || plane.node != end.node) continue;
        isAny = isAny || !plane.staysRound;
        plane.staysRound = true;
      }
    return isAny;
  }

  // Outer walls that keep apart have a third of the gap between them, so a wall is left between
  // each and its lumen.
  CaseSurface wall() {
    CaseSurface inner = lumen();
    const Length& thickness = *m_options.thickness;
    // beyond its ends, so that the outer surface is cut where it runs on
    CaseSurface prolonged = inner;
    extendFreeEnds(prolonged, m_source, {thickness.mm, kBeyondEnds + thickness.radii});
    const OffsetField around(m_source, m_blended, m_field.options().gap / 3, prolonged, thickness,
                             m_options.touching);
    SurfaceReport ofOuter;
    CaseSurface outer = extract(around, ofOuter);
    EndsReport ends;
    ends.messages = cutLike(outer, around, inner, m_progress);
    ends.flat = m_result.report.flatEnds - ends.messages.size();
    ends.rounded = m_result.report.roundedEnds + ends.messages.size();
    noteEnds(std::move(ends));
    remeshed(outer, around);
    m_progress.check();
    if (m_options.touching == Touching::Apart) note(thinWalls(outer, around, m_progress));
    CaseSurface solid = thickWall(inner, outer);
    if (countCrossings(solid) > 0) {
      liftOuter(inner, outer, around, m_progress);
      solid = thickWall(inner, outer);
      countCrossings(solid);
    }
    m_result.report.wall = measureWall(solid, m_field, thickness, m_progress);
    note(m_result.report.wall->shared);
    return solid;
  }

  // Counts the crossings of the surface with places as a file has them, for the report.
  std::size_t countCrossings(CaseSurface& surface) {
    m_progress.begin("crossings", 0);
    roundToFloats(surface.mesh);
    std::size_t& count = m_result.report.crossings;
    count = selfIntersections(surface.mesh, kMostCrossings, &m_progress).pairs.size();
    m_progress.end();
    return count;
  }

  void note(const std::vector<std::string>& sentences) {
    std::vector<std::string>& messages = m_result.report.messages;
    messages.insert(messages.end(), sentences.begin(), sentences.end());
  }

  void extend(CaseSurface& surface) {
    const std::vector<std::string> reported = extendEnds(surface, m_source, m_options.extend);
    if (m_result.levels.empty())
      m_result.report.messages.insert(m_result.report.messages.end(), reported.begin(),
                                      reported.end());
  }

  CaseSurface extract(const SeparatedField& field, SurfaceReport& report) {
    ExtractionReport found;
    const LatticeEdge edge = !isByError() ? kLatticeShare
                             : hasError() ? LatticeEdge(kErrorLatticeShare, chords())
                                          : kErrorLatticeShare;
    CaseSurface surface = extractSurface(field, edge, found, m_progress);
    report.trees = found.trees;
    report.openedEdges = found.openedEdges;
    report.cuts = std::move(found.cuts);
    return surface;
  }

  void noteEnds(EndsReport found) {
    SurfaceReport& report = m_result.report;
    report.flatEnds = found.flat;
    report.roundedEnds = found.rounded;
    std::move(found.messages.begin(), found.messages.end(), std::back_inserter(report.messages));
    for (const std::string& sentence : found.moved) m_progress.detail(sentence);
  }

  // Returns the crossings that are left.
  std::size_t remeshed(CaseSurface& surface, const SeparatedField& field) {
    const RefineReport found = refine(surface, field, edgeOf(m_options), m_progress);
    noteFaults(found);
    return found.crossings;
  }

  void noteFaults(const RefineReport& found) {
    m_result.report.offField += found.offField;
    m_result.report.sharpTriangles += found.sharp;
  }

  // The surface with as few triangles as --max-error allows, and in the requested number of levels.
  std::vector<DetailLevel> leveled(CaseSurface surface) {
    std::optional<CaseSurface> whole;
    std::vector<DetailLevel> levels{{std::move(surface), -1}};
    if (m_result.report.fieldError) {
      levels[0].error = m_result.report.fieldError->greatest;
    } else if (hasError()) {
      whole = levels[0].surface;
      levels[0].error = simplify(levels[0].surface, {allowed().at(leastRadius()), 0}, m_progress);
    }
    const auto triangles = static_cast<std::size_t>(
        m_options.maxTriangles.value_or(std::numeric_limits<std::ptrdiff_t>::max()));
    if (levels[0].surface.mesh.triangle.size() > triangles) {
      if (!whole) whole = levels[0].surface;
      simplify(levels[0].surface, {0, triangles}, m_progress);
      levels[0].error = distanceBetween(levels[0].surface, *whole);
    }
    addCoarserLevels(levels, m_options.levels, m_progress);
    for (std::size_t i = 1; i < levels.size(); ++i)
      levels[i].error = distanceBetween(levels[i].surface, whole ? *whole : levels[0].surface);
    if (whole && m_options.withWhole) levels.insert(levels.begin(), {*std::move(whole), -1});
    return levels;
  }

  [[nodiscard]] SurfaceError chords() const {
    return {kChordShare * allowed().mm, kChordShare * allowed().radii};
  }
  [[nodiscard]] SurfaceError allowed() const {
    return inMillimetres(m_error, m_source.metadata.voxelSize.value_or(0));
  }
  [[nodiscard]] double leastRadius() const {
    const auto& radius = m_source.tree.radius;
    return double{*std::min_element(radius.begin(), radius.end())};
  }

  const formats::Case& m_source;
  const ClosedSurfaceOptions& m_options;
  SurfaceError m_error;
  Progress& m_progress;
  field::BlendedField m_blended;
  SeparatedField m_field;
  ClosedSurface m_result;
};

void requireModels(const formats::Case& source) {
  if (!source.models || source.tree.nodeCount() == 0)
    throw invalidInput(
        "the case has no models, and a mesh is made from them; lumen fit makes them");
}

}  // namespace

SurfaceMesh quickSurface(const formats::Case& source, Progress& progress) {
  requireModels(source);
  const field::BlendedField blended = formats::caseField(source);
  const SeparatedField field(source, blended, {chooseGap(source, {}), 0, 0});
  ExtractionReport ignored;
  return toSurfaceMesh(extractSurface(field, kQuickShare, ignored, progress), field,
                       Normals::OfTriangles, progress);
}

ClosedSurface closedSurface(const formats::Case& source, const ClosedSurfaceOptions& options,
                            Progress& progress) {
  requireModels(source);
  if (options.thickness && (options.open || !options.extend.empty()))
    throw Error(ErrorKind::Usage,
                "thickness gives a closed wall; it goes with neither open nor extend");
  if (options.maxError && !source.metadata.voxelSize && options.maxError->voxels > 0 &&
      !(options.maxError->mm > 0 || options.maxError->radii > 0))
    throw Error(ErrorKind::Usage,
                "max-error: found a number of voxels, and the case has no voxel size; expected mm, "
                "or a share of the radius such as 0.03r");
  requireGap(source, options);
  requireFewTriangles(source.tree, edgeOf(options), options.thickness);
  return ClosedSurfaceMaker(source, options, progress).run();
}

}  // namespace lumen::convert
