// SPDX-License-Identifier: Apache-2.0
#include "converters/library/site/case_page.h"

#include "converters/base/html.h"
#include "converters/library/site/case_texts.h"
#include "converters/library/site/notes.h"
#include "converters/library/site/page_frame.h"

namespace lumen::convert {

namespace {

constexpr const char* kRoot = "../../";  // path from site/case/

std::string heading(const LibraryFile& library, const CaseRecord& record) {
  const CaseAbout& about = record.about;
  std::string text = "<header class=\"top\">\n<nav aria-label=\"Library\"><a id=\"back\" href=\"";
  text += kRoot;
  text += "index.html\">‹ " + htmlName(library.title) + "</a></nav>\n<h1>" + htmlName(about.title) +
          "</h1>\n<p class=\"what\">";
  if (!about.anatomy.empty()) text += htmlName(about.anatomy) + " · ";
  text += htmlText(sideText(about.laterality)) + " · " + htmlText(modalityText(about.modality)) +
          "</p>\n<p class=\"tags\">";
  if (record.figures.aneurysms > 0) text += "<span class=\"tag mark\">aneurysm</span> ";
  text += std::string("<span class=\"tag\">") + (about.synthetic ? "synthetic" : "patient") +
          "</span> <span class=\"tag\">" + htmlName(about.licence) +
          "</span> <span class=\"quiet\"><code>" + htmlText(record.id) + "</code>, version " +
          std::to_string(record.version) + "</span></p>\n</header>\n";
  return text;
}

}  // namespace

std::string casePage(const LibraryFile& library, const CaseRecord& record,
                     const std::string& signature) {
  PageFrame frame;
  frame.root = kRoot;
  frame.title = record.about.title + " - " + library.title;
  frame.scripts = {"case.js"};
  frame.data = " class=\"one\"";
  std::string content = "<a class=\"skip\" href=\"#case\">Skip to the case</a>\n";
  content += heading(library, record) +
             "<main id=\"case\" tabindex=\"-1\">\n<div class=\"look\">\n" + pictureSection(record) +
             factsSection(record) + "</div>\n";
  if (!record.about.description.empty())
    content += "<p class=\"description\">" + htmlName(record.about.description) + "</p>\n";
  content += statementsSection(record);
  content += placesSection(
      "Where instruments enter",
      "Directions point into the vessel. Millimetres, LPS: +x left, +y back, +z head.",
      record.insertions, false);
  content += placesSection(
      "Ends of vessels",
      "Directions point out of the vessel. Millimetres, LPS. Exports use the same names.",
      record.ends, true);
  content += filesSection(record) + citeSection(library, record) + provenanceSection(record) +
             "</main>\n" + footer(library, frame.root, signature);
  return pageText(frame, content);
}

}  // namespace lumen::convert
