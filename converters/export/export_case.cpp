// SPDX-License-Identifier: Apache-2.0
#include "converters/export/export_case.h"

#include <algorithm>
#include <string>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/options/edit_steps.h"
#include "converters/export/shared/text_files.h"

namespace lumen::convert {

namespace {

using formats::Branch;
using formats::BranchKind;

bool hasLength(const Branch& branch) {
  return branch.kind == BranchKind::Vessel &&
         branch.nodeCount + (branch.parentNode >= 0 ? 1U : 0U) > 1;
}

void requireParts(const TargetRow& target, const formats::Case& source) {
  if (target.needsModels && !source.models)
    throw invalidInput(
        "this case has no models, so there is no wall to export; lumen fit makes them");
  const auto& branches = source.tree.branches;
  if (target.needsVessel && std::none_of(branches.begin(), branches.end(), hasLength))
    throw invalidInput(
        "this case has no vessel with a length, that is, of two nodes or more, so there is "
        "nothing to export to " +
        std::string(target.name));
}

template <class Value>
Value choice(const std::optional<Value>& asked, const std::vector<Value>& offered,
             const std::string& option, std::string_view (*name)(Value), std::string_view target) {
  if (!asked) return offered.front();
  if (std::find(offered.begin(), offered.end(), *asked) != offered.end()) return *asked;
  std::string words;
  for (const Value one : offered) words += (words.empty() ? "" : " or ") + std::string(name(one));
  throw Error(ErrorKind::Usage, option + ": found " + std::string(name(*asked)) + ", expected " +
                                    words + ", which is what " + std::string(target) + " reads");
}

/// Adds the time of a case that was taken from its motion, or that a motion is not in the folder.
void addMotion(const formats::Case& source, ExportResult& result) {
  if (const auto time = recordedTime(source.metadata)) {
    const std::string at =
        "the vessels are as they stand at " + numberText(*time) + " s of the motion of the case";
    result.remarks.push_back(at);
    result.start += "\nTime: " + at + ".\n";
  }
  if (source.motion && !result.playsMotion)
    result.losses.emplace_back("the vessels are at rest: the folder plays no motion of the case");
}

}  // namespace

ExportResult exportCase(const ExportTarget& target, const formats::Case& source,
                        const ExportOptions& options, const OptionTexts& texts,
                        Progress& progress) {
  requireParts(target, source);
  ExportFrame frame;
  frame.unit = choice(options.unit, target.units, options.word("unit"), unitName, target.name);
  frame.axes = choice(options.axes, target.axes, options.word("up"), upName, target.name);
  ExportResult result = target.write({source, options, frame, progress}, options);
  result.assumptions = recordedAssumptions(source.metadata);
  for (const std::string& assumption : result.assumptions)
    result.remarks.push_back("the file of the case's volume left open: " + assumption);
  addMotion(source, result);
  const std::size_t losses = result.losses.size();
  // the folder states both; a command warns of each by its code
  for (const Warning& warning : result.warnings)
    result.losses.push_back(warning.remedy.empty() ? warning.text
                                                   : warning.text + "; " + warning.remedy);
  result.files.push_back({"README.md", readmeText(target, frame, source, result), "", ""});
  result.files.push_back(
      {"lumen-export.json", makeManifest(target, frame, source, texts, result), "", ""});
  result.losses.resize(losses);
  return result;
}

}  // namespace lumen::convert
