// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/draw_case.h"

#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "straight_vessels.h"

namespace lumen::convert {
namespace {

formats::Case twoVessels() {
  return test::straightVessels({{{0, 0, 0}, {0, 0, 20}}, {{10, 0, 0}, {10, 0, 20}}}, 2);
}

Volume around() {
  Volume volume;
  volume.geometry.size = {20, 12, 26};
  volume.geometry.origin = {-4, -6, -3};
  std::vector<std::uint8_t> voxels(volume.geometry.voxelCount());
  for (std::size_t i = 0; i < voxels.size(); ++i)
    voxels[i] = static_cast<std::uint8_t>(i * 37 % 251);
  volume.voxels = voxels;
  return volume;
}

PictureOptions small() {
  PictureOptions options;
  options.view = View::Anterior;
  options.width = 200;
  options.height = 160;
  return options;
}

std::string refusal(const formats::Case& value, const PictureOptions& options,
                    const Volume* volume = nullptr) {
  Progress progress;
  try {
    (void)drawCase(value, options, volume, progress);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    return error.what();
  }
  return "";
}

TEST(DrawCase, TellsWhatIsMissing) {
  formats::Case value = twoVessels();
  value.models.reset();
  EXPECT_NE(refusal(value, small()).find("has no models"), std::string::npos);
  formats::Case empty;
  empty.models.emplace();
  EXPECT_NE(refusal(empty, small()).find("has no node"), std::string::npos);
  PictureOptions confidence = small();
  confidence.colour = ColorBy::Confidence;
  EXPECT_NE(refusal(twoVessels(), confidence).find("expected vessel, branch or radius"),
            std::string::npos);
  Volume far = around();
  far.geometry.origin = {1000, 0, 0};
  EXPECT_NE(refusal(twoVessels(), small(), &far).find("lies in the volume"), std::string::npos);
}

TEST(DrawCase, OneNodeIsEnough) {
  formats::Case value = test::straightVessels({{{0, 0, 0}, {0, 0, 2}}}, 2);
  formats::CenterlineTree& tree = value.tree;
  tree.centre.resize(1);
  tree.direction.resize(1);
  tree.radius.resize(1);
  tree.height.resize(1);
  tree.parent.resize(1);
  tree.branch.resize(1);
  tree.branches[0].nodeCount = 1;
  const auto blobs = value.models->offset[1];
  value.models->offset.resize(2);
  value.models->centre.resize(blobs);
  value.models->width.resize(blobs);
  Progress progress;
  const Picture picture = drawCase(value, small(), nullptr, progress);
  const Rgb middle = picture.pixels[80 * 200 + 100];
  EXPECT_GT(middle[0], 2 * middle[1]);
}

TEST(DrawCase, BranchesHaveTheirOwnHues) {
  PictureOptions options = small();
  options.colour = ColorBy::Branch;
  Progress progress;
  const Picture picture = drawCase(twoVessels(), options, nullptr, progress);
  // orange is red before blue, sky blue is not
  int orange = 0, blue = 0;
  for (const Rgb& p : picture.pixels) {
    orange += p[0] > p[2] + 60;
    blue += p[2] > p[0] + 60;
  }
  EXPECT_GT(orange, 500);
  EXPECT_NEAR(orange, blue, 0.1 * orange);
}

TEST(DrawCase, MarksAreLeftOutOnRequest) {
  PictureOptions options = small();
  options.marks = false;
  Progress progress;
  const auto isBlankAtTheLeft = [](const Picture& picture) {
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < 20; ++x)
        if (picture.pixels[static_cast<std::size_t>(y * picture.width + x)] != Rgb{250, 250, 250})
          return false;
    return true;
  };
  EXPECT_TRUE(isBlankAtTheLeft(drawCase(twoVessels(), options, nullptr, progress)));
  options.marks = true;
  EXPECT_FALSE(isBlankAtTheLeft(drawCase(twoVessels(), options, nullptr, progress)));
}

TEST(DrawCase, AVolumeIsGreyBehindTheVessels) {
  const Volume volume = around();
  Progress progress;
  PictureOptions options = small();
  options.marks = false;
  const Picture plain = drawCase(twoVessels(), options, nullptr, progress);
  const Picture behind = drawCase(twoVessels(), options, &volume, progress);
  std::set<int> greys;
  for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
    const Rgb& p = behind.pixels[i];
    if (plain.pixels[i] != Rgb{250, 250, 250}) continue;
    ASSERT_TRUE(p[0] == p[1] && p[1] == p[2]);
    greys.insert(p[0]);
  }
  EXPECT_GT(greys.size(), 20U);
  // within a vessel nothing changes
  EXPECT_EQ(plain.pixels[80 * 200 + 130], behind.pixels[80 * 200 + 130]);
}

TEST(DrawCase, AnyNumberOfThreadsGivesTheSameBytes) {
  const Volume volume = around();
  Progress progress;
  PictureOptions options = small();
  options.turn = 0.3;
  options.colour = ColorBy::Radius;
  const Picture many = drawCase(twoVessels(), options, &volume, progress);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(encodePng(many), encodePng(drawCase(twoVessels(), options, &volume, progress)));
}

}  // namespace
}  // namespace lumen::convert
