// SPDX-License-Identifier: Apache-2.0
// Records between runs: cases that are whole, and revisions that were verified.
#include <thread>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/library/publish/check_journal.h"
#include "converters/library/publish/verify_library.h"
#include "tests/unit/library/made_library.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {

namespace {

const std::string kId = "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4";

}  // namespace

TEST(CheckJournal, KnowsWhatWasAdded) {
  const TemporaryFolder files;
  {
    CheckJournal journal(files.path("j"), kId);
    EXPECT_FALSE(journal.knows("a", madeDigest('1')));
    journal.add("a", madeDigest('1'));
  }
  const CheckJournal journal(files.path("j"), kId);
  EXPECT_TRUE(journal.knows("a", madeDigest('1')));
  EXPECT_FALSE(journal.knows("a", madeDigest('2')));
  EXPECT_FALSE(journal.knows("b", madeDigest('1')));
}

TEST(CheckJournal, CutsOffWhatAKilledCheckLeftOfALine) {
  const TemporaryFolder files;
  {
    CheckJournal journal(files.path("j"), kId);
    journal.add("a", madeDigest('1'));
  }
  const std::string whole = files.read("j");
  files.write("j", whole + madeDigest('2').substr(0, 20));
  { const CheckJournal journal(files.path("j"), kId); }
  EXPECT_EQ(files.read("j"), whole);
}

TEST(CheckJournal, IsBegunAnewForAnotherLibrary) {
  const TemporaryFolder files;
  {
    CheckJournal journal(files.path("j"), kId);
    journal.add("a", madeDigest('1'));
  }
  const CheckJournal journal(files.path("j"), "1" + kId.substr(1));
  EXPECT_FALSE(journal.knows("a", madeDigest('1')));
}

TEST(CheckJournal, LeavesWhatIsNoJournalAsItIs) {
  const TemporaryFolder files;
  files.write("j", "precious");
  EXPECT_THROW(CheckJournal(files.path("j"), kId), Error);
  EXPECT_EQ(files.read("j"), "precious");
}

TEST(CheckJournal, IsOneChecksAtATime) {
  const TemporaryFolder files;
  const CheckJournal journal(files.path("j"), kId);
  EXPECT_THROW(CheckJournal(files.path("j"), kId), Error);
}

TEST(VerifiedRevisions, RemembersForEachLibrary) {
  const TemporaryFolder files;
  const std::filesystem::path file = files.path("new/folder/state.json");
  const std::string other = "1" + kId.substr(1);
  {
    VerifiedRevisions known(file);
    EXPECT_FALSE(known.of(kId));
    known.remember(kId, {7, madeDigest('a')});
    known.remember(other, {1, madeDigest('b')});
  }
  const VerifiedRevisions known(file);
  EXPECT_EQ(known.of(kId)->revision, 7U);
  EXPECT_EQ(known.of(kId)->sha256, madeDigest('a'));
  EXPECT_EQ(known.of(other)->revision, 1U);
}

TEST(VerifiedRevisions, LeavesADamagedFileAsItIs) {
  const TemporaryFolder files;
  for (const std::string& text :
       {std::string(""), std::string("{"), std::string("{\"format\": \"other\"}"),
        "{\"format\": \"lumen-verified-libraries\", \"formatVersion\": 1, \"libraries\": {\"" +
            kId + "\": {\"revision\": 0, \"sha256\": \"" + madeDigest('a') + "\"}}}"}) {
    files.write("state", text);
    EXPECT_THROW(VerifiedRevisions(files.path("state")), Error) << text;
    EXPECT_EQ(files.read("state"), text);
  }
}

TEST(VerifiedRevisions, LosesNothingToAnotherAtTheSameTime) {
  const TemporaryFolder files;
  const auto remember = [&](char digit) {
    for (std::uint64_t i = 1; i <= 20; ++i)
      VerifiedRevisions(files.path("state")).remember(digit + kId.substr(1), {i, madeDigest('a')});
  };
  std::thread one(remember, '1'), two(remember, '2');
  one.join();
  two.join();
  const VerifiedRevisions known(files.path("state"));
  for (const char digit : {'1', '2'}) {
    const auto revision = known.of(digit + kId.substr(1));
    ASSERT_TRUE(revision);
    EXPECT_EQ(revision->revision, 20U);
  }
}

}  // namespace lumen::convert
