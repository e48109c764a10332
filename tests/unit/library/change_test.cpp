// SPDX-License-Identifier: Apache-2.0
// Revisions of a library, and cases of one as another.
#include "converters/library/index/change.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/file.h>

#include "converters/base/error.h"
#include "converters/base/sha256.h"
#include "tests/unit/library/made_library.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

class ChangeTest : public testing::Test {
protected:
  ChangeTest() {
    LibraryFile library = madeLibrary();
    makeLibrary(folder(), library);
  }
  [[nodiscard]] fs::path folder() const { return m_files.path("lib"); }
  [[nodiscard]] const TemporaryFolder& files() const { return m_files; }

  /// Puts a case with these files besides case.lumen into the library, and gives what the change left out.
  Names add(const std::string& id, const Names& others = {}) {
    Progress progress;
    IncomingCase incoming(folder());
    incoming.record = madeRecord(id);
    incoming.record.files.clear();
    incoming.add(kCaseFile, "case", "a case");
    for (const std::string& path : others) incoming.add(path, "other", "of " + path);
    LibraryChange change(folder(), progress);
    change.addOrReplace(incoming.record, incoming.folder());
    change.commit("2026-11-22");
    return change.gone();
  }

private:
  TemporaryFolder m_files;
};

}  // namespace

TEST_F(ChangeTest, SignatureAndPagesOfTheOldRevisionAreReportedAsGone) {
  for (const char* name : {"lib/library.json.minisig", "lib/index.html", "lib/site/a.html"})
    files().write(name, "old");
  EXPECT_EQ(add("a"), (Names{"index.html", "library.json.minisig", "site"}));
  EXPECT_FALSE(fs::exists(folder() / "site"));
  EXPECT_TRUE(add("b").empty());
}

TEST_F(ChangeTest, FilesThatANewVersionLacksAreReportedAsGone) {
  add("a", {"note.txt", "report.html"});
  EXPECT_EQ(add("a", {"note.txt"}), (Names{"data/a/report.html"}));
}

TEST_F(ChangeTest, LeftoversOfAKilledWriterDoNotComeAlong) {
  fs::path left;
  {
    const auto pending = formats::PendingFile::beside(folder() / "page.html");
    ASSERT_TRUE(pending);
    left = pending->path().parent_path();
    fs::copy(left, folder() / ".lumen-4711-0000000000", fs::copy_options::recursive);
  }
  files().write("lib/.lumen-4711-0000000001/page.html", "somebody's");
  files().write("lib/.lumenrc", "somebody's");
  add("a");
  EXPECT_FALSE(fs::exists(folder() / ".lumen-4711-0000000000"));
  EXPECT_TRUE(fs::exists(folder() / ".lumen-4711-0000000001/page.html"));
  EXPECT_TRUE(fs::exists(folder() / ".lumenrc"));
}

TEST_F(ChangeTest, ARevisionNamesTheDigestOfTheOneBefore) {
  const std::string before = files().read("lib/library.json");
  add("a");
  EXPECT_EQ(openLibrary(folder()).previous, sha256(before));
}

TEST_F(ChangeTest, ARevisionWhoseListIsLostIsNotFollowed) {
  Progress progress;
  LibraryChange change(folder(), progress);
  fs::remove(folder() / kLibraryFile);
  EXPECT_THROW(change.commit("2026-11-22"), Error);
}

TEST_F(ChangeTest, ReadersShareTheLockAndAChangeWaitsForThem) {
  Progress progress;
  const LibraryLock first(folder(), progress, LibraryLock::Use::Read);
  const LibraryLock second(folder(), progress, LibraryLock::Use::Read);
  const formats::FileDescriptor other = openLibraryFolder(folder());
  EXPECT_NE(::flock(other.get(), LOCK_EX | LOCK_NB), 0);
}

TEST_F(ChangeTest, AnExtractHasItsOwnIdAndNamesItsOrigin) {
  add("a", {"note.txt"});
  add("b");
  Progress progress;
  LibraryFile own = openLibrary(folder());
  own.id = newLibraryId();
  const fs::path target = files().path("extract");
  const LibraryFile made = extractCases(folder(), target, {"a", "a"}, own, progress);
  const LibraryFile read = openLibrary(target);
  EXPECT_EQ(libraryText(read), libraryText(made));
  EXPECT_EQ(read.revision, 1U);
  EXPECT_EQ(read.previous, std::nullopt);
  ASSERT_TRUE(read.origin);
  EXPECT_EQ(read.origin->id, madeLibrary().id);
  EXPECT_EQ(read.origin->revision, 3U);
  EXPECT_EQ(read.origin->sha256, digestOfFile(folder() / kLibraryFile).sha256);
  ASSERT_EQ(read.cases.size(), 1U);
  EXPECT_EQ(files().read("extract/data/a/record.json"), files().read("lib/data/a/record.json"));
  EXPECT_EQ(files().read("extract/data/a/note.txt"), "of note.txt");
}

TEST_F(ChangeTest, AChangeOfAnExtractKeepsItsOrigin) {
  add("a");
  Progress progress;
  const fs::path target = files().path("extract");
  extractCases(folder(), target, {"a"}, openLibrary(folder()), progress);
  LibraryChange change(target, progress);
  change.remove("a");
  change.commit("2026-11-23");
  EXPECT_TRUE(openLibrary(target).origin);
}

TEST_F(ChangeTest, AnAlteredFileIsNotExtracted) {
  add("a", {"note.txt"});
  files().write("lib/data/a/note.txt", "altered");
  Progress progress;
  const fs::path target = files().path("extract");
  EXPECT_THROW(extractCases(folder(), target, {"a"}, openLibrary(folder()), progress), Error);
  EXPECT_FALSE(fs::exists(target));
}

TEST_F(ChangeTest, ACaseThatTheLibraryLacksIsNotExtracted) {
  Progress progress;
  EXPECT_THROW(
      extractCases(folder(), files().path("extract"), {"a"}, openLibrary(folder()), progress),
      Error);
}

}  // namespace lumen::convert
