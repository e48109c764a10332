// SPDX-License-Identifier: Apache-2.0
// The vessels in a report: table, radius along each, confidence.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/draw/report/profile_plot.h"
#include "converters/draw/report/report_page.h"
#include "converters/draw/report/tree_profiles.h"
#include "converters/judge/measure/shown_radius.h"

namespace lumen::convert {

namespace {

/// The place of each branch in tree order, from 1.
std::vector<std::size_t> branchNumbers(const formats::CenterlineTree& tree) {
  std::vector<std::size_t> numbers(tree.branches.size());
  std::size_t next = 1;
  for (const std::uint32_t branch : convert::inTreeOrder(tree)) numbers[branch] = next++;
  return numbers;
}

/// The number of the branch that a branch leaves; "-" for a root.
std::string parentText(const formats::CenterlineTree& tree, const formats::Branch& branch,
                       const std::vector<std::size_t>& numbers) {
  if (branch.parentNode == formats::kNoParent) return "-";
  return std::to_string(numbers[tree.branch[static_cast<std::size_t>(branch.parentNode)]]);
}

Markup plotCaption(std::size_t number, const BranchInfo& branch) {
  Markup caption = element("b", text(std::to_string(number)));
  caption.html += ' ';
  caption += name(branch.label);
  return element("figcaption", caption);
}

/// Agreement at the nodes of a profile; empty without a volume.
std::span<const convert::Agreement> agreementOf(const ReportFacts& facts,
                                                const convert::TreeProfile& profile) {
  if (!facts.volume || !facts.volume->check) return {};
  return std::span(facts.volume->check->nodes).subspan(profile.firstNode, profile.along.size());
}

/// The inlier rate that tracking required, from the newest step that has one.
std::optional<double> acceptedRate(const formats::Metadata& metadata) {
  for (auto step = metadata.steps.rbegin(); step != metadata.steps.rend(); ++step)
    if (const auto found = step->parameters.find("inlier-rate"); found != step->parameters.end())
      if (const auto* value = std::get_if<double>(&found->second)) return *value;
  return std::nullopt;
}

}  // namespace

Markup branchSection(const ReportFacts& facts) {
  const formats::CenterlineTree& tree = facts.value.tree;
  if (tree.branches.empty())
    return section("branches", "Vessels", paragraph("This case has no vessels."));
  const std::vector<std::size_t> numbers = branchNumbers(tree);
  const bool hasSystems = !facts.info.branches.front().system.empty();
  std::vector<convert::Column> columns = {{"no."},        {"vessel", false}, {"kind", false},
                                          {"from"},       {"nodes"},         {"length mm"},
                                          {"radius mm"},  {"least"},         {"greatest"},
                                          {"confidence"}, {"end", false}};
  if (hasSystems) columns.insert(columns.begin() + 3, {"system", false});
  convert::Table table("branch-table", columns);
  const std::optional<double> least = facts.info.leastShown;
  const auto radius = [&](float mm) {
    return text(shownRadius(static_cast<double>(mm), least, 2));
  };
  for (const std::uint32_t b : convert::inTreeOrder(tree)) {
    const BranchInfo& info = facts.info.branches[b];
    std::vector<Markup> cells = {text(std::to_string(numbers[b])),
                                 name(info.label),
                                 text(info.kind),
                                 text(parentText(tree, tree.branches[b], numbers)),
                                 text(std::to_string(info.nodes)),
                                 text(fixedText(info.length, 1)),
                                 radius(info.radius.mean),
                                 radius(info.radius.min),
                                 radius(info.radius.max),
                                 text(fixedText(info.inlierRate, 2)),
                                 text(info.end)};
    if (hasSystems) cells.insert(cells.begin() + 3, text(info.system));
    table.row(cells);
  }
  Markup content = paragraph(
      "Each vessel stands before those that leave it. From: the number of the vessel that it "
      "leaves. Length: from the wall "
      "of that vessel on. Radius: mean, least and greatest, <= where it is below the least that "
      "the "
      "volume shows. Confidence: the mean inlier rate. End: "
      "what is seen at its last "
      "node, place in mm, LPS.");
  content += table.markup();
  return section("branches", "Vessels", content);
}

Markup profileSection(const ReportFacts& facts) {
  const std::vector<convert::TreeProfile> profiles = convert::treeProfiles(facts.value.tree);
  if (profiles.empty())
    return section("profiles", "Radius along each vessel", paragraph("This case has no vessels."));
  Markup content = paragraph(
      std::string("Red: the radius. ") +
      (facts.value.tree.inlierRate.empty() ? "This case records no confidence. "
                                           : "Area behind it: confidence, from 0 to 1. ") +
      "Marks on the lower axis: where vessels leave. The scales differ from plot to plot.");
  if (facts.volume && facts.volume->check) content += agreementLegend(false);
  Markup plots;
  std::size_t number = 1;
  for (const convert::TreeProfile& profile : profiles) {
    Markup figure = plotCaption(number++, facts.info.branches[profile.branch]);
    figure += convert::profilePlot(profile, agreementOf(facts, profile));
    plots += element("figure", figure, "class=\"profile\"");
    plots.html += '\n';
  }
  content += element("div", plots, "class=\"profiles\"");
  return section("profiles", "Radius along each vessel", content);
}

Markup confidenceSection(const ReportFacts& facts) {
  const formats::CenterlineTree& tree = facts.value.tree;
  if (tree.inlierRate.empty() || tree.nodeCount() == 0)
    return section("confidence", "Confidence",
                   paragraph("This case records no inlier rates, as it was not tracked in "
                             "a volume, so its confidence is unknown."));
  const convert::ConfidenceShares shares = convert::confidenceShares(tree);
  std::string words =
      "The inlier rate of a node is the share of the places on the wall found around it that lie "
      "within a tenth of the "
      "radius of its cylinder. By length its mean is " +
      fixedText(shares.mean, 2) + ".";
  if (const auto rate = acceptedRate(facts.value.metadata))
    words += " Tracking took a cylinder at once at a rate of " + fixedText(*rate, 2) +
             ", and none below half of that.";
  Markup content = paragraph(words);
  Markup pair = element("figure", convert::confidenceBars(shares));
  if (facts.confidence)
    pair += pngFigure(facts.confidence->png,
                      {"<span class=\"viridis\"></span> from 0 (dark blue) to 1 (yellow)"},
                      "The case, coloured by confidence");
  else
    pair += paragraph("There is no picture, as this case has no models.");
  content += element("div", pair, "class=\"pair\"");
  return section("confidence", "Confidence", content);
}

}  // namespace lumen::convert
