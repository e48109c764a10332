// SPDX-License-Identifier: Apache-2.0
#include "converters/library/site/site.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/library/change.h"
#include "converters/library/library_lock.h"
#include "converters/library/record.h"
#include "converters/library/site/pages.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;

std::string shown(const fs::path& path) {
  return formats::printable(path.string());
}

Error notOurs(const fs::path& place) {
  return {ErrorKind::Usage, shown(place) +
                                ": found something that lumen library index did not make, expected "
                                "its own or nothing; move it away first"};
}

/// Refuses to replace a folder that is not of an earlier run: nobody's own page is lost, and
/// nothing is written to where a link leads.
void requireOwnFolder(const fs::path& place) {
  std::error_code error;
  const fs::file_status there = fs::symlink_status(place, error);
  if (!fs::exists(there)) return;
  if (!fs::is_directory(there)) throw notOurs(place);
  if (!fs::is_empty(place, error) && !fs::exists(place / "gallery.js", error)) throw notOurs(place);
}

void requireOwnPage(const fs::path& place) {
  std::error_code error;
  const fs::file_status there = fs::symlink_status(place, error);
  if (!fs::exists(there)) return;
  if (!fs::is_regular_file(there)) throw notOurs(place);
  const std::string text = readWholeFile(place, "page");
  if (text.find("<script src=\"site/gallery.js\"") == std::string_view::npos) throw notOurs(place);
}

std::string signatureIn(const fs::path& folder) {
  for (const char* const name : {"library.json.minisig", "library.json.sig"})
    if (std::error_code error; fs::is_regular_file(folder / name, error)) return name;
  return {};
}

/// Calls that put site/ in its place. Its files are flushed to disk together, by flushFolder(): one
/// at a time 10,000 of them take a minute, most of it waiting.
const formats::FileCalls& placingCalls() {
  static const formats::FileCalls calls = [] {
    formats::FileCalls all = formats::systemCalls();
    all.flush = [](int) { return 0; };
    return all;
  }();
  return calls;
}

/// Writes files into the folder that is to become site/, and counts them.
class SiteWriter {
public:
  SiteWriter(fs::path folder, SiteReport& report)
      : m_folder(std::move(folder)), m_cases(m_folder / "cases.js"), m_report(report) {
    fs::create_directory(m_folder / "case");
    fs::create_directory(m_folder / "page");
    addCases("\"use strict\";\nglobalThis.lumenCases = [\n");
  }
  /// `path`: as from the folder of the library.
  void addPage(const std::string& path, std::string_view text) {
    constexpr std::string_view kSite = "site/";
    ++m_report.pages;
    add(path.substr(kSite.size()), text);
  }
  void add(const std::string& name, std::string_view text) {
    writeNewFile(text, m_folder / name);
    m_report.bytes += text.size();
  }
  void addCases(std::string_view text) {
    m_cases.add(text);
    m_report.bytes += text.size();
  }
  void endCases() {
    addCases("];\n");
    m_cases.close();
  }

private:
  fs::path m_folder;
  NewFile m_cases;
  SiteReport& m_report;
};

/// All pages but the first, which is given.
std::string writePages(const fs::path& folder, const LibraryFile& library, SiteWriter& writer,
                       Progress& progress) {
  const std::string signature = signatureIn(folder);
  const std::vector<std::size_t> order = galleryOrder(library);
  std::string first, cards;
  std::size_t page = 1;
  const auto endPage = [&] {
    const std::string html = galleryPage(library, page, cards, signature);
    if (page == 1)
      first = html;
    else
      writer.addPage(galleryPath(page), html);
    cards.clear();
    ++page;
  };
  progress.begin("pages", order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    progress.check();
    const CaseRecord record = openRecord(folder, library.cases[order[i]]);
    writer.addPage(casePagePath(record.id), casePage(library, record, signature));
    writer.addCases(searchRow(record) + ",\n");
    cards += galleryCard(record, page == 1 ? "" : "../../");
    if ((i + 1) % kCasesPerPage == 0) endPage();
    progress.advance();
  }
  progress.end();
  if (!cards.empty() || page == 1) endPage();
  return first;
}

}  // namespace

SiteReport writeSite(const fs::path& folder, Progress& progress) {
  const LibraryLock lock(folder, progress);
  const LibraryFile library = openLibrary(folder);
  requireOwnFolder(folder / "site");
  requireOwnPage(folder / "index.html");
  SiteReport report;
  report.cases = library.cases.size();
  auto site = formats::PendingFolder::beside(
      folder / "site", formats::PendingFolder::Existing::Replace, placingCalls());
  if (!site) throw failed(site.error().message);
  SiteWriter writer(site->path(), report);
  for (const EmbeddedText& file : siteFiles()) writer.add(std::string(file.name), file.bytes);
  const std::string first = writePages(folder, library, writer, progress);
  writer.endCases();
  flushFolder(site->path());
  if (const auto done = site->commit(); !done) throw failed(done.error().message);
  const auto done = formats::writeFileAtomically(
      std::as_bytes(std::span(first.data(), first.size())), folder / "index.html");
  if (!done) throw failed(done.error().message);
  ++report.pages;
  report.bytes += first.size();
  return report;
}

}  // namespace lumen::convert
