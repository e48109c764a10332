// SPDX-License-Identifier: Apache-2.0
// A case of known models beside its volume, another volume, and none of its own.
#include "converters/operations/check_of.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/phantom/phantom.h"
#include "tests/unit/check/straight_models.h"

namespace lumen::operations {
namespace {

class CheckWarnings : public Progress {
public:
  void warn(std::string_view message) override { said.emplace_back(message); }
  std::vector<std::string> said;
};

/// The tube phantom, whose case has models of its true radius.
const convert::Phantom& modelledTube() {
  static const convert::Phantom tube = [] {
    convert::PhantomOptions options;
    options.name = "tube";
    options.size = 64;
    options.noise = 0;
    options.bias = 0;
    Progress silent;
    convert::Phantom made = convert::makePhantom(options, silent);
    convert::addStraightModels(made.truth, double{made.truth.tree.radius[0]});
    return made;
  }();
  return tube;
}

class CheckOfTest : public testing::Test {
protected:
  Checked checkedTube() {
    return checked(m_value, m_volume, convert::describeSource(m_volume), m_options, m_context);
  }
  std::string fault() {
    try {
      (void)checkedTube();
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  }
  /// Moves the volume along the tube by a share of its length.
  void move(double share) {
    m_volume.geometry.origin.z() +=
        share * m_volume.geometry.size[2] * m_volume.geometry.spacing.z();
    m_value.metadata.source.reset();
  }

  formats::Case m_value = modelledTube().truth;
  convert::Volume m_volume = modelledTube().volume;
  CheckOptions m_options{{}, {}, CheckNames{"a.lumen", "a.nrrd", "a.lumen and a.nrrd"}};
  CheckWarnings m_warnings;
  Context m_context{m_warnings};
};

TEST_F(CheckOfTest, WallsOfTheTrueRadiusLieAtTheEdgesOfTheirVolume) {
  m_options.pointSpread = convert::kBlur;
  const Checked made = checkedTube();
  EXPECT_EQ(made.source.word(), "same");
  EXPECT_GT(made.report.offsets.samples, 1000U);
  EXPECT_NEAR(made.report.offsets.median, 0, 0.03 * convert::kVoxel);
  EXPECT_FALSE(made.lumen.empty());
  EXPECT_FALSE(made.verdict);
  for (const std::string& words : m_warnings.said)
    EXPECT_EQ(words.find("another volume"), std::string::npos) << words;
}

TEST_F(CheckOfTest, TheBlurIsTheRecordedOneUnlessItIsStated) {
  m_value.metadata.steps.push_back({"track", "lumen", {{"point-spread", 0.3}}});
  EXPECT_EQ(checkedTube().report.options.pointSpread, 0.3);
  m_options.pointSpread = 0.1;
  EXPECT_EQ(checkedTube().report.options.pointSpread, 0.1);
}

TEST_F(CheckOfTest, AnotherVolumeIsAWarningWithBothNames) {
  m_value.metadata.source.value().spacing[0] = 0.5;
  EXPECT_EQ(checkedTube().source.word(), "other spacing");
  ASSERT_FALSE(m_warnings.said.empty());
  const std::string& words = m_warnings.said.front();
  EXPECT_TRUE(words.starts_with("a.lumen: was made from another volume: its spacing was 0.5 "))
      << words;
  EXPECT_NE(words.find(", that of a.nrrd is "), std::string::npos) << words;
}

TEST_F(CheckOfTest, NodesOutsideOfTheVolumeAreAWarning) {
  move(0.5);
  const Checked made = checkedTube();
  EXPECT_EQ(made.source.word(), "unknown");
  EXPECT_GT(made.report.nodesOutside, 1U);
  EXPECT_EQ(m_warnings.said,
            (std::vector<std::string>{"a.lumen: " + std::to_string(made.report.nodesOutside) +
                                      " of its " + std::to_string(m_value.tree.nodeCount()) +
                                      " nodes lie outside of a.nrrd [case-other-volume]"}));
}

TEST_F(CheckOfTest, ACaseElsewhereIsAnErrorWithBothNames) {
  move(100);
  const std::string words = "none of the case's " + std::to_string(m_value.tree.nodeCount()) +
                            " nodes lies in the volume: ";
  EXPECT_TRUE(fault().starts_with("a.lumen and a.nrrd: " + words)) << fault();
  m_options.names.reset();
  EXPECT_TRUE(fault().starts_with(words)) << fault();
}

TEST_F(CheckOfTest, WithoutNamesThereIsNoWarning) {
  m_value.metadata.source.value().spacing[0] = 0.5;
  m_volume.geometry.origin.z() += 1;
  m_options.names.reset();
  const Checked made = checkedTube();
  EXPECT_EQ(made.source.word(), "other spacing");
  EXPECT_GT(made.report.nodesOutside, 0U);
  EXPECT_TRUE(m_warnings.said.empty());
}

TEST_F(CheckOfTest, AProfileGivesAVerdict) {
  m_options.profile = convert::GateProfile{"strict", "", {{"wall_p90_voxels", false, 0}}};
  const Checked strict = checkedTube();
  ASSERT_TRUE(strict.verdict);
  EXPECT_EQ(strict.verdict->profile, "strict");
  EXPECT_FALSE(strict.verdict->passes());
  // a reach that nobody measured would not pass
  m_options.profile = convert::GateProfile{"loose", "", {{"reachable_share", true, 0}}};
  const Checked loose = checkedTube();
  ASSERT_TRUE(loose.verdict);
  EXPECT_TRUE(loose.verdict->passes());
}

TEST_F(CheckOfTest, ItEndsWhenItsListenerIsCancelled) {
  m_warnings.cancel();
  EXPECT_EQ(fault(), "interrupted");
}

}  // namespace
}  // namespace lumen::operations
