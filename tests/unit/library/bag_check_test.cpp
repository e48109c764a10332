// SPDX-License-Identifier: Apache-2.0
// The files of the bag, each altered by itself.
#include "converters/library/publish/bag_check.h"

#include <string>

#include <gtest/gtest.h>

#include "converters/base/sha256.h"
#include "converters/library/index/derived.h"
#include "tests/unit/library/made_library.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {
namespace {

/// A library in a folder, as far as its bag is concerned.
class BagOfLibrary : public testing::TestWithParam<std::string> {
protected:
  void SetUp() override {
    LibraryTexts maker(m_library);
    for (const LibraryEntry& entry : m_library.cases) {
      const CaseRecord record = madeRecord(entry.id);
      maker.add(entry, record, caseCrate(record));
    }
    const RevisionTexts tags = maker.finish();
    m_files.write(kRootCrate, tags.crate);
    m_files.write(kManifestFile, tags.manifest);
    m_files.write(kBagFile, tags.bag);
    m_files.write(kBagInfoFile, tags.bagInfo);
    m_files.write(kTagManifestFile, tags.tagManifest);
  }

  /// The paths of the faults, of which each is one of the bag or of the crate; the record of the
  /// case `missing` is not there.
  [[nodiscard]] std::vector<std::string> faultyPaths(const std::string& missing = "") const {
    const Progress progress;
    const PlainFolder folder(m_files.path());
    const std::string text = libraryText(m_library);
    BagCheck check(folder, m_library, text, progress);
    for (const LibraryEntry& entry : m_library.cases) {
      const CaseRecord record = madeRecord(entry.id);
      CaseCheck one{FaultList(8), record, caseCrate(record), false, "", 0, 0};
      if (entry.id == missing) one.record.reset();
      check.add(entry, one);
    }
    FaultList faults(8);
    check.finish(faults);
    std::vector<std::string> paths;
    for (const LibraryFault& fault : faults.kept()) {
      EXPECT_EQ(fault.code, fault.path == kRootCrate ? FaultCode::Crate : FaultCode::Bag);
      paths.push_back(fault.path);
    }
    return paths;
  }

  LibraryFile m_library = madeLibrary();
  TemporaryFolder m_files;
};

TEST_F(BagOfLibrary, AsItWasWrittenHasNoFault) {
  EXPECT_TRUE(faultyPaths().empty());
}

TEST_F(BagOfLibrary, LinesOfACaseWithoutItsRecordAreUnknownAndAllOthersAreNot) {
  EXPECT_TRUE(faultyPaths("siphon-01").empty());
  m_files.write(kManifestFile, m_files.read(kManifestFile) + "more\n");
  EXPECT_EQ(faultyPaths("siphon-01"), std::vector<std::string>{kManifestFile});
}

TEST_P(BagOfLibrary, AFileWithOneOtherByteIsAFault) {
  std::string text = m_files.read(GetParam());
  text[text.size() / 2] ^= 1;
  m_files.write(GetParam(), text);
  EXPECT_EQ(faultyPaths(), std::vector<std::string>{GetParam()});
}

TEST_P(BagOfLibrary, AFileWithOneByteMoreIsAFault) {
  m_files.write(GetParam(), m_files.read(GetParam()) + "\n");
  EXPECT_EQ(faultyPaths(), std::vector<std::string>{GetParam()});
}

TEST_P(BagOfLibrary, AMissingFileIsAFault) {
  std::filesystem::remove(m_files.path(GetParam()));
  EXPECT_EQ(faultyPaths(), std::vector<std::string>{GetParam()});
}

INSTANTIATE_TEST_SUITE_P(Files, BagOfLibrary,
                         testing::Values(kBagFile, kBagInfoFile, kManifestFile, kTagManifestFile,
                                         kRootCrate));

std::string comparison(std::string_view found, std::string_view expected) {
  const auto other = firstDifference(found, expected);
  return other ? other->first : "";
}

TEST(FirstDifference, IsTheFirstOtherLine) {
  EXPECT_EQ(comparison("a\nb\n", "a\nb\n"), "");
  EXPECT_EQ(comparison("a\nx\n", "a\nb\n"), "line 2 \"x\"");
  EXPECT_EQ(comparison("a\n", "a\nb\n"), "nothing from line 2 on");
  EXPECT_EQ(comparison("a\nb\nc\n", "a\nb\n"), "line 3 \"c\"");
  EXPECT_EQ(comparison("a\nb", "a\nb\n"), "line 2 \"b (and no line end)\"");
  EXPECT_EQ(comparison("", "a\n"), "nothing from line 1 on");
}

TEST(FirstDifference, PassesOverTheLinesOfOneCase) {
  const std::string found = "0  data/a/file\n1  data/b/file\n2  data/b/x/y\n3  data/c\n";
  EXPECT_FALSE(firstDifference(found, "0  data/a/file\n", {"data/b/", "data/c"}));
  EXPECT_TRUE(firstDifference(found, "0  data/a/file\n", {"data/b/"}));
}

}  // namespace
}  // namespace lumen::convert
