// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/image_fit.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/validate.h"
#include "tests/unit/operations/sample_cases.h"

namespace lumen::operations {
namespace {

class ImageFitWarnings : public Progress {
public:
  void warn(std::string_view message) override { said.emplace_back(message); }
  std::vector<std::string> said;
};

class FittedToImageTest : public testing::Test {
protected:
  ImageFittedCase made() {
    return fittedToImage(m_tube.value, "tube", {m_tube.volume, "image"}, {}, Context{m_progress});
  }

  ImageFitWarnings m_progress;
  samples::TrackedTube m_tube = samples::trackedTube();
};

TEST_F(FittedToImageTest, ModelsFollowWallsThatTheImageMoved) {
  const ImageFittedCase fitted = made();
  EXPECT_TRUE(m_progress.said.empty());
  EXPECT_EQ(fitted.report.nodes + fitted.report.kept, m_tube.value.tree.nodeCount());
  EXPECT_GT(fitted.report.nodes, fitted.report.kept);
  ASSERT_TRUE(fitted.value.models);
  EXPECT_TRUE(formats::validate(fitted.value));
  EXPECT_NE(fitted.value.points, m_tube.value.points);
  const std::vector<formats::Step>& steps = fitted.value.metadata.steps;
  ASSERT_GE(steps.size(), 2U);
  EXPECT_EQ(steps[steps.size() - 2].name, "fit-image");
  EXPECT_EQ(steps.back().name, "fit");
}

TEST_F(FittedToImageTest, AnotherVolumeIsAWarningWithBothNames) {
  ++std::get<std::vector<std::int16_t>>(m_tube.volume.voxels).front();
  (void)made();
  ASSERT_EQ(m_progress.said.size(), 1U);
  EXPECT_EQ(m_progress.said[0],
            "tube: was made from another volume: image has its size and place, but other voxels "
            "[case-other-volume]");
}

TEST_F(FittedToImageTest, ACaseWithoutWallPointsIsRefusedWithBothNames) {
  m_tube.value.points.reset();
  const std::string fault = samples::faultOf([&] { (void)made(); });
  EXPECT_TRUE(fault.starts_with("tube and image: the case has no wall points")) << fault;
}

}  // namespace
}  // namespace lumen::operations
