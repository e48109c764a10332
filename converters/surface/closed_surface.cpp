// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/closed_surface.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "converters/common/error.h"
#include "converters/mesh/self_intersections.h"
#include "converters/surface/cut_ends.h"
#include "converters/surface/decimate.h"
#include "converters/surface/end_planes.h"
#include "converters/surface/extract.h"
#include "converters/surface/flow_extension.h"
#include "converters/surface/mend_crossings.h"
#include "converters/surface/overlaps.h"
#include "converters/surface/remesh.h"
#include "converters/surface/thick_wall.h"
#include "converters/surface/to_surface_mesh.h"
#include "formats/case/case_field.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

// Edges of the lattice in radii: half of them would give no truer topology, at four times the cost.
constexpr double kLatticeShare = 1.0;
// Twice that takes a quarter of the time, and a vessel is still six-sided or more.
constexpr double kQuickShare = 2.0;

double gapOf(const formats::Case& source, const ClosedSurfaceOptions& options) {
  if (options.gap) return *options.gap;
  if (source.metadata.voxelSize) return 0.1 * *source.metadata.voxelSize;
  const auto& radius = source.tree.radius;
  return 0.05 * double{*std::min_element(radius.begin(), radius.end())};
}

class Making {
public:
  Making(const formats::Case& source, const ClosedSurfaceOptions& options, Progress& progress)
      : m_source(source),
        m_options(options),
        m_progress(progress),
        m_blended(formats::blendedFieldOf(source)),
        m_field(source, m_blended, {gapOf(source, options), 0, 0}) {}

  ClosedSurface run() {
    SurfaceReport& report = m_result.report;
    report.gap = m_field.options().gap;
    std::vector<DetailLevel> levels;
    if (m_options.thickness)
      levels.push_back({wall(), -1});
    else
      levels = lumen();
    for (DetailLevel& level : levels) {
      const std::vector<std::string> said = extendEnds(level.surface, m_source, m_options.extend);
      if (m_result.levels.empty())
        report.messages.insert(report.messages.end(), said.begin(), said.end());
      if (m_options.open && !m_options.thickness) openEnds(level.surface);
      m_result.levels.push_back(toSurfaceMesh(level.surface, m_field, m_progress));
      report.errors.push_back(level.error);
    }
    report.vertices = m_result.levels.front().position.size();
    report.triangles = m_result.levels.front().triangle.size();
    return std::move(m_result);
  }

private:
  // The lumen's surface, in as many levels as are asked for.
  std::vector<DetailLevel> lumen() {
    CaseSurface surface = extract(m_field, m_result.report);
    noteEnds(cutEnds(surface, m_field, m_progress));
    refine(surface, m_field);
    m_result.report.crossings = mendCrossings(surface, m_field, m_progress);
    m_result.report.overlaps = overlapsOf(surface, m_field);
    return leveled(std::move(surface));
  }

  // The outer walls of vessels that touch keep a third of the gap, so a wall is left between each
  // and its lumen.
  CaseSurface wall() {
    const SheetField around(
        m_source, m_blended,
        {m_field.options().gap / 3, m_options.thickness->mm, m_options.thickness->radii});
    CaseSurface inner = extract(m_field, m_result.report);
    SurfaceReport ofOuter;
    CaseSurface outer = extract(around, ofOuter);
    const std::array<FieldSurface, 2> both{{{&inner, &m_field}, {&outer, &around}}};
    noteEnds(cutEnds(both, endPlanes(m_source), m_progress));
    refine(inner, m_field);
    refine(outer, around);
    mendCrossings(inner, m_field, m_progress);
    mendCrossings(outer, around, m_progress);
    m_result.report.overlaps = overlapsOf(inner, m_field);
    return thickWall(inner, outer, m_source);
  }

  CaseSurface extract(const SheetField& field, SurfaceReport& report) {
    ExtractionReport found;
    CaseSurface surface = extractSurface(field, kLatticeShare, found, m_progress);
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

  void refine(CaseSurface& surface, const SheetField& field) {
    const RemeshReport found = remesh(surface, field, m_options.edge, m_progress);
    m_result.report.offField += found.offField;
    m_result.report.sharpTriangles += found.sharp;
  }

  // The surface with as few triangles as --max-error allows, and in as many levels as are asked for.
  std::vector<DetailLevel> leveled(CaseSurface surface) {
    std::optional<CaseSurface> whole;
    std::vector<DetailLevel> levels{{std::move(surface), -1}};
    if (m_options.maxError > 0) {
      whole = levels[0].surface;
      levels[0].error = decimate(levels[0].surface, m_field, {m_options.maxError, 0}, m_progress);
      if (levels[0].error > m_options.maxError)
        throw failed("with fewer triangles the surface would lie " +
                     formats::shortText(static_cast<float>(levels[0].error)) +
                     " mm off, which is more than --max-error");
    }
    addCoarserLevels(levels, m_options.levels, m_field, m_progress);
    for (std::size_t i = 1; i < levels.size(); ++i)
      levels[i].error = distanceBetween(levels[i].surface, whole ? *whole : levels[0].surface);
    return levels;
  }

  const formats::Case& m_source;
  const ClosedSurfaceOptions& m_options;
  Progress& m_progress;
  field::BlendedField m_blended;
  SheetField m_field;
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
  const field::BlendedField blended = formats::blendedFieldOf(source);
  const SheetField field(source, blended, {gapOf(source, {}), 0, 0});
  ExtractionReport ignored;
  return toSurfaceMesh(extractSurface(field, kQuickShare, ignored, progress), field, progress);
}

ClosedSurface closedSurface(const formats::Case& source, const ClosedSurfaceOptions& options,
                            Progress& progress) {
  requireModels(source);
  return Making(source, options, progress).run();
}

}  // namespace lumen::convert
