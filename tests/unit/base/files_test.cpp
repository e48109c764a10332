// SPDX-License-Identifier: Apache-2.0
#include "converters/base/files.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "converters/base/error.h"
#include "converters/base/run_program.h"

namespace lumen {

namespace fs = std::filesystem;

namespace {

class FilesTest : public testing::Test {
protected:
  [[nodiscard]] fs::path path(const std::string& name) const { return m_folder.path() / name; }
  static std::string refusal(const fs::path& file, std::uint64_t most = kAnySize) {
    try {
      readWholeFile(file, "list", most);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
      return error.what();
    }
    ADD_FAILURE() << "not refused: " << file;
    return {};
  }

private:
  convert::PrivateFolder m_folder;
};

}  // namespace

TEST_F(FilesTest, AWholeFileIsReadAsItWasWritten) {
  const std::string bytes("a\0\r\n\xff", 5);
  writeNewFile(bytes, path("a"));
  EXPECT_EQ(readWholeFile(path("a"), "list"), bytes);
  EXPECT_EQ(readWholeFile(path("a"), "list", 5), bytes);
}

TEST_F(FilesTest, AnEmptyFileIsAnEmptyText) {
  writeNewFile("", path("a"));
  EXPECT_EQ(readWholeFile(path("a"), "list"), "");
}

TEST_F(FilesTest, AMissingFileIsRefusedByItsRole) {
  EXPECT_EQ(refusal(path("gone")), path("gone").string() + ": there is no such list");
}

TEST_F(FilesTest, AFileOverTheLimitIsRefusedWithBothSizes) {
  writeNewFile("abcd", path("a"));
  EXPECT_EQ(refusal(path("a"), 3),
            path("a").string() + ": has 4 bytes; expected at most 3 bytes for a list");
}

TEST_F(FilesTest, AFolderIsNotRead) {
  EXPECT_NE(refusal(path("")).find("found a folder, expected a file"), std::string::npos);
}

TEST_F(FilesTest, APipeIsNotWaitedFor) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_NE(refusal(path("pipe")).find("found a device or a pipe"), std::string::npos);
}

TEST_F(FilesTest, AFileThatCannotBeMadeIsAnError) {
  EXPECT_THROW(writeNewFile("a", path("no/folder")), Error);
}

TEST_F(FilesTest, AFileThatCannotBeMadeIsNamedByItsTarget) {
  try {
    writeNewFile("a", path("no/hidden"), "head.png");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "head.png: cannot write this file");
  }
}

TEST_F(FilesTest, ADiskThatIsFullIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(writeNewFile("a", "/dev/full"), Error);
}

}  // namespace lumen
