// SPDX-License-Identifier: Apache-2.0
#include "converters/library/batch/batch_tables.h"

#include <algorithm>
#include <array>
#include <span>
#include <system_error>

#include "converters/base/csv_rows.h"
#include "converters/base/embedded_text.h"
#include "converters/base/error.h"
#include "converters/base/html.h"
#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::convert {

std::span<const EmbeddedText> batchTexts();

namespace fs = std::filesystem;

namespace {

constexpr std::array<BatchEnd, 4> kFirstToLookAt = {BatchEnd::Failed, BatchEnd::NeedsPerson,
                                                    BatchEnd::NoVessels, BatchEnd::Passed};

std::string joinedCells(const std::vector<std::string>& cells) {
  std::string row;
  for (const std::string& cell : cells) row += (row.empty() ? "" : ",") + csvCell(cell);
  return row + "\n";
}

std::string numberOr(bool isKnown, double value, int decimals) {
  return isKnown ? fixedText(value, decimals) : "";
}

std::size_t countOf(const std::vector<BatchResult>& results, BatchEnd end) {
  return static_cast<std::size_t>(std::count_if(
      results.begin(), results.end(), [end](const BatchResult& r) { return r.end == end; }));
}

bool hasCase(const BatchResult& result) {
  return result.end == BatchEnd::Passed || result.end == BatchEnd::NeedsPerson;
}

/// The viewer beside a case's worst place, with names as seen from the folders of the inputs and of the
/// batch.
std::string viewLine(const BatchResult& result) {
  return shellLine(viewWords(result, result.name, batchCase(result.id).string()));
}

Markup link(const fs::path& file, const Markup& content) {
  return element("a", content, "href=\"" + urlAddress(file.generic_string()) + "\"");
}

Markup pictureOf(const BatchResult& result, const fs::path& folder) {
  std::error_code ignored;
  const fs::path file = batchPicture(result.id);
  if (!hasCase(result) || !fs::exists(folder / file, ignored)) return {};
  Markup image;
  image.html = "<img src=\"" + urlAddress(file.generic_string()) +
               "\" alt=\"\" loading=\"lazy\" width=\"600\" height=\"480\">";
  return element("div", image, "class=\"shot\"");
}

Markup figuresOf(const BatchFigures& f) {
  return text(counted(f.vessels, "vessel", "vessels") + " in " + counted(f.trees, "tree", "trees") +
              " · " + fixedText(f.length, 0) + " mm · radius " + fixedText(f.least, 2) + " to " +
              fixedText(f.greatest, 2) + " mm");
}

Markup cardOf(const BatchResult& result, const fs::path& folder) {
  Markup content = pictureOf(result, folder);
  content += element(
      "h2", hasCase(result) ? link(batchCase(result.id), name(result.id)) : name(result.id));
  content += element("p", name(result.name), "class=\"quiet\"");
  if (result.figures && hasCase(result)) content += element("p", figuresOf(*result.figures));
  if (!result.why.empty()) content += element("p", name(result.why), "class=\"why\"");
  if (!result.at.empty()) content += element("pre", name(viewLine(result)));
  std::error_code ignored;
  if (const fs::path log = batchLog(result.id); fs::exists(folder / log, ignored))
    content += element(
        "p",
        link(log, text(result.warnings == 0
                           ? "log"
                           : counted(result.warnings, "warning", "warnings") + " in the log")),
        "class=\"quiet\"");
  return element("li", content);
}

void writeWhole(const std::string& text, const fs::path& file) {
  const auto done = formats::writeFileAtomically(std::as_bytes(std::span(text)), file);
  if (!done) throw failed(formats::printable(file.string()) + ": " + done.error().message);
}

}  // namespace

std::string batchTable(const std::vector<BatchResult>& results) {
  std::string table =
      "id,input,state,why,vessels,trees,links,length_mm,radius_min_mm,radius_max_mm,warnings,"
      "seconds,view\n";
  for (const BatchResult& r : results) {
    const bool isKnown = r.figures.has_value() && hasCase(r);
    const BatchFigures f = r.figures.value_or(BatchFigures{});
    const auto count = [isKnown](std::size_t n) {
      return isKnown ? std::to_string(n) : std::string();
    };
    table += joinedCells({r.id, r.name, batchWord(r.end), r.why, count(f.vessels), count(f.trees),
                          count(f.links), numberOr(isKnown, f.length, 1),
                          numberOr(isKnown, f.least, 3), numberOr(isKnown, f.greatest, 3),
                          std::to_string(r.warnings), fixedText(r.seconds, 1), viewLine(r)});
  }
  return table;
}

std::string passedList(const std::vector<BatchResult>& results) {
  std::string list = "input,id\n";
  for (const BatchResult& r : results)
    if (r.end == BatchEnd::Passed) list += joinedCells({batchCase(r.id).string(), r.id});
  return list;
}

std::string batchPage(const std::vector<BatchResult>& results, const fs::path& folder) {
  Markup content = element("h1", text(counted(results.size(), "input", "inputs")));
  Markup counts;
  for (const BatchEnd end : kFirstToLookAt)
    if (const std::size_t count = countOf(results, end); count > 0)
      counts += element("a", text(std::to_string(count) + " " + batchWord(end)),
                        "href=\"#end-" + std::to_string(static_cast<int>(end)) + "\"");
  content += element("nav", counts);
  content += element("p", link("cases.csv", text("cases.csv")), "class=\"quiet\"");
  for (const BatchEnd end : kFirstToLookAt) {
    Markup cards;
    for (const BatchResult& result : results)
      if (result.end == end) cards += cardOf(result, folder);
    if (cards.html.empty()) continue;
    const std::string title = std::to_string(countOf(results, end)) + " " + batchWord(end);
    content += section("end-" + std::to_string(static_cast<int>(end)), title,
                       element("ul", cards, "class=\"cards\""));
  }
  PageHead head;
  head.policy = "default-src 'none'; img-src 'self'; style-src 'unsafe-inline'; base-uri 'none'";
  head.title = "Cases of a batch";
  head.links = "<style>" + std::string(batchTexts().front().bytes) + "</style>\n";
  return htmlPage(head, content.html);
}

void writeBatchTables(const std::vector<BatchResult>& results, const fs::path& folder) {
  writeWhole(batchTable(results), folder / "cases.csv");
  writeWhole(passedList(results), folder / "passed.csv");
  writeWhole(batchPage(results, folder), folder / "index.html");
}

}  // namespace lumen::convert
