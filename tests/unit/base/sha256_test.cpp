// SPDX-License-Identifier: Apache-2.0
#include "converters/base/sha256.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "converters/base/error.h"

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
