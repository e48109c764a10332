// SPDX-License-Identifier: Apache-2.0
// Sections that describe a case: pictures, figures, statements, places.
#include <cstddef>
#include <vector>

#include "converters/base/html.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/library/site/case_page.h"
#include "converters/library/site/case_texts.h"
#include "converters/library/site/pictures.h"

namespace lumen::convert {

namespace {

constexpr std::size_t kOpenRows = 12;  // a longer table is closed until somebody asks for it

std::string linkTo(const CaseRecord& record, const std::string& path) {
  return "../../" + urlAddress(dataPath(record, path));
}

std::string image(const CaseRecord& record, const std::string& path,
                  const std::string& attributes) {
  std::string element = "<img src=\"";
  element += linkTo(record, path);
  element += "\" decoding=\"async\" width=\"1000\" height=\"800\" ";
  element += attributes;
  element += ">";
  return element;
}

/// A row of a list of terms; nothing for an empty description. `html` is ready.
std::string term(const std::string& name, const std::string& html) {
  return html.empty() ? std::string() : factRow(name, {html}).html;
}

std::string textTerm(const std::string& name, const std::string& text) {
  return text.empty() ? std::string() : term(name, htmlName(text));
}

std::string vectorCells(const Eigen::Vector3d& vector) {
  std::string cells;
  for (int a = 0; a < 3; ++a) {
    cells += "<td class=\"number\">";
    cells += shownFigure(vector[a]);
    cells += "</td>";
  }
  return cells;
}

std::string placeRows(const std::vector<CasePlace>& places, bool kinds) {
  std::string rows;
  for (const CasePlace& place : places) {
    rows += "<tr><th scope=\"row\">" + htmlName(place.name) + "</th>";
    if (kinds) rows += "<td>" + htmlText(place.kind) + "</td>";
    rows += "<td class=\"number\">" + shownFigure(place.radius) + "</td>" +
            vectorCells(place.position) + vectorCells(place.direction) + "</tr>\n";
  }
  return rows;
}

const RecordedFile* fileOfRole(const CaseRecord& record, const std::string& role) {
  for (const RecordedFile& file : record.files)
    if (file.role == role) return &file;
  return nullptr;
}

/// The case in the viewer, as `lumen view --html` writes it; null without one.
const RecordedFile* findViewer(const CaseRecord& record) {
  for (const RecordedFile& file : record.files)
    if (file.path == "view.html" && file.media == "text/html") return &file;
  return nullptr;
}

std::string button(const CaseRecord& record, const RecordedFile* file, const std::string& words,
                   const std::string& attributes) {
  if (file == nullptr) return {};
  return "<a class=\"button\" href=\"" + linkTo(record, file->path) + "\"" + attributes + ">" +
         words + " <span class=\"quiet\">" + shownBytes(file->bytes) + "</span></a>\n";
}

std::string codesOf(const CaseAbout& about) {
  std::string codes;
  for (const AnatomyCode& code : about.codes) {
    if (!codes.empty()) codes += "<br>";
    codes += htmlText(code.system) + " <code>" + htmlText(code.code) + "</code>";
    if (!code.name.empty()) codes += " " + htmlName(code.name);
  }
  return codes;
}

}  // namespace

std::string pictureSection(const CaseRecord& record) {
  const CasePictures pictures = casePictures(record);
  std::string section = "<div class=\"pictures\">\n<figure class=\"shot\" id=\"shot\">";
  section += pictures.first.empty()
                 ? "<span class=\"none\">no picture</span>"
                 : image(record, pictures.first,
                         "alt=\"The vessels of this case\" fetchpriority=\"high\"");
  section += "</figure>\n";
  if (!pictures.frames.empty()) {
    section += "<details id=\"turn\"><summary>" + std::to_string(pictures.frames.size()) +
               " pictures all around</summary><ol class=\"frames\">\n";
    for (std::size_t i = 0; i < pictures.frames.size(); ++i)
      section += "<li><a href=\"" + linkTo(record, pictures.frames[i]) + "\">" +
                 std::to_string(360 * i / pictures.frames.size()) + "°</a></li>\n";
    section += "</ol></details>\n";
  }
  if (!pictures.others.empty()) {
    section += "<ul class=\"strip\">\n";
    for (const std::string& path : pictures.others)
      section += "<li><a href=\"" + linkTo(record, path) + "\">" +
                 image(record, path, "loading=\"lazy\" alt=\"" + htmlText(path) + "\"") +
                 "</a></li>\n";
    section += "</ul>\n";
  }
  return section + "</div>\n";
}

/// The extremes of the measures that the case has.
std::string geometryTerms(const GeometryFigures& geometry) {
  struct Shown {
    const char* title;
    const std::optional<double>& value;
    const char* unit;
  };
  const Shown all[] = {{"Greatest tortuosity of a path", geometry.tortuosity, ""},
                       {"Greatest turning of a path", geometry.turning, "°/cm"},
                       {"Greatest take-off angle", geometry.takeOff, "°"},
                       {"Greatest stenosis (NASCET)", geometry.stenosis, " %"},
                       {"Aneurysm, from neck to tip", geometry.aneurysmReach, " mm"},
                       {"Aneurysm, neck", geometry.aneurysmNeck, " mm"}};
  std::string text;
  for (const Shown& shown : all)
    if (shown.value) text += term(shown.title, shownFigure(*shown.value) + shown.unit);
  return text;
}

std::string factsSection(const CaseRecord& record) {
  const CaseFigures& figures = record.figures;
  const Eigen::Vector3d size = record.boundsMax - record.boundsMin;
  std::string text = "<section class=\"facts\" aria-label=\"Figures\">\n<dl>\n";
  text += term("Vessels", std::to_string(figures.branches));
  if (figures.aneurysms > 0) text += term("Aneurysms", std::to_string(figures.aneurysms));
  text += term("Length", shownFigure(figures.length) + " mm");
  if (figures.reachable)
    text += term("Reachable for a tool", shownFigure(*figures.reachable) + " mm");
  text += term("Radius", shownFigure(figures.radiusMin) + " to " + shownFigure(figures.radiusMax) +
                             " mm, mean " + shownFigure(figures.radiusMean) + " mm");
  if (figures.errorMedian && figures.errorP90)
    text += term("Error of fit, by nodes", "median " + shownFigure(*figures.errorMedian) +
                                               " mm, 90 % within " +
                                               shownFigure(*figures.errorP90) + " mm");
  text += geometryTerms(figures.geometry.value_or(GeometryFigures{}));
  text += term("Size", shownFigure(size.x()) + " × " + shownFigure(size.y()) + " × " +
                           shownFigure(size.z()) + " mm");
  text += term("Centerline", counted(figures.nodes, "node", "nodes"));
  text += "</dl>\n<p class=\"actions\">";
  text += button(record, fileOfRole(record, "case"), "Download the case", " download");
  text += button(record, findViewer(record), "Open in the viewer", "");
  text += button(record, fileOfRole(record, "surface"), "Download the surface", " download");
  text += button(record, fileOfRole(record, "report"), "Report to print", "");
  return text + "</p>\n</section>\n";
}

std::string statementsSection(const CaseRecord& record) {
  const CaseAbout& about = record.about;
  const std::string not_stated = "<em>not stated</em>";
  std::string text = "<section><h2>Licence and origin</h2>\n<dl class=\"wide\">\n";
  text += term("Licence", htmlName(about.licence) + " <span class=\"quiet\">(SPDX)</span>");
  text += textTerm("To be named", about.attribution);
  text += textTerm("Origin", about.origin);
  text += term("DOI", doiLink(about.doi));
  text +=
      term("Patient", about.synthetic ? "none: the case is synthetic" : "the case is of a patient");
  if (!about.synthetic || !about.consent.empty())
    text += term("Consent", about.consent.empty() ? not_stated : htmlName(about.consent));
  if (!about.synthetic || !about.deidentification.empty())
    text += term("De-identification",
                 about.deidentification.empty() ? not_stated : htmlName(about.deidentification));
  text += term("Anatomy in codes", codesOf(about));
  return text + "</dl>\n</section>\n";
}

std::string placesSection(const std::string& heading, const std::string& note,
                          const std::vector<CasePlace>& places, bool kinds) {
  if (places.empty()) return {};
  std::string text = "<section><h2>" + heading + "</h2>\n";
  const bool closed = places.size() > kOpenRows;
  if (closed) text += "<details><summary>All " + std::to_string(places.size()) + "</summary>\n";
  text += "<p class=\"quiet\">" + note +
          "</p>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" + heading +
          "\">\n<table>\n<thead><tr><th scope=\"col\">Name</th>";
  if (kinds) text += "<th scope=\"col\">Kind</th>";
  for (const char* const column : {"Radius", "x", "y", "z", "Direction x", "y", "z"}) {
    text += "<th scope=\"col\" class=\"number\">";
    text += column;
    text += "</th>";
  }
  text += "</tr></thead>\n<tbody>\n" + placeRows(places, kinds) + "</tbody>\n</table>\n</div>\n";
  if (closed) text += "</details>\n";
  return text + "</section>\n";
}

}  // namespace lumen::convert
