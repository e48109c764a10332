// SPDX-License-Identifier: Apache-2.0
// The pages of a library: what they hold, what they leave alone, what they refuse.
#include "converters/library/site/site.h"

#include <cstdint>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/sha256.h"
#include "converters/library/site/pages.h"
#include "tests/unit/library/made_library.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

/// A folder with library.json and records, which goes with the test.
class SiteTest : public testing::Test {
protected:
  void library(const std::vector<CaseRecord>& records) {
    LibraryFile file;
    file.id = "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4";
    file.title = "Siphons";
    file.licence = "CC-BY-4.0";
    file.date = "2026-11-22";
    file.generator = "lumen 0.1.0";
    for (const CaseRecord& record : records) {
      const std::string text = recordText(record);
      m_files.write("data/" + record.id + "/record.json", text);
      file.cases.push_back({record.id, record.version, record.about.title, text.size(),
                            sha256(text), record.files.size(), 0});
    }
    m_files.write("library.json", libraryText(file));
  }
  SiteReport write() {
    Progress silent;
    return writeSite(m_folder, silent);
  }
  /// The message of the error that writing ends with, if it is of this kind.
  std::string refusal(ErrorKind kind) {
    try {
      write();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
  }
  [[nodiscard]] std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(m_folder))
      if (entry.is_regular_file()) all[name(entry.path())] = m_files.read(name(entry.path()));
    return all;
  }
  TemporaryFolder m_files;
  fs::path m_folder = m_files.path();

private:
  [[nodiscard]] std::string name(const fs::path& file) const {
    return fs::relative(file, m_folder).string();
  }
};

}  // namespace

TEST_F(SiteTest, WritesAPageForEachCaseAndChangesNothingElse) {
  library({madeRecord("a"), madeRecord("b")});
  m_files.write("library.json.minisig", "a signature");
  const auto before = files();
  const SiteReport report = write();
  EXPECT_EQ(report.cases, 2U);
  EXPECT_EQ(report.pages, 3U);
  auto after = files();
  std::uint64_t bytes = 0;
  for (const auto& [name, text] : after)
    if (!before.contains(name)) {
      EXPECT_TRUE(name == "index.html" || name.starts_with("site/")) << name;
      bytes += text.size();
    }
  EXPECT_EQ(report.bytes, bytes);
  for (const auto& [name, text] : before) EXPECT_EQ(after[name], text) << name;
  EXPECT_TRUE(after.contains("site/case/a.html"));
  EXPECT_NE(after["index.html"].find("library.json.minisig"), std::string::npos);
}

TEST_F(SiteTest, EqualLibrariesGiveEqualBytesAndPagesOfRemovedCasesGo) {
  library({madeRecord("a"), madeRecord("b")});
  write();
  const auto first = files();
  write();
  EXPECT_EQ(files(), first);
  library({madeRecord("b")});
  write();
  EXPECT_FALSE(fs::exists(m_folder / "site/case/a.html"));
  EXPECT_TRUE(fs::exists(m_folder / "site/case/b.html"));
}

TEST_F(SiteTest, AGalleryOfManyPagesListsEveryCaseOnce) {
  std::vector<CaseRecord> records;
  for (std::size_t i = 0; i < 2 * kCasesPerPage + 1; ++i)
    records.push_back(madeRecord(std::string("c").append(std::to_string(1000 + i))));
  library(records);
  EXPECT_EQ(write().pages, records.size() + 3);
  const std::string all = m_files.read("index.html") + m_files.read("site/page/2.html") +
                          m_files.read("site/page/3.html");
  for (const CaseRecord& record : records) {
    const std::string link = casePagePath(record.id) + "\"";
    const std::size_t at = all.find(link);
    ASSERT_NE(at, std::string::npos) << link;
    EXPECT_EQ(all.find(link, at + 1), std::string::npos) << link;
  }
}

TEST_F(SiteTest, ALibraryWithoutCasesHasAnEmptyGallery) {
  library({});
  EXPECT_EQ(write().pages, 1U);
  EXPECT_NE(m_files.read("index.html").find(">0 cases<"), std::string::npos);
}

TEST_F(SiteTest, ARecordThatLibraryJsonDoesNotStateIsRefusedAndTheOldPagesStay) {
  library({madeRecord("a")});
  write();
  const std::string before = m_files.read("site/case/a.html");
  std::string text = m_files.read("data/a/record.json");
  text[text.find("Left")] = 'l';
  m_files.write("data/a/record.json", text);
  EXPECT_NE(refusal(ErrorKind::InvalidInput).find("data/a/record.json"), std::string::npos);
  EXPECT_EQ(m_files.read("site/case/a.html"), before);
  for (const auto& entry : fs::directory_iterator(m_folder))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".lumen-")) << entry.path();
}

