// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/report/report_page.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "converters/base/html.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/base/text.h"
#include "converters/draw/report/profile_plot.h"
#include "converters/draw/report/tree_profiles.h"

namespace lumen::convert {

void Table::row(const std::vector<Markup>& cells) {
  Markup row;
  for (std::size_t i = 0; i < m_columns.size(); ++i)
    row += element("td", i < cells.size() ? cells[i] : Markup{},
                   m_columns[i].isNumber ? "class=\"number\"" : "");
  m_rows += element("tr", row).html + "\n";
  ++m_count;
}

Markup Table::markup() const {
  Markup head;
  for (const Column& column : m_columns)
    head += element("th", text(column.title), column.isNumber ? "class=\"number\"" : "");
  Markup table = element("thead", element("tr", head));
  table.html += "\n<tbody>\n" + m_rows + "</tbody>";
  constexpr std::size_t kFew = 5;  // columns that need not fill the page
  const std::string size = m_columns.size() <= kFew ? " class=\"small\"" : "";
  return {element("table", table, "id=\"" + htmlText(m_id) + "\"" + size).html + "\n"};
}

namespace {

// Nothing may be fetched or run: pictures and style are in the file.
constexpr const char* kPolicy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action "
    "'none'";
constexpr std::size_t kDigitsInFoot = 16;  // digits of the digest, enough to distinguish cases

constexpr const char* kStyle = R"(
@page { size: A4; margin: 15mm 14mm 17mm; }
* { box-sizing: border-box; }
html { background: #fff; color: #111; }
body { font: 9.5pt/1.4 "Liberation Sans", Arial, Helvetica, "DejaVu Sans", sans-serif; margin: 0 auto; padding: 5mm; max-width: 192mm; overflow-wrap: break-word; }
bdi, code { overflow-wrap: anywhere; }
@media print { body { max-width: none; padding: 0; } }
h1 { font-size: 19pt; line-height: 1.2; margin: 0 0 1mm; }
h2 { font-size: 13pt; margin: 7mm 0 2mm; padding-bottom: 0.6mm; border-bottom: 0.4mm solid #888; }
h3 { font-size: 10pt; margin: 4mm 0 1mm; }
h1, h2, h3, h2 + p:not(:last-child), h3 + p:has(+ table), .legend { break-after: avoid; break-inside: avoid; }
p { margin: 1.2mm 0 2mm; orphans: 3; widows: 3; }
.notice { border: 0.3mm solid #a01818; padding: 1mm 2mm; }
figure { margin: 2mm 0; break-inside: avoid; }
figcaption { font-size: 8.5pt; color: #333; }
img { display: block; width: 100%; height: auto; border: 0.2mm solid #bbb; }
#sides > div { display: grid; grid-template-columns: 1fr 1fr; gap: 0 3mm; }
#sides, #projection { break-inside: avoid; }
.panels { display: flex; flex-wrap: wrap; gap: 0 2mm; } .panels figure { max-width: 100%; margin: 1mm 0; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 3mm; align-items: end; break-inside: avoid; }
dl { display: grid; grid-template-columns: 1fr 1fr; gap: 0 6mm; margin: 0 0 2mm; }
dl > div { display: grid; grid-template-columns: 38% 1fr; gap: 2mm; border-bottom: 0.1mm solid #ccc; padding: 0.7mm 0; break-inside: avoid; }
dt { color: #444; } dd { margin: 0; }
#provenance dl { grid-template-columns: 1fr; } #provenance dl > div { grid-template-columns: 34% 1fr; }
code { font: 8pt "Liberation Mono", "DejaVu Sans Mono", monospace; }
table { border-collapse: collapse; width: 100%; font-size: 8.3pt; line-height: 1.25; margin: 1mm 0 2mm; }
table.small { width: auto; min-width: 66%; } .small .number { width: auto; } th.number { min-width: 13mm; }
thead { display: table-header-group; } tr { break-inside: avoid; }
th { text-align: left; vertical-align: bottom; border-bottom: 0.3mm solid #444; padding: 0.6mm 1.2mm; overflow-wrap: normal; hyphens: none; }
td { vertical-align: top; border-bottom: 0.1mm solid #ccc; padding: 0.6mm 1.2mm; }
.number { text-align: right; width: 1%; font-variant-numeric: tabular-nums; } td.number { white-space: nowrap; }
.profiles { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 2mm 3mm; }
.profile { margin: 0; min-width: 0; }
.profile figcaption { white-space: nowrap; overflow: hidden; text-overflow: ellipsis; }
.legend { font-size: 8.5pt; } .key { display: inline-block; width: 6mm; height: 2mm; margin-left: 3mm; }
.viridis { display: inline-block; width: 30mm; height: 2.4mm; background: linear-gradient(to right, #440154, #3b528b, #21908d, #5dc863, #fde725); }
.parameters { columns: 3; column-gap: 5mm; margin: 0 0 2mm; padding: 0; list-style: none; font-size: 8.5pt; } .parameters, .parameters li { break-inside: avoid; }
.signing { break-inside: avoid; } .signing div { display: grid; grid-template-columns: 2fr 1fr 2fr; gap: 6mm; margin-top: 13mm; }
.signing span { border-top: 0.2mm solid #111; padding-top: 0.5mm; font-size: 8.5pt; }
* { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
)";

/// The foot of each page: the digest is made of digits and letters.
std::string footStyle(const ReportFacts& facts) {
  return "@page { @bottom-left { font: 7.5pt sans-serif; color: #555; content: \"lumen report, "
         "case " +
         facts.sha256.substr(0, kDigitsInFoot) +
         "\"; } @bottom-right { font: 7.5pt sans-serif; color: #555; content: \"page \" "
         "counter(page) \" of \" counter(pages); } }\n";
}

/// "x 10.0 to 20.0, y ..., z ... mm": of all balls around nodes.
std::string extentText(const formats::CenterlineTree& tree) {
  if (tree.nodeCount() == 0) return "-";
  std::string words;
  const std::array<std::pair<const char*, float formats::Vec3f::*>, 3> axes = {
      {{"x", &formats::Vec3f::x}, {"y", &formats::Vec3f::y}, {"z", &formats::Vec3f::z}}};
  for (const auto& [axis, part] : axes) {
    float low = tree.centre[0].*part, high = low;
    for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
      low = std::min(low, tree.centre[n].*part - tree.radius[n]);
      high = std::max(high, tree.centre[n].*part + tree.radius[n]);
    }
    words += std::string(words.empty() ? "" : "; ") + axis + " " +
             fixedText(static_cast<double>(low), 1) + " to " +
             fixedText(static_cast<double>(high), 1);
  }
  return words + " mm, LPS";
}

std::string vesselsText(const formats::CenterlineTree& tree) {
  const auto aneurysms = static_cast<std::size_t>(std::count_if(
      tree.branches.begin(), tree.branches.end(),
      [](const formats::Branch& b) { return b.kind == formats::BranchKind::Aneurysm; }));
  const auto roots = static_cast<std::size_t>(
      std::count_if(tree.branches.begin(), tree.branches.end(),
                    [](const formats::Branch& b) { return b.parentNode == formats::kNoParent; }));
  std::string words = std::to_string(tree.branches.size() - aneurysms);
  if (aneurysms > 0) words += ", and " + counted(aneurysms, "aneurysm", "aneurysms");
  words += "; " + counted(roots, "root", "roots");
  if (!tree.links.empty())
    words += ", " + counted(tree.links.size(), "closed loop", "closed loops");
  return words;
}

std::string fitText(const CaseInfo& info) {
  if (!info.errorOfFit) return "not known: it needs wall points and models";
  return "median " + fixedText(info.errorOfFit->median, 3) + ", 90 % below " +
         fixedText(info.errorOfFit->p90, 3) + ", greatest " + fixedText(info.errorOfFit->max, 3) +
         " mm";
}

void addAgreement(const ReportFacts& facts, Facts& list) {
  if (!facts.volume || !facts.volume->check) {
    list.emplace_back("Wall and volume", text(facts.volume ? "not known: the case has no models"
                                                           : "not known: no volume was given"));
    return;
  }
  const convert::CheckReport& report = *facts.volume->check;
  const double voxel = report.voxelSize;
  list.emplace_back(
      "Wall and volume",
      text("median offset " + fixedText(report.offsets.median / voxel, 2) +
           " voxels, 90 % within " + fixedText(report.offsets.absoluteP90 / voxel, 2) + ", " +
           percentText(report.offsets.beyondVoxel) + " beyond a voxel"));
  list.emplace_back(
      "Vessels of the volume in the case",
      text(percentText(share(report.shownLength, report.shownLength + report.missingLength())) +
           " of the length that is connected with it"));
}

Markup summary(const ReportFacts& facts) {
  const CaseInfo& info = facts.info;
  const formats::CenterlineTree& tree = facts.value.tree;
  Facts list = {{"Vessels", text(vesselsText(tree))},
                {"Length", text(fixedText(info.length, 1) + " mm")}};
  list.emplace_back("Radius", text(info.radius ? fixedText(info.radius->min, 2) + " to " +
                                                     fixedText(info.radius->max, 2) + " mm"
                                               : "-"));
  list.emplace_back("Reachable for a tool", text(reachText(info.reach)));
  list.emplace_back(
      "Confidence, mean",
      text(tree.inlierRate.empty()
               ? "not recorded"
               : fixedText(convert::confidenceShares(tree).mean, 2) + " (inlier rate)"));
  list.emplace_back("Error of fit", text(fitText(info)));
  addAgreement(facts, list);
  list.emplace_back("Extent", text(extentText(tree)));
  list.emplace_back("Made of", text(counted(info.nodes, "node", "nodes") + ", " +
                                    counted(info.points, "wall point", "wall points") + ", " +
                                    counted(info.blobs.value_or(0), "blob", "blobs")));
  list.emplace_back("Voxel of the source",
                    text(info.metadata.voxelSize ? fixedText(*info.metadata.voxelSize, 3) + " mm"
                                                 : "not recorded"));
  list.emplace_back(
      "Warnings",
      text(facts.warnings() == 0 ? "none" : std::to_string(facts.warnings()) + ", listed below"));
  return factList(list);
}

Markup warnings(const ReportFacts& facts) {
  constexpr const char* kTitle = "Warnings";
  if (facts.examination.counts.total() + facts.otherWarnings.size() == 0)
    return section(
        "warnings", kTitle,
        paragraph(
            std::string("None: the case is valid, a tool reaches all of it as far as is known, ") +
            (facts.sides.empty() ? "" : "the surface that lumen convert makes is whole, ") +
            "and no text of it looks like a person's."));
  convert::Table table("warning-table", {{"kind", false}, {"what", false}});
  for (const std::string& words : facts.otherWarnings)
    table.row({text("warning"), shortened(words, 600)});
  for (const Remark& remark : facts.examination.remarks)
    table.row({text(remark.severity), shortened(remark.text, 600)});
  Markup content = table.markup();
  if (facts.examination.unlisted() > 0)
    content += paragraph("And " + std::to_string(facts.examination.unlisted()) +
                         " more; lumen validate " + kOption.privacy.shown() + " lists all.");
  return section("warnings", kTitle, content);
}

Markup sides(const ReportFacts& facts) {
  constexpr const char* kTitle = "From four sides, at one scale";
  if (facts.sides.empty())
    return section("sides", kTitle,
                   paragraph("There are no pictures, as this case has no models, so no "
                             "surface; lumen fit makes them of wall points."));
  Markup figures;
  for (const DrawnView& view : facts.sides)
    figures += pngFigure(view.png, text(view.title), "The case, " + view.title);
  return section("sides", kTitle, element("div", figures));
}

/// mm on paper for a pixel of the projections: they fill the width, stacked or the first two side
/// by side, and stay on a page.
double projectionScale(const std::vector<DrawnView>& views) {
  constexpr double kWide = 180, kHigh = 205, kCaption = 7;  // mm
  double widest = 0, stacked = 0;
  for (const DrawnView& view : views) {
    widest = std::max<double>(widest, view.width);
    stacked += view.height;
  }
  const double inOne = std::min(kWide / widest, (kHigh - 3 * kCaption) / stacked);
  if (views.size() < 3) return inOne;
  const double row = std::max(views[0].height, views[1].height);
  return std::max(inOne, std::min((kWide - 3) / (views[0].width + views[1].width),
                                  (kHigh - 2 * kCaption) / (row + views[2].height)));
}

Markup projection(const ReportFacts& facts) {
  constexpr const char* kTitle = "The volume and the tree";
  if (!facts.volume)
    return section("projection", kTitle,
                   paragraph("There is no projection, as no volume was given (" +
                             kOption.volume.shown() + ")."));
  Markup content = paragraph(
      "The greatest intensity along each axis of the volume, and the centerlines of the case. x: "
      "to the patient's "
      "left, y: to the back, z: to the head.");
  content += agreementLegend(true);
  const double scale = projectionScale(facts.volume->projections);
  Markup figures;
  for (const DrawnView& view : facts.volume->projections)
    figures += pngFigure(view.png, text(view.title),
                         "Projection of the volume with the centerlines, " + view.title,
                         "style=\"width: " + fixedText(scale * view.width, 1) + "mm\"");
  content += element("div", figures, "class=\"panels\"");
  return section("projection", kTitle, content);
}

const char* signing() {
  return R"(<section class="signing"><h2>Reviewed</h2>
<p>I have read this report; it is about the case with the digest above.</p>
<div><span>name</span><span>date</span><span>signature</span></div></section>
)";
}

}  // namespace

std::string reportPage(const ReportFacts& facts) {
  PageHead head;
  head.policy = kPolicy;
  head.meta = {{"generator", "lumen " LUMEN_VERSION}};
  head.title = facts.title;
  head.links = kStyle + footStyle(facts) + convert::plotStyle();
  head.links = "<style>" + head.links + "</style>\n";
  Markup body{"<h1>" + htmlName(facts.title) + "</h1>\n"};
  body += paragraph(
      "The content of a case of vessels, how it was made, and how far it agrees with its volume.");
  body.html += "<p class=\"notice\">Not a medical device: not for clinical use.</p>\n";
  body += summary(facts);
  for (const auto part :
       {warnings, sides, branchSection, profileSection, measureSection, confidenceSection,
        agreementSection, projection, parameterSection, provenanceSection})
    body += part(facts);
  return htmlPage(head, body.html + signing());
}

}  // namespace lumen::convert
