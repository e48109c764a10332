// SPDX-License-Identifier: Apache-2.0
// The page of one case: its pictures, figures, statements, places, files and origin.
#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "converters/base/html.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/library/site/pages.h"

namespace lumen::convert {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kOpenRows = 12;  // a longer table is closed until somebody asks for it

std::string linkTo(const CaseRecord& record, const std::string& path) {
  return "../../" + urlAddress(dataPath(record, path));
}

std::string image(const CaseRecord& record, const std::string& path,
                  const std::string& attributes) {
  return "<img src=\"" + linkTo(record, path) +
         "\" decoding=\"async\" width=\"1000\" height=\"800\" " + attributes + ">";
}

/// A row of a list of terms; nothing for an empty description. `html` is ready.
std::string term(const std::string& name, const std::string& html) {
  return html.empty() ? html : factRow(name, {html}).html;
}

std::string textTerm(const std::string& name, const std::string& text) {
  return text.empty() ? text : term(name, htmlName(text));
}

std::string digestCode(const std::string& html) {
  return "<code class=\"digest\">" + html + "</code>";
}

std::string turntable(const CaseRecord& record, const std::vector<std::string>& frames) {
  if (frames.empty()) return {};
  std::string html = "<details id=\"turn\"><summary>" + std::to_string(frames.size()) +
                     " pictures all around</summary><ol class=\"frames\">\n";
  for (std::size_t i = 0; i < frames.size(); ++i)
    html += "<li><a href=\"" + linkTo(record, frames[i]) + "\">" +
            std::to_string(360 * i / frames.size()) + "°</a></li>\n";
  return html + "</ol></details>\n";
}

std::string strip(const CaseRecord& record, const std::vector<std::string>& others) {
  if (others.empty()) return {};
  std::string html = "<ul class=\"strip\">\n";
  for (const std::string& path : others)
    html += "<li><a href=\"" + linkTo(record, path) + "\">" +
            image(record, path, "loading=\"lazy\" alt=\"" + htmlText(path) + "\"") + "</a></li>\n";
  return html + "</ul>\n";
}

/// Every figure that the case has.
std::string figureTerms(const CaseRecord& record) {
  const CaseFigures& figures = record.figures;
  const Eigen::Vector3d size = record.boundsMax - record.boundsMin;
  const auto shown = [](const std::optional<double>& value, const char* unit) {
    return value ? shownFigure(*value) + unit : std::string();
  };
  const bool hasError = figures.errorMedian && figures.errorP90;
  const GeometryFigures geometry = figures.geometry.value_or(GeometryFigures{});
  std::string systems;
  for (const std::string& one : figures.systems) systems += (systems.empty() ? "" : ", ") + one;
  const std::pair<const char*, std::string> terms[] = {
      {"Vessels", std::to_string(figures.branches)},
      {"Systems of vessels", systems},
      {"Aneurysms", figures.aneurysms > 0 ? std::to_string(figures.aneurysms) : ""},
      {"Length", shownFigure(figures.length) + " mm"},
      {"Reachable for a tool", shown(figures.reachable, " mm")},
      {"Radius", shownFigure(figures.radiusMin) + " to " + shownFigure(figures.radiusMax) +
                     " mm, mean " + shownFigure(figures.radiusMean) + " mm"},
      {"Error of fit, by nodes", hasError ? "median " + shownFigure(*figures.errorMedian) +
                                                " mm, 90 % within " +
                                                shownFigure(*figures.errorP90) + " mm"
                                          : ""},
      {"Greatest tortuosity of a path", shown(geometry.tortuosity, "")},
      {"Greatest turning of a path", shown(geometry.turning, "°/cm")},
      {"Greatest take-off angle", shown(geometry.takeOff, "°")},
      {"Greatest stenosis (NASCET)", shown(geometry.stenosis, " %")},
      {"Aneurysm, from neck to tip", shown(geometry.aneurysmReach, " mm")},
      {"Aneurysm, neck", shown(geometry.aneurysmNeck, " mm")},
      {"Size", shownFigure(size.x()) + " × " + shownFigure(size.y()) + " × " +
                   shownFigure(size.z()) + " mm"},
      {"Centerline", counted(figures.nodes, "node", "nodes")}};
  std::string html;
  for (const auto& [name, value] : terms) html += term(name, value);
  return html;
}

/// A button for the first file that `isWanted` accepts; nothing if there is none.
template <class Test>
std::string button(const CaseRecord& record, Test isWanted, const std::string& words,
                   const std::string& attributes) {
  for (const RecordedFile& file : record.files)
    if (isWanted(file))
      return "<a class=\"button\" href=\"" + linkTo(record, file.path) + "\"" + attributes + ">" +
             words + " <span class=\"quiet\">" + shownBytes(file.bytes) + "</span></a>\n";
  return {};
}

std::string buttons(const CaseRecord& record) {
  const auto ofRole = [](const char* role) {
    return [role](const RecordedFile& file) { return file.role == role; };
  };
  const auto isViewer = [](const RecordedFile& file) {  // as `lumen view --html` writes it
    return file.path == "view.html" && file.media == "text/html";
  };
  return button(record, ofRole("case"), "Download the case", " download") +
         button(record, isViewer, "Open in the viewer", "") +
         button(record, ofRole("surface"), "Download the surface", " download") +
         button(record, ofRole("report"), "Report to print", "");
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

/// Licence, origin, consent.
std::string statementTerms(const CaseAbout& about) {
  const auto ofPatient = [&about](const std::string& name, const std::string& text) {
    if (about.synthetic && text.empty()) return std::string();
    return term(name, text.empty() ? "<em>not stated</em>" : htmlName(text));
  };
  return term("Licence", htmlName(about.licence) + " <span class=\"quiet\">(SPDX)</span>") +
         textTerm("To be named", about.attribution) + textTerm("Origin", about.origin) +
         term("DOI", doiLink(about.doi)) +
         term("Patient",
              about.synthetic ? "none: the case is synthetic" : "the case is of a patient") +
         ofPatient("Consent", about.consent) +
         ofPatient("De-identification", about.deidentification) +
         term("Anatomy in codes", codesOf(about));
}

std::string placesPart(const std::string& heading, const std::string& note,
                       const std::vector<CasePlace>& places, bool hasKinds) {
  if (places.empty()) return {};
  const auto number = [](double value) {
    return "<td class=\"number\">" + shownFigure(value) + "</td>";
  };
  std::string rows;
  for (const CasePlace& place : places) {
    rows += "<tr><th scope=\"row\">" + htmlName(place.name) + "</th>";
    if (hasKinds) rows += "<td>" + htmlText(place.kind) + "</td>";
    rows += number(place.radius);
    for (const Eigen::Vector3d& vector : {place.position, place.direction})
      for (const double value : vector) rows += number(value);
    rows += "</tr>\n";
  }
  const std::string all = "<details><summary>All " + std::to_string(places.size()) + "</summary>\n";
  const bool isClosed = places.size() > kOpenRows;
  return sitePart("places.html", {{"heading", heading},
                                  {"open", isClosed ? all : ""},
                                  {"note", note},
                                  {"kind", hasKinds ? "<th scope=\"col\">Kind</th>" : ""},
                                  {"rows", rows},
                                  {"close", isClosed ? "</details>\n" : ""}});
}

/// Files by role, the most wanted first; those of one role by path.
std::string fileRows(const CaseRecord& record) {
  std::string rows;
  for (const char* const role : {"case", "surface", "export", "report", "other", "picture"})
    for (const RecordedFile& file : record.files)
      if (file.role == role)
        rows += "<tr><th scope=\"row\"><a href=\"" + linkTo(record, file.path) + "\" download>" +
                htmlText(file.path) + "</a></th><td>" +
                htmlText(file.role + (file.target.empty() ? "" : " for " + file.target)) +
                "</td><td class=\"number\">" + shownBytes(file.bytes) + "</td><td>" +
                digestCode(htmlText(file.sha256)) + "</td></tr>\n";
  return rows;
}

std::uint64_t totalBytes(const CaseRecord& record) {
  std::uint64_t bytes = 0;
  for (const RecordedFile& file : record.files) bytes += file.bytes;
  return bytes;
}

/// Commands of a shell that fetch all files of the case and compare them with their digests. The
/// address of the library is left to fill in; a script does that where the page came from a server.
std::string fetchCommands(const CaseRecord& record) {
  const std::string list = record.id + ".sha256";
  std::string commands = "cat > " + list + " <<'END'\n";
  for (const RecordedFile& file : record.files)
    commands += file.sha256 + "  " + dataPath(record, file.path) + "\n";
  return commands + "END\nLIBRARY='ADDRESS OF THE LIBRARY'\ncut -c 67- " + list +
         " | while read -r file; do\n"
         "  curl --fail --silent --show-error --create-dirs -o \"$file\" \"$LIBRARY/$file\"\n"
         "done\nsha256sum -c " +
         list + "\n";
}

/// A value of a step as a person reads it: texts without quotation marks.
std::string valueText(const Json& value) {
  return htmlName(value.is_string() ? value.get<std::string>()
                                    : value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string provenanceTerms(const Json& provenance) {
  const Json& source = provenance.at("source");
  return term("Case as it was added", digestCode(valueText(provenance.at("case_sha256")))) +
         term("Made by", valueText(provenance.at("generator"))) +
         (source.is_null() ? ""
                           : term("Volume or mesh", digestCode(valueText(source.at("sha256")))));
}

std::string stepItems(const Json& steps) {
  if (steps.empty()) return {};
  std::string html = "<ol class=\"steps\">\n";
  for (const Json& step : steps) {
    html += "<li><strong>" + valueText(step.at("name")) + "</strong> <span class=\"quiet\">" +
            valueText(step.at("tool")) + "</span>";
    if (const Json& parameters = step.at("parameters"); !parameters.empty()) {
      html += "<details><summary>" + counted(parameters.size(), "parameter", "parameters") +
              "</summary>\n<dl class=\"wide\">\n";
      for (const auto& [name, value] : parameters.items())
        html += "<div><dt>" + htmlName(name) + "</dt><dd>" + valueText(value) + "</dd></div>\n";
      html += "</dl></details>";
    }
    html += "</li>\n";
  }
  return html + "</ol>\n";
}

}  // namespace

std::string casePage(const LibraryFile& library, const CaseRecord& record,
                     const std::string& signature) {
  const CaseAbout& about = record.about;
  const CasePictures pictures = casePictures(record);
  const std::string content = sitePart(
      "case.html",
      {{"library", htmlName(library.title)},
       {"title", htmlName(about.title)},
       {"what", kindOfCase(about)},
       {"tags", tagsOfCase(record)},
       {"id", htmlText(record.id)},
       {"version", std::to_string(record.version)},
       {"picture", pictures.first.empty()
                       ? "<span class=\"none\">no picture</span>"
                       : image(record, pictures.first,
                               "alt=\"The vessels of this case\" fetchpriority=\"high\"")},
       {"turntable", turntable(record, pictures.frames)},
       {"strip", strip(record, pictures.others)},
       {"figures", figureTerms(record)},
       {"actions", buttons(record)},
       {"description", about.description.empty()
                           ? ""
                           : "<p class=\"description\">" + htmlName(about.description) + "</p>\n"},
       {"statements", statementTerms(about)},
       {"insertions",
        placesPart("Where instruments enter",
                   "Directions point into the vessel. Millimetres, LPS: +x left, +y back, +z head.",
                   record.insertions, false)},
       {"ends", placesPart("Ends of vessels",
                           "Directions point out of the vessel. Millimetres, LPS. Exports use the "
                           "same names.",
                           record.ends, true)},
       {"count", counted(record.files.size(), "file", "files")},
       {"size", shownBytes(totalBytes(record))},
       {"record", linkTo(record, kRecordFile)},
       {"files", fileRows(record)},
       {"fetch", copyable("the commands that fetch and check", fetchCommands(record))},
       {"citation", copyable("the citation", citationText(library, record))},
       {"bibtex", copyable("the BibTeX entry", citationBibTex(library, record))},
       {"provenance", provenanceTerms(record.provenance)},
       {"steps", stepItems(record.provenance.at("steps"))}});
  PageFrame frame;
  frame.root = "../../";
  frame.title = about.title + " - " + library.title;
  frame.scripts = {"case.js"};
  frame.data = " class=\"one\"";
  return pageText(frame, content, library, signature);
}

}  // namespace lumen::convert
