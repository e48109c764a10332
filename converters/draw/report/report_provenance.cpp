// SPDX-License-Identifier: Apache-2.0
// Provenance of a case in a report: steps with their parameters, source, digests.
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/options/option_name.h"
#include "converters/base/text.h"
#include "converters/draw/report/report_page.h"
#include "formats/case/enum_names.h"

namespace lumen::convert {

namespace {

constexpr std::size_t kMostOfAText = 400;   // bytes of a parameter on paper
constexpr std::size_t kMostOfANote = 4000;  // bytes
constexpr const char* kTool = "lumen " LUMEN_VERSION;

/// A number, or the beginning of a text of a case.
Markup valueText(const formats::ParameterValue& value) {
  if (const auto* words = std::get_if<std::string>(&value)) return shortened(*words, kMostOfAText);
  return text(parameterText(value));
}

Markup digest(const std::string& sha256) {
  return element("code", text(sha256));
}

void addGeometry(const std::string& whose, const formats::SourceVolume& volume, Facts& facts) {
  facts.emplace_back(whose + ", voxels", text(joinedNumbers(volume.size, " × ")));
  facts.emplace_back(whose + ", spacing", text(joinedNumbers(volume.spacing, " × ") + " mm"));
  facts.emplace_back(whose + ", origin",
                     text(std::string("(") + joinedNumbers(volume.origin, ", ") + ") mm, LPS"));
  facts.emplace_back(whose + ", direction",
                     text(joinedNumbers(volume.direction, " ") + " (row by row)"));
  facts.emplace_back(whose + ", SHA-256 of its voxels", digest(volume.sha256));
}

std::string relationText(const SourceRelation& source) {
  if (!source.isKnown) return "not known: the case names no source";
  if (!source.difference) return "yes: geometry and voxels are the same";
  return "no: " + source.difference->what + " differs";
}

void addVolume(const ReportFacts& facts, Facts& list) {
  if (!facts.volume) {
    list.emplace_back("Volume of this report",
                      text("none was given (" + kOption.volume.shown() + ")"));
    return;
  }
  list.emplace_back("Volume of this report", name(facts.volume->name));
  list.emplace_back("It is the source", text(relationText(facts.volume->source)));
  if (!facts.volume->source.isKnown || facts.volume->source.difference)
    addGeometry("This volume", facts.volume->geometry, list);
}

Markup models(const formats::Case& value) {
  if (!value.models) return text("none");
  return text(std::string(formats::enumName(formats::kKernelNames, value.models->kernel)) +
              ", parameter " + shownNumber(value.models->kernelParameter) + ", iso-level " +
              shownNumber(value.models->isoLevel) + " mm, " +
              std::to_string(value.models->centre.size()) + " blobs");
}

}  // namespace

Markup parameterSection(const ReportFacts& facts) {
  constexpr const char* kTitle = "Parameters";
  const std::vector<formats::Step>& steps = facts.value.metadata.steps;
  if (steps.empty())
    return section("parameters", kTitle,
                   paragraph("This case records no step, so how it was made is not known."));
  Markup content = paragraph("Every recorded step, the oldest first; lengths in mm.");
  std::size_t number = 1;
  for (const formats::Step& step : steps) {
    Markup heading = text(std::to_string(number++) + ". ");
    heading += name(step.name);
    heading.html += " (";
    heading += name(step.tool);
    heading.html += ")";
    content += element("h3", heading);
    Markup list;
    for (const auto& [key, value] : step.parameters) {
      Markup pair = name(key);
      pair.html += " ";
      pair += element("b", valueText(value));
      list += element("li", pair);
      list.html += "\n";
    }
    content += step.parameters.empty() ? paragraph("No parameters.")
                                       : element("ul", list, "class=\"parameters\"");
  }
  return section("parameters", kTitle, content);
}

Markup provenanceSection(const ReportFacts& facts) {
  const formats::Metadata& metadata = facts.value.metadata;
  Facts list;
  list.emplace_back("Case", name(facts.caseName));
  list.emplace_back("Size", text(std::to_string(facts.bytes) + " bytes"));
  list.emplace_back("SHA-256 of the case", digest(facts.sha256));
  list.emplace_back(
      "SHA-256 of the case that it was made from",
      metadata.parentSha256.empty() ? text("none is recorded") : digest(metadata.parentSha256));
  if (metadata.source)
    addGeometry("Source volume", *metadata.source, list);
  else
    list.emplace_back("Source volume", text("none is recorded"));
  addVolume(facts, list);
  if (const auto time = recordedTime(metadata))
    list.emplace_back("Time", text(numberText(*time) + " s of the motion of the case"));
  list.emplace_back("Models", models(facts.value));
  if (const auto& rounded = metadata.pointQuantisation)
    list.emplace_back("Wall points",
                      text("rounded to " + std::to_string(rounded->bits) + " bits, steps of " +
                           fixedText(rounded->step, 6) + " mm"));
  for (const std::string& array : facts.info.nodeArrays)
    list.emplace_back("Node array", name(array));
  for (const std::string& extension : metadata.extensionsUsed)
    list.emplace_back("Extension", name(extension));
  list.emplace_back("This report", text(kTool));
  if (!metadata.note.empty()) list.emplace_back("Note", shortened(metadata.note, kMostOfANote));
  return section("provenance", "Provenance", factList(list));
}

}  // namespace lumen::convert
