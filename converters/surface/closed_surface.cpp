// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/closed_surface.h"

#include <algorithm>
#include <map>
#include <utility>

#include "converters/common/error.h"
#include "converters/surface/cut_ends.h"
#include "converters/surface/extract.h"
#include "converters/surface/overlaps.h"
#include "converters/surface/remesh.h"
#include "converters/surface/surface_values.h"
#include "formats/case/case_field.h"

namespace lumen::convert {
namespace {

// Edges of the lattice in radii: half of them would give no truer topology, at four times the cost.
constexpr double kLatticeShare = 1.0;

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
        m_field(source, m_blended, {gapOf(source, options), 0, 0}) {
    m_result.report.gap = m_field.options().gap;
  }

  ClosedSurface run() {
    CaseSurface lumen = extract(m_field);
    noteEnds(cutEnds(lumen, m_field, m_progress));
    refine(lumen, m_field);
    m_result.report.overlaps = overlapsOf(lumen, m_field);
    if (m_options.open) openEnds(lumen);
    m_result.levels.push_back(surfaceMeshOf(lumen, m_source));
    return std::move(m_result);
  }

private:
  CaseSurface extract(const SheetField& field) {
    ExtractionReport found;
    CaseSurface surface = extractSurface(field, kLatticeShare, found, m_progress);
    m_result.report.trees = found.trees;
    m_result.report.openedEdges = found.openedEdges;
    m_result.report.cuts = std::move(found.cuts);
    return surface;
  }

  void noteEnds(EndsReport found) {
    SurfaceReport& report = m_result.report;
    report.flatEnds = found.flat;
    report.roundedEnds = found.rounded;
    std::move(found.messages.begin(), found.messages.end(), std::back_inserter(report.messages));
  }

  void refine(CaseSurface& surface, const SheetField& field) {
    const RemeshReport found = remesh(surface, field, m_options.edge, m_progress);
    m_result.report.offField += found.offField;
    m_result.report.sharpTriangles += found.sharp;
  }

  const formats::Case& m_source;
  const ClosedSurfaceOptions& m_options;
  Progress& m_progress;
  field::BlendedField m_blended;
  SheetField m_field;
  ClosedSurface m_result;
};

}  // namespace

ClosedSurface closedSurface(const formats::Case& source, const ClosedSurfaceOptions& options,
                            Progress& progress) {
  if (!source.models || source.tree.nodeCount() == 0)
    throw invalidInput("the case has no models, and a mesh is made from them; lumen fit makes them");
  return Making(source, options, progress).run();
}

}  // namespace lumen::convert
