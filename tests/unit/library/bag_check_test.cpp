// SPDX-License-Identifier: Apache-2.0
// The files of the bag, each altered by itself.
#include "converters/library/bag_check.h"

#include <span>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/sha256.h"
#include "converters/library/derived.h"
#include "tests/unit/library/made_library.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {
namespace {

const std::string kRootCrate = std::string(kPayload) + "/" + kCrateFile;

/// A library in a folder, as far as its bag is concerned.
class BagOfLibrary : public testing::TestWithParam<std::string> {
protected:
  void SetUp() override {
    std::string manifest, crate;
    LibraryTexts maker(
        m_library, [&](std::string_view piece) { manifest += piece; },
        [&](std::string_view piece) { crate += piece; });
    for (const LibraryEntry& entry : m_library.cases) {
      const CaseRecord record = madeRecord(entry.id);
      maker.add(record, caseCrate(record));
    }
    const TagTexts tags = maker.finish();
    m_files.write(kRootCrate, crate);
    m_files.write(kManifestFile, manifest);
    m_files.write(kBagFile, tags.bag);
    m_files.write(kBagInfoFile, tags.bagInfo);
    m_files.write(kTagManifestFile, tags.tagManifest);
  }

  /// The paths of the faults, of which each is one of the bag or of the crate.
  [[nodiscard]] std::vector<std::string> faultyPaths() const {
    const Progress progress;
    const PlainFolder folder(m_files.path());
    const std::string text = libraryText(m_library);
    BagCheck check(folder, m_library, text, progress);
    for (const LibraryEntry& entry : m_library.cases) {
      const CaseRecord record = madeRecord(entry.id);
      check.add(entry, {FaultList(8), record, caseCrate(record), false, "", 0, 0});
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

}  // namespace
}  // namespace lumen::convert
