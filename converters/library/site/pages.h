// SPDX-License-Identifier: Apache-2.0
// Pages of a library's site, and their parts. Private to the sources of this folder and their tests.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "converters/base/embedded_text.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"

namespace lumen::convert {

/// Cases on one page, which a phone loads in a second; 10,000 cases take 209 pages.
inline constexpr std::size_t kCasesPerPage = 48;

/// The style sheet and the scripts, which are built into the program: files of those names beside
/// this.
std::span<const EmbeddedText> siteFiles();
/// A part of a page: the file of this name beside this, with these values.
std::string sitePart(std::string_view name, std::initializer_list<TextValue> values);

/// Frame around the content of a page.
struct PageFrame {
  std::string title;                 ///< any text
  std::string root;                  ///< path from the page to the library's folder: "" or "../../"
  std::vector<const char*> scripts;  ///< names in site/, in this order
  std::string data;                  ///< attributes of the body, ready: " data-page=\"1\""
};

/// A whole page, with the end that all have. It asks for nothing but files of the library, and runs
/// no script and no style that is in itself. `signature`: the file's name, empty if there is none.
std::string pageText(const PageFrame& frame, const std::string& content, const LibraryFile& library,
                     const std::string& signature);

/// site/case/ID.html. `signature`: as for pageText().
std::string casePage(const LibraryFile& library, const CaseRecord& record,
                     const std::string& signature);

/// Indices of the library's cases as the gallery lists them: by title, in which numbers count as
/// numbers and small letters as capitals, then by id.
std::vector<std::size_t> galleryOrder(const LibraryFile& library);
/// Path of page 1, 2, ... in the folder of the library: index.html is the first.
std::string galleryPath(std::size_t page);
/// One case as an item of the list. `root`: as in PageFrame.
std::string galleryCard(const CaseRecord& record, const std::string& root);
/// A page of the gallery, complete without a script. `cards`: the items of its list.
std::string galleryPage(const LibraryFile& library, std::size_t page, const std::string& cards,
                        const std::string& signature);
/// A case as an item of the array in site/cases.js: the values that gallery.js searches, counts and
/// draws.
std::string searchRow(const CaseRecord& record);

struct CasePictures {
  std::string first;                ///< path in the folder of the case; empty without pictures
  std::string thumbnail;            ///< thumbnail.png, or the first
  std::vector<std::string> frames;  ///< pictures of a turntable, in order; empty without one
  std::vector<std::string> others;  ///< all that are neither
};

/// Pictures from files of the role picture that a browser draws (PNG, JPEG, WebP). The first is
/// picture.png, or by path the first that is no frame. A turntable is three or more files that
/// differ in three digits at the end, as `lumen picture --turntable` and `lumen library add
/// --turntable` name them.
CasePictures casePictures(const CaseRecord& record);

/// One sentence after another: credit, title, version, library, revision, publisher, year, licence,
/// address.
std::string citationText(const LibraryFile& library, const CaseRecord& record);
/// The citation as an entry for BibTeX and biber, in UTF-8, ending in a newline.
std::string citationBibTex(const LibraryFile& library, const CaseRecord& record);
/// Any text as the value of a field in braces: characters that TeX and BibTeX would read as more
/// than a letter are spelt as commands, and braces stay in pairs.
std::string bibTexText(std::string_view text);

std::string kindOfCase(const CaseAbout& about);    ///< HTML: anatomy, side and source
std::string tagsOfCase(const CaseRecord& record);  ///< HTML: aneurysm, synthetic, licence
std::string doiLink(const std::string& doi);  ///< HTML: link to a DOI's page; empty without one
/// A block of text to copy, with a name for the button that a script adds.
std::string copyable(const std::string& name, const std::string& text);
std::string dataPath(const CaseRecord& record, const std::string& path);  ///< "data/ID/PATH"
std::string casePagePath(const std::string& id);                          ///< "site/case/ID.html"

}  // namespace lumen::convert
