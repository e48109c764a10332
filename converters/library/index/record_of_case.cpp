// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/record_of_case.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>
#include <variant>

#include "converters/base/error.h"
#include "converters/base/radius_range.h"
#include "converters/export/shared/insertion.h"
#include "converters/judge/measure/measure_case.h"
#include "converters/judge/measure/vessel_length.h"
#include "converters/stages/fitting/error_of_fit.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"
#include "formats/case/vessel_system.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {

namespace {

using formats::CenterlineTree;
using Json = nlohmann::ordered_json;

/// The double whose shortest text is that of the nearest float.
double asFloat(double value) {
  const std::string text = formats::shortText(static_cast<float>(value));
  double result = 0;
  std::from_chars(text.data(), text.data() + text.size(), result);
  return result == 0 ? 0 : result;  // zero has no sign
}

Eigen::Vector3d asFloats(const Eigen::Vector3d& v) {
  return {asFloat(v.x()), asFloat(v.y()), asFloat(v.z())};
}

void setBounds(const CenterlineTree& tree, CaseRecord& record) {
  Eigen::Vector3d low, high;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const Eigen::Vector3d centre(tree.centre[n].x, tree.centre[n].y, tree.centre[n].z);
    const Eigen::Vector3d radius = Eigen::Vector3d::Constant(tree.radius[n]);
    low = n == 0 ? centre - radius : low.cwiseMin(centre - radius).eval();
    high = n == 0 ? centre + radius : high.cwiseMax(centre + radius).eval();
  }
  record.boundsMin = asFloats(low);
  record.boundsMax = asFloats(high);
}

/// Puts a measure in place of a smaller one, or of none; true if it did.
bool takeGreater(const Measured& found, std::optional<double>& greatest) {
  if (!found.absent.empty()) return false;
  const double value = asFloat(std::max(found.value, 0.0));
  if (greatest && value <= *greatest) return false;
  greatest = value;
  return true;
}

GeometryFigures measureGeometry(const formats::Case& source, Progress& progress) {
  const CaseMeasures measures = measureCase(source, {}, progress);
  GeometryFigures figures;
  for (const PathMeasures& path : measures.paths) {
    takeGreater(path.tortuosity, figures.tortuosity);
    takeGreater(path.turning, figures.turning);
    takeGreater(path.takeOff, figures.takeOff);
  }
  for (const NarrowingMeasures& narrowing : measures.narrowings)
    if (!narrowing.isDilation) takeGreater(narrowing.diameterDegree, figures.stenosis);
  for (const SacMeasures& sac : measures.sacs) {
    if (!takeGreater(sac.reach, figures.aneurysmReach)) continue;
    figures.aneurysmNeck.reset();
    takeGreater(sac.neckDiameter, figures.aneurysmNeck);
  }
  return figures;
}

CaseFigures measureFigures(const formats::Case& source, Progress& progress) {
  const CenterlineTree& tree = source.tree;
  CaseFigures figures;
  figures.branches = tree.branches.size();
  figures.aneurysms = static_cast<std::size_t>(std::count_if(
      tree.branches.begin(), tree.branches.end(),
      [](const formats::Branch& branch) { return branch.kind == formats::BranchKind::Aneurysm; }));
  figures.nodes = tree.nodeCount();
  const VesselLengths lengths = vesselLengths(tree);
  figures.length = asFloat(lengths.total);
  const RadiusRange radius = radiusRange(tree.radius);
  figures.radiusMin = asFloat(radius.min);
  figures.radiusMean = asFloat(radius.mean);
  figures.radiusMax = asFloat(radius.max);
  const auto error = fittedError(source, progress);
  if (error && std::isfinite(error->p90)) {  // infinite with a node that has no model
    figures.errorMedian = asFloat(error->median);
    figures.errorP90 = asFloat(error->p90);
  }
  if (source.models) {
    const formats::Reachability reach = formats::measureReachability(
        tree, formats::caseField(source), [&progress] { progress.check(); });
    double reachable = 0;
    for (std::size_t n = 0; n < lengths.edge.size(); ++n)
      if (reach.barrierOf[n] < 0) reachable += lengths.edge[n];
    figures.reachable = asFloat(reachable);
  }
  figures.geometry = measureGeometry(source, progress);
  const std::vector<formats::VesselSystem> systems = formats::knownBranchSystems(source);
  for (const formats::VesselSystem one : std::set(systems.begin(), systems.end()))
    figures.systems.emplace_back(formats::kVesselSystemNames[static_cast<std::size_t>(one)]);
  return figures;
}

/// Insertions at the beginning of each vessel that is a root, as exports enter it.
std::vector<CasePlace> findInsertions(const CenterlineTree& tree) {
  std::vector<CasePlace> places;
  for (const formats::Branch& branch : tree.branches) {
    if (branch.kind != formats::BranchKind::Vessel || branch.parentNode >= 0) continue;
    try {
      const Insertion entry = findInsertion(tree, branch.label, 0);
      places.push_back({branch.label, "", asFloats(entry.position), asFloats(entry.direction),
                        asFloat(entry.radius)});
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::InvalidInput) throw;  // a vessel that is shorter than wide
    }
  }
  return places;
}

std::vector<CasePlace> namedEnds(const CenterlineTree& tree) {
  std::vector<CasePlace> places;
  for (const NamedEnd& end : findEnds(tree))
    places.push_back({end.name, end.kind == FaceKind::Inlet ? "inlet" : "outlet",
                      asFloats(end.position), asFloats(end.direction), asFloat(end.radius)});
  return places;
}

Json stepJson(const formats::Step& step) {
  Json parameters = Json::object();
  for (const auto& [name, value] : step.parameters)
    std::visit([&, &key = name](const auto& v) { parameters[key] = v; }, value);
  return {{"name", step.name}, {"tool", step.tool}, {"parameters", std::move(parameters)}};
}

Json makeProvenance(const formats::Metadata& metadata, const std::string& caseSha256) {
  Json steps = Json::array();
  for (const formats::Step& step : metadata.steps) steps.push_back(stepJson(step));
  return {{"case_sha256", caseSha256},
          {"generator", "lumen " LUMEN_VERSION},
          {"source", metadata.source ? Json{{"sha256", metadata.source->sha256}} : Json()},
          {"steps", std::move(steps)}};
}

}  // namespace

void describe(const formats::Case& source, const std::string& caseSha256, CaseRecord& record,
              Progress& progress) {
  if (source.tree.nodeCount() == 0)
    throw invalidInput("this case has no nodes, so there is nothing to state of it");
  setBounds(source.tree, record);
  record.figures = measureFigures(source, progress);
  record.insertions = findInsertions(source.tree);
  record.ends = namedEnds(source.tree);
  record.provenance = makeProvenance(source.metadata, caseSha256);
}

}  // namespace lumen::convert
