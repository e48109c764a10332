// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/plain_folder.h"

#include <set>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "converters/base/error.h"
#include "converters/library/publish/check_case.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {

namespace {

PlainRead readOf(const TemporaryFolder& files, const std::string& path,
                 const WantedRead& wanted = {{}, true}) {
  return PlainFolder(files.path()).read(path, wanted, {});
}

}  // namespace

TEST(PlainFolder, ReadsAFileWithItsDigest) {
  const TemporaryFolder files;
  files.write("a/b", "abc");
  const PlainRead read = readOf(files, "a/b");
  EXPECT_TRUE(read.isRead);
  EXPECT_EQ(read.content, "abc");
  // FIPS 180-2, B.1
  EXPECT_EQ(read.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(PlainFolder, DoesNotReadAFileOfAnotherSize) {
  const TemporaryFolder files;
  files.write("a", "abc");
  const PlainRead read = readOf(files, "a", {4, true});
  EXPECT_FALSE(read.isRead);
  EXPECT_EQ(read.bytes, 3U);
  EXPECT_EQ(read.content, "");
  EXPECT_FALSE(readOf(files, "a", {{}, true, 2}).isRead);
  EXPECT_TRUE(readOf(files, "a", {{}, true, 3}).isRead);
}

TEST(PlainFolder, FollowsNoLinkAndWaitsForNoPipe) {
  const TemporaryFolder files;
  files.write("folder/file", "abc");
  std::filesystem::create_symlink("folder/file", files.path("link"));
  std::filesystem::create_symlink("folder", files.path("linked"));
  ASSERT_EQ(mkfifo(files.path("pipe").c_str(), 0600), 0);
  for (const auto& [path, found] :
       {std::pair("link", "a symbolic link"), std::pair("linked/file", "a symbolic link"),
        std::pair("pipe", "a named pipe"), std::pair("folder", "a folder"),
        std::pair("folder/file/more", "a file")}) {
    EXPECT_EQ(readOf(files, path).fault, PlainFault::Kind) << path;
    EXPECT_EQ(readOf(files, path).found, found) << path;
  }
  EXPECT_EQ(readOf(files, "folder/other").fault, PlainFault::Missing);
  EXPECT_EQ(readOf(files, "other/file").fault, PlainFault::Missing);
}

TEST(PlainFolder, RefusesWhatIsNoFolder) {
  const TemporaryFolder files;
  files.write("file", "");
  EXPECT_THROW(PlainFolder(files.path("file")), Error);
  EXPECT_THROW(PlainFolder(files.path("nothing")), Error);
}

TEST(CaseFolder, TellsWhatNothingExpectsInTheOrderOfNames) {
  const TemporaryFolder files;
  for (const char* const name :
       {"case/known", "case/below/known", "case/z", "case/below/b", "case/a/deep"})
    files.write(name, "");
  ExpectedFiles expected;
  expected.add("known");
  expected.add("below/known");
  const FolderState state = walkFolder(PlainFolder(files.path()), "case", expected, "id", 10);
  ASSERT_EQ(state.faults.kept().size(), 3U);
  EXPECT_EQ(state.faults.kept()[0].path, "case/a");
  EXPECT_EQ(state.faults.kept()[1].path, "case/z");
  EXPECT_EQ(state.faults.kept()[2].path, "case/below/b");
}

TEST(CaseFolder, MarksChangeWithBytesAndNames) {
  const TemporaryFolder files;
  files.write("case/known", "abc");
  ExpectedFiles expected;
  expected.add("known");
  const auto mark = [&] {
    return walkFolder(PlainFolder(files.path()), "case", expected, "id", 10).mark;
  };
  const std::string before = mark();
  EXPECT_EQ(mark(), before);
  const auto time = std::filesystem::last_write_time(files.path("case/known"));
  files.write("case/known", "abd");
  // who changes a file can set its time back, but not that of the change of its status
  std::filesystem::last_write_time(files.path("case/known"), time);
  EXPECT_NE(mark(), before);
}

TEST(CaseFolder, IsNotSettledWhileAChangeWouldGetTheSameTime) {
  const TemporaryFolder files;
  files.write("case/known", "abc");
  EXPECT_FALSE(walkFolder(PlainFolder(files.path()), "case", {}, "id", 10).isSettled);
}

}  // namespace lumen::convert
