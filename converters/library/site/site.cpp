// SPDX-License-Identifier: Apache-2.0
#include "converters/library/site/site.h"

#include <span>
#include <string>
#include <string_view>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/library/index/change.h"
#include "converters/library/index/library_lock.h"
#include "converters/library/index/record.h"
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
  for (const char* const name : {kMinisignSignatureFile, kOpenSshSignatureFile})
    if (std::error_code error; fs::is_regular_file(folder / name, error)) return name;
  return {};
}

/// Writes files into the folder that is to become site/, and counts them.
class SiteWriter {
public:
  SiteWriter(fs::path folder, SiteReport& report) : m_folder(std::move(folder)), m_report(report) {
    fs::create_directory(m_folder / "case");
    fs::create_directory(m_folder / "page");
  }
  /// `path`: as from the folder of the library.
  void addPage(const std::string& path, std::string_view text) {
    constexpr std::string_view kSite = "site/";
    ++m_report.pages;
    add(path.substr(kSite.size()), text);
  }
  void add(std::string_view name, std::string_view text) {
    writeNewFile(text, m_folder / name);
    m_report.bytes += text.size();
  }

private:
  fs::path m_folder;
  SiteReport& m_report;
};

/// All pages but the first, which is given.
std::string writePages(const fs::path& folder, const LibraryFile& library, SiteWriter& writer,
                       Progress& progress) {
  const std::string signature = signatureIn(folder);
  const std::vector<std::size_t> order = galleryOrder(library);
  std::string first, cards, list = "\"use strict\";\nglobalThis.lumenCases = [\n";
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
    list += searchRow(record) + ",\n";
    cards += galleryCard(record, page == 1 ? "" : "../../");
    if ((i + 1) % kCasesPerPage == 0) endPage();
    progress.advance();
  }
  progress.end();
  writer.add("cases.js", list + "];\n");
  if (!cards.empty() || page == 1) endPage();
  return first;
}

}  // namespace

SiteReport writeSite(const fs::path& folder, Progress& progress) {
  const LibraryLock lock(folder, progress);
  const LibraryFile library = openLibrary(folder);
  requireOwnFolder(folder / kSiteFolder);
  requireOwnPage(folder / kFirstPage);
  SiteReport report;
  report.cases = library.cases.size();
  formats::PendingFolder site =
      pendingFolder(folder / kSiteFolder, formats::PendingFolder::Existing::Replace);
  SiteWriter writer(site.path(), report);
  for (const EmbeddedText& file : siteFiles()) writer.add(file.name, file.bytes);
  const std::string first = writePages(folder, library, writer, progress);
  commitFolder(site);
  const auto done =
      formats::writeFileAtomically(std::as_bytes(std::span(first)), folder / kFirstPage);
  if (!done) throw failed(done.error().message);
  ++report.pages;
  report.bytes += first.size();
  return report;
}

}  // namespace lumen::convert