TEST_F(SiteTest, WhatSomebodyElseMadeIsNotReplacedAndLinksAreNotFollowed) {
  library({madeRecord("a")});
  m_files.write("index.html", "<h1>My own page</h1>");
  EXPECT_NE(refusal(ErrorKind::Usage).find("index.html: found something"), std::string::npos);
  fs::remove(m_folder / "index.html");
  m_files.write("elsewhere.txt", "<script src=\"site/gallery.js\"");
  fs::create_symlink("elsewhere.txt", m_folder / "index.html");
  refusal(ErrorKind::Usage);
  EXPECT_EQ(m_files.read("elsewhere.txt"), "<script src=\"site/gallery.js\"");
  fs::remove(m_folder / "index.html");
  m_files.write("site/mine.html", "mine");
  refusal(ErrorKind::Usage);
  EXPECT_EQ(m_files.read("site/mine.html"), "mine");
  fs::remove_all(m_folder / "site");
  fs::create_directory_symlink("data", m_folder / "site");
  refusal(ErrorKind::Usage);
  EXPECT_TRUE(fs::exists(m_folder / "data/a/record.json"));
}

TEST(SiteTextsTest, ADoiLinksToItsPage) {
  EXPECT_EQ(doiLink(""), "");
  EXPECT_NE(doiLink("10.1/a\"b").find("href=\"https://doi.org/10.1/a%22b\""), std::string::npos);
}

TEST(SiteGalleryTest, TitlesAreInTheOrderThatPeopleExpect) {
  LibraryFile library;
  const std::vector<std::string> titles = {"siphon 10", "Aorta", "Siphon 9", "siphon 010",
                                           "siphon"};
  for (std::size_t i = 0; i < titles.size(); ++i)
    library.cases.push_back(
        {std::string("id").append(std::to_string(i)), 1, titles[i], 0, "", 0, 0});
  EXPECT_EQ(galleryOrder(library), (std::vector<std::size_t>{1, 4, 2, 0, 3}));
}

TEST(SitePicturesTest, TurntablesAreToldFromOtherPictures) {
  CaseRecord record;
  for (const char* const path :
       {"left.png", "picture.png", "turn-000.png", "turn-001.png", "turn-002.png", "view-001.png"})
    record.files.push_back({path, "picture", "", "image/png", 1, ""});
  record.files.push_back({"a.svg", "picture", "", "image/svg+xml", 1, ""});  // could hold a script
  const CasePictures pictures = casePictures(record);
  EXPECT_EQ(pictures.first, "picture.png");
  EXPECT_EQ(pictures.frames,
            (std::vector<std::string>{"turn-000.png", "turn-001.png", "turn-002.png"}));
  EXPECT_EQ(pictures.others, (std::vector<std::string>{"left.png", "view-001.png"}));
  EXPECT_EQ(pictures.thumbnail, "picture.png");
}

TEST(SitePicturesTest, WhatLibraryAddMakesHasItsPlaces) {
  CaseRecord record;
  for (const char* const path : {"picture-anterior.png", "picture-left.png", "thumbnail.png",
                                 "turntable/000.png", "turntable/001.png", "turntable/002.png"})
    record.files.push_back({path, "picture", "", "image/png", 1, ""});
  const CasePictures pictures = casePictures(record);
  EXPECT_EQ(pictures.first, "picture-anterior.png");
  EXPECT_EQ(pictures.thumbnail, "thumbnail.png");
  EXPECT_EQ(pictures.frames, (std::vector<std::string>{"turntable/000.png", "turntable/001.png",
                                                       "turntable/002.png"}));
  EXPECT_EQ(pictures.others, (std::vector<std::string>{"picture-left.png"}));
  record.files = {{"thumbnail.png", "picture", "", "image/png", 1, ""}};
  EXPECT_EQ(casePictures(record).first, "thumbnail.png");
}

TEST(SiteCitationTest, NamesCaseVersionLibraryAndAddress) {
  LibraryFile library;
  library.title = "Siphons & more";
  library.publisher = "A clinic";
  library.revision = 7;
  library.id = "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4";
  const CaseRecord record = madeRecord("a");
  EXPECT_EQ(citationText(library, record),
            "Somebody. Left carotid siphon (version 2). In: Siphons & more, revision 7. A clinic, "
            "2026. CC-BY-4.0. "
            "https://doi.org/10.5281/zenodo.1234");
  EXPECT_EQ(citationBibTex(library, record),
            "@misc{a-v2,\n  author = {{Somebody}},\n  title = {{Left carotid siphon}},\n  year = "
            "{2026},\n"
            "  howpublished = {In: {Siphons \\& more}, revision 7},\n  publisher = {{A clinic}},\n"
            "  doi = {10.5281/zenodo.1234},\n"
            "  note = {Version 2. Licence: CC-BY-4.0. "
            "urn:uuid:0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4}\n}\n");
  EXPECT_EQ(bibTexText("{\\x}%"), "\\textbraceleft{}\\textbackslash{}x\\textbraceright{}\\%");
}

}  // namespace lumen::convert
