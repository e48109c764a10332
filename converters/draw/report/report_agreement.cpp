// SPDX-License-Identifier: Apache-2.0
// Agreement of the case with its volume in a report: the findings of `lumen check`.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/base/vectors.h"
#include "converters/draw/report/report_page.h"
#include "converters/draw/report/tree_profiles.h"
#include "converters/judge/measure/vessel_length.h"

namespace lumen::convert {

namespace {

using convert::CheckReport, convert::Offsets;

constexpr std::size_t kPlacesListed = 25;  // places of each kind

/// A place in the case: the branch's label and coordinates.
std::vector<Markup> placeCells(const formats::CenterlineTree& tree, std::uint32_t node,
                               const Eigen::Vector3d& place) {
  return {name(labelOf(tree, node)), text(placeText(place))};
}

/// A sentence for the rest of a list that is too long for paper.
Markup restSentence(std::size_t count) {
  if (count <= kPlacesListed) return {};
  return paragraph("And " + std::to_string(count - kPlacesListed) + " smaller ones; lumen check " +
                   kOption.json.shown() + " lists all.");
}

Markup heading(const char* ours) {
  return {element("h3", text(ours)).html + "\n"};
}

/// mm of the vessels for each Agreement.
std::array<double, 4> measureLengths(const formats::CenterlineTree& tree,
                                     const CheckReport& report) {
  std::array<double, 4> lengths{};
  const std::vector<double> edge = convert::vesselLengths(tree).edge;
  for (std::uint32_t node = 0; node < tree.nodeCount(); ++node)
    lengths[static_cast<std::size_t>(report.nodes[node])] += edge[node];
  return lengths;
}

Markup wallFacts(const CheckReport& report, const formats::CenterlineTree& tree) {
  const Offsets& o = report.offsets;
  const double voxel = report.voxelSize;
  const std::array<double, 4> lengths = measureLengths(tree, report);
  const double length = lengths[0] + lengths[1] + lengths[2] + lengths[3];
  const auto inBoth = [&](double mm) {
    return text(fixedText(mm, 3) + " mm, " + fixedText(mm / voxel, 2) + " voxels");
  };
  const double whole = report.shownLength + report.missingLength();
  return factList(
      {{"One voxel", text(fixedText(voxel, 3) + " mm; blur taken as " +
                          fixedText(report.options.pointSpread, 3) + " mm")},
       {"Samples of the wall",
        text(std::to_string(o.samples) + " judged; " + std::to_string(o.beside) +
             " beside other vessels, " + std::to_string(o.outside) + " outside of the volume")},
       {"Offset, median", inBoth(o.median)},
       {"Its size, median", inBoth(o.absoluteMedian)},
       {"Its size, 90 % below", inBoth(o.absoluteP90)},
       {"Farther than a voxel", text(percentText(o.beyondVoxel) + " of the samples")},
       {"Without an edge", text(percentText(o.noEdge) + " of the samples")},
       {"Dark inside, bright outside", text(percentText(o.wrongPolarity) + " of the samples")},
       {"Length within half a voxel", text(percentText(share(lengths[1], length)))},
       {"within a voxel", text(percentText(share(lengths[2], length)))},
       {"farther, or no edge", text(percentText(share(lengths[3], length)))},
       {"not judged", text(percentText(share(lengths[0], length)))},
       {"Lumen that is dark",
        text(percentText(share(report.dark.volume, report.lumenVolume)) + " of its volume")},
       {"Vessels in the case",
        text(fixedText(report.shownLength, 1) + " of " + fixedText(whole, 1) + " mm, " +
             percentText(share(report.shownLength, whole)))}});
}

Markup wallTable(const CheckReport& report, const formats::CenterlineTree& tree) {
  convert::Table table("wall-table", {{"no."},
                                      {"vessel", false},
                                      {"samples"},
                                      {"offset mm"},
                                      {"in voxels"},
                                      {"size, median voxels"},
                                      {"90 % below voxels"},
                                      {"beyond a voxel"},
                                      {"no edge"},
                                      {"reversed"},
                                      {"beside others"}});
  std::size_t number = 1;
  const auto row = [&](const Markup& no, const Markup& label, const Offsets& o) {
    const double voxel = report.voxelSize;
    table.row({no, label, text(std::to_string(o.samples)), text(fixedText(o.median, 3)),
               text(fixedText(o.median / voxel, 2)), text(fixedText(o.absoluteMedian / voxel, 2)),
               text(fixedText(o.absoluteP90 / voxel, 2)), text(percentText(o.beyondVoxel)),
               text(percentText(o.noEdge)), text(percentText(o.wrongPolarity)),
               text(std::to_string(o.beside))});
  };
  for (const std::uint32_t b : convert::inTreeOrder(tree))
    row(text(std::to_string(number++)), name(report.branches[b].label), report.branches[b].offsets);
  row({}, text("all"), report.offsets);
  return table.markup();
}

Markup regionTable(const char* id, const convert::Regions& regions,
                   const formats::CenterlineTree& tree) {
  convert::Table table(
      id, {{"vessel", false}, {"at mm, LPS", false}, {"volume mm³"}, {"inner radius mm"}});
  for (std::size_t i = 0; i < std::min(kPlacesListed, regions.regions.size()); ++i) {
    const convert::Region& region = regions.regions[i];
    std::vector<Markup> cells = placeCells(tree, region.node, region.position);
    cells.push_back(text(fixedText(region.volume, 1)));
    cells.push_back(text(fixedText(region.radius, 1)));
    table.row(cells);
  }
  Markup result = table.markup();
  result += restSentence(regions.regions.size());
  return result;
}

Markup darkPlaces(const CheckReport& report, const formats::CenterlineTree& tree) {
  Markup content = heading("Dark places inside");
  if (report.dark.regions.empty()) {
    content += paragraph("None: no group of voxels deeper than a voxel inside is dark.");
    return content;
  }
  content +=
      paragraph("Inside of the case, but dark in the volume: too wide, or beside the vessel.");
  content += regionTable("dark-table", report.dark, tree);
  return content;
}

Markup shortEnds(const CheckReport& report, const formats::CenterlineTree& tree) {
  const std::vector<convert::OpenEnd> ends = endsThatStopShort(report);
  Markup content = heading("Ends that stop short");
  content += paragraph(std::to_string(report.ends.size() - ends.size()) + " of " +
                       counted(report.ends.size(), "open end reaches", "open ends reach") +
                       " as far as the volume shows the vessel.");
  if (ends.empty()) return content;
  convert::Table table(
      "end-table", {{"vessel", false}, {"at mm, LPS", false}, {"end", false}, {"goes on for mm"}});
  for (std::size_t i = 0; i < std::min(kPlacesListed, ends.size()); ++i) {
    std::vector<Markup> cells = placeCells(tree, ends[i].node, toEigen(tree.centre[ends[i].node]));
    cells.push_back(text(ends[i].first ? "first" : "last"));
    cells.push_back(text(fixedText(ends[i].goesOn, 0)));
    table.row(cells);
  }
  content += table.markup();
  content += restSentence(ends.size());
  return content;
}

Markup missingVessels(const CheckReport& report, const formats::CenterlineTree& tree) {
  Markup content = heading("Vessels that are missing");
  const auto& vessels = report.missing.vessels;
  if (vessels.empty()) {
    content += paragraph("None that is connected with the case.");
  } else {
    content += paragraph(
        "Bright in the volume, joined to the case, and not in it; the first nine have these "
        "numbers in the "
        "projections.");
    convert::Table table(
        "missing-table",
        {{"no."}, {"beside", false}, {"its middle mm, LPS", false}, {"length mm"}, {"radius mm"}});
    for (std::size_t i = 0; i < std::min(kPlacesListed, vessels.size()); ++i) {
      std::vector<Markup> cells =
          placeCells(tree, vessels[i].path.front().node, middleOf(vessels[i]));
      cells.insert(cells.begin(), text(std::to_string(i + 1)));
      cells.push_back(text(fixedText(vessels[i].length, 1)));
      cells.push_back(text(fixedText(vessels[i].radius, 1)));
      table.row(cells);
    }
    content += table.markup();
    content += restSentence(vessels.size());
  }
  if (report.missing.wide.regions.empty()) return content;
  content += heading("Wide bright regions outside");
  content += paragraph("Joined to the case, and wider than every vessel of it.");
  content += regionTable("wide-table", report.missing.wide, tree);
  return content;
}

}  // namespace

Markup agreementLegend(bool withMissing) {
  return {std::string("<p class=\"legend\">Wall: <span class=\"key "
                      "good\"></span> within half a "
                      "voxel <span class=\"key fair\"></span> within a voxel <span class=\"key "
                      "poor\"></span> farther, or "
                      "no edge <span class=\"key not-judged\"></span> not judged") +
          (withMissing ? " <span class=\"key missing\"></span> not in the case" : "") + "</p>\n"};
}

Markup agreementSection(const ReportFacts& facts) {
  constexpr const char* kTitle = "Agreement with the volume";
  if (!facts.volume)
    return section("agreement", kTitle,
                   paragraph("No volume was given (" + kOption.volume.shown() +
                             "), so nothing is known of how far the wall lies from what "
                             "the volume shows, and of what is missing."));
  if (!facts.volume->check)
    return section("agreement", kTitle,
                   paragraph("This case has no models, so it has no wall to hold against "
                             "the volume; lumen fit makes them of wall points."));
  const CheckReport& report = *facts.volume->check;
  const formats::CenterlineTree& tree = facts.value.tree;
  Markup content = paragraph(
      "Offsets are those of the wall from the half-maximum edge of the volume, positive where the "
      "model is too wide.");
  content += wallFacts(report, tree);
  content += wallTable(report, tree);
  content += darkPlaces(report, tree);
  content += shortEnds(report, tree);
  content += missingVessels(report, tree);
  return section("agreement", kTitle, content);
}

}  // namespace lumen::convert
