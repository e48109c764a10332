// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/pictures_of.h"

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/operations/sample_cases.h"

namespace lumen::operations {
namespace {

class PicturesOfTest : public testing::Test {
protected:
  PicturesOfTest() {
    m_options.picture.view = convert::View::Anterior;
    m_options.picture.width = 48;
    m_options.picture.height = 64;
  }
  /// The bytes of each picture.
  std::vector<std::string> drawn(const formats::Case& value) {
    std::vector<std::string> pictures;
    picturesOf(
        value, "fork", m_options,
        [&](const convert::Picture& picture) { pictures.push_back(convert::encodePng(picture)); },
        m_context);
    return pictures;
  }
  /// The bytes of a picture of the turntable whose share of a whole turn this is.
  std::string turned(double share) {
    convert::PictureOptions picture = m_options.picture;
    picture.allTurns = true;
    picture.turn = 2 * std::numbers::pi * share;
    return convert::encodePng(convert::drawCase(m_fork, picture, nullptr, m_progress));
  }

  Progress m_progress;
  Context m_context{m_progress};
  formats::Case m_fork = samples::fittedFork();
  PicturesOptions m_options;
};

TEST_F(PicturesOfTest, OnePictureIsThatOfDrawCase) {
  const std::string whole =
      convert::encodePng(convert::drawCase(m_fork, m_options.picture, nullptr, m_progress));
  EXPECT_EQ(drawn(m_fork), std::vector<std::string>{whole});
}

TEST_F(PicturesOfTest, ATurntableHasEvenTurnsInOneScale) {
  m_options.turns = 4;
  const std::vector<std::string> pictures = drawn(m_fork);
  ASSERT_EQ(pictures.size(), 4U);
  EXPECT_EQ(pictures[0], turned(0));
  EXPECT_EQ(pictures[1], turned(0.25));
  EXPECT_NE(pictures[0], pictures[1]);
}

TEST_F(PicturesOfTest, TheVolumeIsDrawnBehind) {
  const std::vector<std::string> plain = drawn(m_fork);
  convert::Volume volume;
  volume.geometry.size = {16, 16, 24};
  volume.geometry.origin = {-8, -8, -2};
  std::vector<std::uint8_t> voxels(volume.geometry.voxelCount());
  for (std::size_t i = 0; i < voxels.size(); ++i)
    voxels[i] = static_cast<std::uint8_t>(i * 37 % 251);
  volume.voxels = std::move(voxels);
  m_options.behind = &volume;
  m_options.behindName = "volume";
  EXPECT_NE(drawn(m_fork), plain);
  volume.geometry.origin.x() = 1000;
  const std::string fault = samples::faultOf([&] { (void)drawn(m_fork); });
  EXPECT_TRUE(fault.starts_with("volume: ")) << fault;
}

TEST_F(PicturesOfTest, ACaseWithoutModelsIsRefusedWithItsName) {
  m_fork.models.reset();
  const std::string fault = samples::faultOf([&] { (void)drawn(m_fork); });
  EXPECT_TRUE(fault.starts_with("fork: this case has no models")) << fault;
}

}  // namespace
}  // namespace lumen::operations
