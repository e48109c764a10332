// SPDX-License-Identifier: Apache-2.0
#include "converters/base/files.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "converters/base/error.h"
#include "converters/base/run_program.h"
#include "converters/base/sha256.h"
#include "formats/case/atomic_file.h"

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
    EXPECT_STREQ(error.what(), "head.png: cannot write this file: No such file or directory");
  }
}

TEST_F(FilesTest, ADiskThatIsFullIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(writeNewFile("a", "/dev/full"), Error);
}

}  // namespace lumen

namespace lumen::test {

namespace fs = std::filesystem;

namespace {

std::string digest(const std::string& text) {
  return sha256(std::as_bytes(std::span(text.data(), text.size())));
}

class FileDigestTest : public testing::Test {
protected:
  void SetUp() override { fs::create_directories(m_folder); }
  void TearDown() override { fs::remove_all(m_folder); }
  [[nodiscard]] fs::path written(const std::string& text) const {
    std::ofstream(m_folder / "file", std::ios::binary) << text;
    return m_folder / "file";
  }
  [[nodiscard]] const fs::path& folder() const { return m_folder; }

private:
  fs::path m_folder =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

}  // namespace

// FIPS 180-4's examples
TEST(Sha256Test, KnownDigests) {
  EXPECT_EQ(digest("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digest(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_F(FileDigestTest, IsThatOfTheBytesWhateverTheirNumber) {
  for (const std::size_t size : {0U, 1U, 262143U, 262144U, 262145U, 1000000U}) {
    std::string text(size, 'a');
    for (std::size_t i = 0; i < size; i += 7) text[i] = static_cast<char>(i);
    const FileDigest found = digestOfFile(written(text));
    EXPECT_EQ(found.bytes, size);
    EXPECT_EQ(found.sha256, digest(text));
  }
}

TEST_F(FileDigestTest, AFullDiscIsTheCauseThatAMessageStates) {
  try {
    writeNewFile(std::string(1 << 20, 'x'), "/dev/full", "scene.py");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "scene.py: cannot write this file: No space left on device");
  }
}

TEST_F(FileDigestTest, MessagesNameThePlaceToWhichAFileOfAnUnfinishedFolderComes) {
  const auto pending =
      formats::PendingFolder::beside(folder() / "scene", formats::PendingFolder::Existing::Refuse);
  ASSERT_TRUE(pending);
  EXPECT_EQ(formats::placeOf(pending->path() / "meshes" / "wall.obj"),
            folder() / "scene" / "meshes" / "wall.obj");
  EXPECT_EQ(formats::placeOf(folder() / "other"), folder() / "other");
  try {
    writeNewFile("x", pending->path() / "none" / "scene.py");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), (folder() / "scene/none/scene.py").string() +
                                             ": cannot write this file: No such file or directory");
  }
}

TEST_F(FileDigestTest, WhatIsNoFileIsRefusedAndNotWaitedFor) {
  const fs::path pipe = folder() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const fs::path& path : {pipe, folder(), folder() / "missing"}) {
    try {
      (void)digestOfFile(path);
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Failed);
      EXPECT_EQ(std::string(error.what()).find(path.string() + ": cannot be read: "), 0U);
    }
  }
}

}  // namespace lumen::test
