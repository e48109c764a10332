// SPDX-License-Identifier: Apache-2.0
// Pages of a tube with models and of one without, beside its volume and alone.
#include "converters/operations/report_of.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/sha256.h"
#include "converters/operations/case_of.h"
#include "converters/stages/phantom/phantom.h"
#include "formats/case/case_encoding.h"

namespace lumen::operations {
namespace {

class ReportWarnings : public Progress {
public:
  void warn(std::string_view message) override { said.emplace_back(message); }
  std::vector<std::string> said;
};

const convert::Phantom& reportedTube() {
  static const convert::Phantom tube = [] {
    convert::PhantomOptions options;
    options.name = "tube";
    options.size = 64;
    Progress silent;
    return convert::makePhantom(options, silent);
  }();
  return tube;
}

class ReportOfTest : public testing::Test {
protected:
  /// The page of the tube's true tree, which has no models, under `name` and `title`.
  Page treePage(const std::string& name, const std::string& title = "") {
    const std::vector<std::byte> file = formats::encodeBinary(m_tree);
    return reportOf({m_tree, file, name, title}, m_volume, m_context);
  }
  void addVolume() {
    m_volume = ReportedVolume{
        reportedTube().volume, "tube.nrrd", {}, CheckNames{"in/tree.lumen", "tube.nrrd", "both"}};
  }
  /// The first sentence of the page that has these words; empty if there is none.
  static std::string sentenceWith(const std::string& words, const Page& page) {
    for (const std::string& sentence : page.facts.otherWarnings)
      if (sentence.find(words) != std::string::npos) return sentence;
    return "";
  }

  formats::Case m_tree = reportedTube().truth;
  std::optional<ReportedVolume> m_volume;
  ReportWarnings m_warnings;
  Context m_context{m_warnings};
};

TEST_F(ReportOfTest, ACaseWithItsVolumeHasAllPartsOfThePage) {
  CaseOptions options;
  options.vessels.seeds = reportedTube().seeds;
  options.models.emplace();
  Source source;
  source.grey = reportedTube().volume;
  formats::Case value = caseOf(std::move(source), options, m_context).value;
  const std::vector<std::byte> file = formats::encodeBinary(value);
  m_warnings.said.clear();
  addVolume();
  const Page page = reportOf({std::move(value), file, "tube.lumen", "A tube"}, m_volume, m_context);
  EXPECT_EQ(page.facts.bytes, file.size());
  EXPECT_EQ(page.facts.sides.size(), 4U);
  EXPECT_TRUE(page.facts.confidence);
  ASSERT_TRUE(page.facts.volume);
  EXPECT_EQ(page.facts.volume->source.word(), "same");
  EXPECT_EQ(page.facts.volume->projections.size(), 3U);
  ASSERT_TRUE(page.facts.volume->check);
  EXPECT_GT(page.facts.volume->check->offsets.samples, 500U);
  EXPECT_EQ(page.facts.warnings(), 0U);
  EXPECT_TRUE(m_warnings.said.empty());
  for (const std::string& words :
       {std::string("A tube"), std::string("tube.lumen"), std::string("tube.nrrd"), sha256(file)})
    EXPECT_NE(page.html.find(words), std::string::npos) << words;
}

TEST_F(ReportOfTest, ACaseWithoutModelsHasProjectionsAndNoCheck) {
  addVolume();
  const Page page = treePage("tree.lumen");
  EXPECT_EQ(page.facts.title, "tree.lumen");
  EXPECT_TRUE(page.facts.sides.empty());
  EXPECT_FALSE(page.facts.confidence);
  ASSERT_TRUE(page.facts.volume);
  EXPECT_EQ(page.facts.volume->source.word(), "same");
  EXPECT_FALSE(page.facts.volume->check);
  EXPECT_EQ(page.facts.volume->projections.size(), 3U);
}

TEST_F(ReportOfTest, AVolumeThatIsGivenStatesItsOwnAssumptions) {
  m_tree.metadata.steps.push_back({"track", "lumen", {{"assumption-1", "a guessed unit"}}});
  EXPECT_EQ(sentenceWith("guessed", treePage("tree.lumen")),
            "the volume of the case: a guessed unit");
  addVolume();
  m_volume->voxels.assumptions = {"an unknown place"};
  const Page page = treePage("tree.lumen");
  EXPECT_EQ(sentenceWith("guessed", page), "");
  EXPECT_EQ(sentenceWith("unknown", page), "tube.nrrd: an unknown place");
}

TEST_F(ReportOfTest, AnotherVolumeIsOnThePageAndAWarning) {
  addVolume();
  m_tree.metadata.source.value().spacing[0] = 0.5;
  const Page page = treePage("tree.lumen");
  ASSERT_EQ(m_warnings.said.size(), 1U);
  const std::string start = "in/tree.lumen: was made from another volume: its spacing was 0.5 ";
  EXPECT_TRUE(m_warnings.said[0].starts_with(start)) << m_warnings.said[0];
  EXPECT_EQ("in/" + sentenceWith("another volume", page) + " [case-other-volume]",
            m_warnings.said[0]);
  EXPECT_NE(page.html.find("was made from another volume"), std::string::npos);
}

TEST_F(ReportOfTest, NamesThatLookLikeAPersonAreOnThePage) {
  EXPECT_EQ(sentenceWith("PRIVACY", treePage("tree.lumen", "A tree")), "");
  EXPECT_TRUE(sentenceWith("PRIVACY", treePage("Tree 1999-12-31.lumen"))
                  .starts_with("PRIVACY_DATE: a name on this page "));
  EXPECT_TRUE(sentenceWith("PRIVACY", treePage("tree.lumen", "Doe^Jane"))
                  .starts_with("PRIVACY_NAME: a name on this page "));
  addVolume();
  m_volume->name = "2001-02-03.nrrd";
  EXPECT_NE(sentenceWith("PRIVACY_DATE", treePage("tree.lumen")), "");
}

TEST_F(ReportOfTest, ItEndsWhenItsListenerIsCancelled) {
  m_warnings.cancel();
  try {
    (void)treePage("tree.lumen");
    FAIL() << "it went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Cancelled);
  }
}

}  // namespace
}  // namespace lumen::operations
