// SPDX-License-Identifier: Apache-2.0
// The gallery of a library, complete without a script, and the list that its script searches.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "converters/base/html.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/library/site/pages.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// A text that sorts by bytes as people sort the title: small letters as capitals, and numbers by
/// their values, as each begins with the number of its digits.
std::string sortKey(const std::string& title) {
  const std::string text = lowerCase(title);
  std::string key;
  for (std::size_t at = 0; at < text.size();) {
    if (!isDigit(text[at])) {
      key += text[at++];
      continue;
    }
    const std::size_t end = std::min(text.find_first_not_of("0123456789", at), text.size());
    at = std::min(text.find_first_not_of('0', at), end);
    key += paddedNumber(end - at, 3) + text.substr(at, end - at);
    at = end;
  }
  return key;
}

std::string pageLink(const std::string& address, const std::string& text, const char* relation) {
  return "<a href=\"" + address + "\"" + relation + ">" + text + "</a>\n";
}

/// To 0.01.
double rounded(double value) {
  constexpr double kSteps = 100;  // steps in one mm
  return std::isfinite(value) ? std::round(value * kSteps) / kSteps : 0;
}

/// Links to the pages before, after, at both ends, and around this one.
std::string pageLinks(std::size_t page, std::size_t pages, const std::string& root) {
  constexpr std::size_t kAround = 2;
  if (pages == 1) return {};
  const auto address = [&](std::size_t n) { return root + galleryPath(n); };
  std::string links;
  if (page > 1) links += pageLink(address(page - 1), "Previous", " rel=\"prev\"");
  std::size_t last = 0;
  for (std::size_t n = 1; n <= pages; ++n) {
    if (n != 1 && n != pages && (n + kAround < page || n > page + kAround)) continue;
    if (n > last + 1) links += "<span aria-hidden=\"true\">…</span>\n";
    links += pageLink(address(n), std::to_string(n), n == page ? " aria-current=\"page\"" : "");
    last = n;
  }
  if (page < pages) links += pageLink(address(page + 1), "Next", " rel=\"next\"");
  return links;
}

}  // namespace

std::vector<std::size_t> galleryOrder(const LibraryFile& library) {
  std::vector<std::string> keys;
  keys.reserve(library.cases.size());
  for (const LibraryEntry& entry : library.cases) keys.push_back(sortKey(entry.title));
  std::vector<std::size_t> order(library.cases.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(keys[a], library.cases[a].id) < std::tie(keys[b], library.cases[b].id);
  });
  return order;
}

std::string galleryCard(const CaseRecord& record, const std::string& root) {
  const std::string picture = casePictures(record).thumbnail;
  const CaseFigures& figures = record.figures;
  return sitePart(
      "card.html",
      {{"picture", picture.empty()
                       ? "<span class=\"none\">no picture</span>"
                       : "<img src=\"" + root + urlAddress(dataPath(record, picture)) +
                             "\" alt=\"\" loading=\"lazy\" decoding=\"async\" width=\"500\" "
                             "height=\"400\">"},
       {"page", root + urlAddress(casePagePath(record.id))},
       {"title", htmlName(record.about.title)},
       {"what", kindOfCase(record.about)},
       {"vessels", counted(figures.branches, "vessel", "vessels")},
       {"length", shownFigure(figures.length)},
       {"least", shownFigure(figures.radiusMin)},
       {"most", shownFigure(figures.radiusMax)},
       {"tags", tagsOfCase(record)}});
}

std::string galleryPath(std::size_t page) {
  return page == 1 ? "index.html" : "site/page/" + std::to_string(page) + ".html";
}

std::string galleryPage(const LibraryFile& library, std::size_t page, const std::string& cards,
                        const std::string& signature) {
  const std::size_t cases = library.cases.size(),
                    pages = std::max<std::size_t>(1, (cases + kCasesPerPage - 1) / kCasesPerPage);
  PageFrame frame;
  frame.root = page == 1 ? "" : "../../";
  frame.title = library.title;
  if (page > 1) frame.title += ", page " + std::to_string(page);
  frame.scripts = {"cases.js", "facets.js", "gallery.js"};
  frame.data = " class=\"gallery\" data-page=\"" + std::to_string(page) + "\" data-size=\"" +
               std::to_string(kCasesPerPage) + "\"";
  const std::string content = sitePart(
      "gallery.html",
      {{"title", htmlName(library.title)},
       {"description",
        library.description.empty() ? "" : "<p>" + htmlName(library.description) + "</p>\n"},
       {"publisher", library.publisher.empty() ? "" : htmlName(library.publisher) + " · "},
       {"revision", std::to_string(library.revision)},
       {"date", htmlText(library.date)},
       {"licence", htmlText(library.licence)},
       {"count", counted(cases, "case", "cases")},
       {"cards", cards},
       {"pages", pageLinks(page, pages, frame.root)}});
  return pageText(frame, content, library, signature);
}

std::string searchRow(const CaseRecord& record) {
  using formats::printable;
  const CaseAbout& about = record.about;
  std::string words;
  for (const AnatomyCode& code : about.codes)
    words += printable(code.name) + " " + printable(code.code) + " ";
  for (const std::vector<CasePlace>* const places : {&record.insertions, &record.ends})
    for (const CasePlace& place : *places) words += printable(place.name) + " ";
  using Json = nlohmann::ordered_json;
  Json row = Json::array(
      {record.id, printable(about.title), printable(about.anatomy), printable(about.laterality),
       printable(about.modality), about.synthetic ? 1 : 0, printable(about.licence),
       record.figures.branches, record.figures.aneurysms, rounded(record.figures.length),
       rounded(record.figures.radiusMin), rounded(record.figures.radiusMax),
       casePictures(record).thumbnail, trimmed(words)});
  const GeometryFigures geometry = record.figures.geometry.value_or(GeometryFigures{});
  for (const GeometryKey& figure : kGeometryKeys) {
    const std::optional<double>& value = geometry.*figure.value;
    row.push_back(value ? Json(rounded(*value)) : Json());
  }
  return jsonInScript(row.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace lumen::convert
