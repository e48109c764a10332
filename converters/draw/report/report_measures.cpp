// SPDX-License-Identifier: Apache-2.0
// Measures in a report: vessels, paths, forks, narrowings, aneurysms.
#include <cmath>
#include <string>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/draw/report/report_page.h"

namespace lumen::convert {

namespace {

/// "12.3 ± 0.4", or "-" with the reason as a title.
Markup measureCell(const Measured& m, int decimals) {
  if (!m.absent.empty()) return element("span", text("-"), "title=\"" + htmlText(m.absent) + "\"");
  if (std::isfinite(m.atMost))
    return element("span", text("\u2264 " + fixedText(m.atMost, decimals)),
                   "title=\"the volume shows no less\"");
  std::string shown = fixedText(m.value, decimals);
  if (std::isfinite(m.plusMinus)) shown += " \u00b1 " + fixedText(m.plusMinus, decimals);
  return text(shown);
}

Markup vesselMeasures(const ReportFacts& facts) {
  Table table("vessel-measures", {{"vessel", false},
                                  {"length mm"},
                                  {"tortuosity"},
                                  {"mean curvature 1/mm"},
                                  {"turns over 90\u00b0"},
                                  {"mean radius mm"},
                                  {"smallest"},
                                  {"volume mm\u00b3"}});
  for (const VesselMeasures& m : facts.measures.vessels)
    table.row({name(facts.value.tree.branches[m.branch].label), measureCell(m.length, 1),
               measureCell(m.tortuosity, 3), measureCell(m.meanCurvature, 3),
               measureCell(m.turns, 0), measureCell(m.meanRadius, 2),
               measureCell(m.smallestRadius, 2), measureCell(m.volume, 1)});
  return table.markup();
}

Markup pathMeasures(const ReportFacts& facts) {
  Table table("path-measures", {{"from", false},
                                {"to the end of", false},
                                {"length mm"},
                                {"turning \u00b0/cm"},
                                {"forks"},
                                {"greatest take-off \u00b0"},
                                {"least calibre step"},
                                {"catheter Fr"}});
  const auto& branches = facts.value.tree.branches;
  for (const PathMeasures& m : facts.measures.paths)
    table.row({name(branches[m.inlet].label), name(branches[m.end].label), measureCell(m.length, 1),
               measureCell(m.turning, 0), measureCell(m.forks, 0), measureCell(m.takeOff, 0),
               measureCell(m.calibreStep, 2), measureCell(m.catheter, 1)});
  return table.markup();
}

Markup forkMeasures(const ReportFacts& facts) {
  if (facts.measures.forks.empty()) return paragraph("This case has no forks.");
  Table table("fork-measures", {{"vessel", false},
                                {"into the larger", false},
                                {"and the smaller", false},
                                {"angle \u00b0"},
                                {"take-off of the larger \u00b0"},
                                {"of the smaller \u00b0"},
                                {"area ratio"},
                                {"Murray's exponent"}});
  const auto& branches = facts.value.tree.branches;
  for (const ForkMeasures& m : facts.measures.forks)
    table.row({name(branches[m.parent].label), name(branches[m.larger].label),
               name(branches[m.smaller].label), measureCell(m.angle, 0),
               measureCell(m.takeOffLarger, 0), measureCell(m.takeOffSmaller, 0),
               measureCell(m.areaRatio, 2), measureCell(m.murrayExponent, 2)});
  return table.markup();
}

Markup narrowingMeasures(const ReportFacts& facts) {
  if (facts.measures.narrowings.empty())
    return paragraph(
        "No stretch of a vessel differs from its fitted healthy calibre by a fifth or more.");
  Table table("narrowing-measures", {{"vessel", false},
                                     {"finding", false},
                                     {"at mm"},
                                     {"length mm"},
                                     {"diameter mm"},
                                     {"healthy mm"},
                                     {"NASCET %"},
                                     {"area %"}});
  for (const NarrowingMeasures& m : facts.measures.narrowings)
    table.row({name(facts.value.tree.branches[m.branch].label),
               text(m.isDilation ? "dilation" : "narrowing"), measureCell(m.along, 1),
               measureCell(m.length, 1), measureCell(m.diameter, 2),
               measureCell(m.healthyDiameter, 2), measureCell(m.diameterDegree, 0),
               measureCell(m.areaDegree, 0)});
  return table.markup();
}

Markup sacMeasures(const ReportFacts& facts) {
  Table table("sac-measures", {{"aneurysm", false},
                               {"kind", false},
                               {"neck mm"},
                               {"height mm"},
                               {"width mm"},
                               {"volume mm\u00b3"},
                               {"aspect ratio"},
                               {"size ratio"},
                               {"non-sphericity"}});
  for (const SacMeasures& m : facts.measures.sacs)
    table.row({name(facts.value.tree.branches[m.branch].label),
               text(m.position.empty() ? "-" : std::string(m.position)),
               measureCell(m.neckDiameter, 2), measureCell(m.height, 2), measureCell(m.width, 2),
               measureCell(m.volume, 1), measureCell(m.aspectRatio, 2), measureCell(m.sizeRatio, 2),
               measureCell(m.nonSphericity, 3)});
  return table.markup();
}

}  // namespace

Markup measureSection(const ReportFacts& facts) {
  if (facts.measures.vessels.empty())
    return section("measures", "Measures", paragraph("This case has no vessels."));
  Markup content = paragraph(
      "\u00b1: half of the 95 % interval, where wall points make one known. A dash: not defined "
      "there; lumen measure states the reason, and has all measures as tables. Definitions: "
      "docs/measures.md of lumen.");
  content += vesselMeasures(facts);
  content += paragraph(
      "Paths from an inlet to each end. Take-off: angle between the vessel into a fork and the "
      "one that the path takes. Catheter: the largest that passes, in French.");
  content += pathMeasures(facts);
  content += paragraph("Forks, with two of the vessels that leave each.");
  content += forkMeasures(facts);
  content += paragraph("Narrowings and dilations.");
  content += narrowingMeasures(facts);
  if (!facts.measures.sacs.empty()) {
    content += paragraph(
        "Aneurysms. Neck: mean diameter of the section that separates the sac from its vessel. "
        "Aspect ratio: height / neck; size ratio: reach / mean diameter of the vessels at the "
        "neck.");
    content += sacMeasures(facts);
  }
  return section("measures", "Measures", content);
}

}  // namespace lumen::convert
