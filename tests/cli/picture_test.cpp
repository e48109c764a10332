// SPDX-License-Identifier: Apache-2.0
// lumen picture, from outside.
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <png.h>
#include <signal.h>

#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Names = std::vector<std::string>;

using PictureTest = FittedTubeTest;

struct Decoded {
  std::uint32_t width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 3>> pixels;
};

/// Picture that libpng reads; nothing if it is no whole PNG.
std::optional<Decoded> decoded(const std::string& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) return {};
  image.format = PNG_FORMAT_RGB;
  Decoded picture{image.width, image.height, {}};
  picture.pixels.resize(std::size_t{image.width} * image.height);
  if (png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr) == 0) return {};
  return picture;
}

std::size_t redPixels(const Decoded& picture) {
  std::size_t red = 0;
  for (const auto& p : picture.pixels) red += p[0] > 2 * p[1] && p[0] > 2 * p[2];
  return red;
}

}  // namespace

TEST_F(PictureTest, IsAPngOfTheSizeThatWasAskedForWithAVesselInIt) {
  const Outcome drawn = lumen({"picture", "tube.lumen", "tube.png", "--size", "300x200", "--json"});
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  const auto answer = nlohmann::json::parse(drawn.out);
  EXPECT_EQ(answer["files"], Names{"tube.png"});
  EXPECT_EQ(answer["width"], 300);
  EXPECT_EQ(answer["height"], 200);
  const auto picture = decoded(read("tube.png"));
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, 300U);
  EXPECT_EQ(picture->height, 200U);
  EXPECT_GT(redPixels(*picture), 1000U);
}

TEST_F(PictureTest, EveryViewAndColourAndAVolumeGiveAnotherPicture) {
  std::set<std::string> seen;
  const std::vector<Names> ways = {{},
                                   {"--view", "superior"},
                                   {"--view", "inferior"},
                                   {"--view", "left"},
                                   {"--view", "right"},
                                   {"--view", "anterior"},
                                   {"--view", "posterior"},
                                   {"--colour", "radius"},
                                   {"--colour", "branch"},
                                   {"--colour", "confidence"},
                                   {"--volume", "tube.nrrd"}};
  for (const Names& way : ways) {
    Names line = {"picture", "tube.lumen", "tube.png", "--size", "300x200"};
    line.insert(line.end(), way.begin(), way.end());
    const Outcome drawn = lumen(line);
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    seen.insert(read("tube.png"));
  }
  // the best view may be one of the six
  EXPECT_GE(seen.size(), ways.size() - 1);
}

TEST_F(PictureTest, AnyNumberOfThreadsGivesTheSameBytes) {
  for (const char* threads : {"1", "3"})
    ASSERT_EQ(lumen({"picture", "tube.lumen", std::string(threads) + ".png", "--volume",
                     "tube.nrrd", "--threads", threads, "--size", "300x200"})
                  .code,
              0);
  EXPECT_EQ(read("1.png"), read("3.png"));
}

TEST_F(PictureTest, ATurntableHasItsFramesAndTellsOfOlderOnes) {
  const Outcome drawn = lumen(
      {"picture", "tube.lumen", "turn.png", "--turntable", "4", "--size", "120x90", "--quiet"});
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_EQ(drawn.err, "");
  EXPECT_EQ(entries(), (Names{"seeds.json", "truth.lumen", "tube.lumen", "tube.nrrd",
                              "turn-000.png", "turn-001.png", "turn-002.png", "turn-003.png"}));
  const Outcome fewer =
      lumen({"picture", "tube.lumen", "turn.png", "--turntable", "3", "--size", "120x90"});
  EXPECT_EQ(fewer.code, 0);
  EXPECT_NE(fewer.err.find("warning: turn-003.png: found a frame of an older turntable"),
            std::string::npos)
      << fewer.err;
}

TEST_F(PictureTest, AnInterruptedTurntableLeavesNoFrameAndTheOldOnesAsTheyWere) {
  write("turn-000.png", "precious");
  const Names before = entries();
  const Outcome stopped = lumenWithSignal(
      {"picture", "tube.lumen", "turn.png", "--turntable", "360", "--verbose"}, SIGINT);
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  EXPECT_EQ(entries(), before);
  EXPECT_EQ(read("turn-000.png"), "precious");
}

TEST_F(PictureTest, ACaseWithoutModelsOrConfidenceSaysSoAndNamesTheFile) {
  const Outcome none = lumen({"picture", "truth.lumen", "truth.png"});
  EXPECT_EQ(none.code, 3);
  EXPECT_NE(none.err.find("truth.lumen: this case has no models"), std::string::npos) << none.err;
  ASSERT_EQ(lumen({"convert", "truth.lumen", "line.swc"}).code, 0);
  ASSERT_EQ(lumen({"convert", "line.swc", "line.lumen"}).code, 0);
  const Outcome plain = lumen({"picture", "line.lumen", "line.png", "--colour", "confidence"});
  EXPECT_EQ(plain.code, 3);
  EXPECT_NE(plain.err.find("line.lumen: --colour confidence: no node of the case states"),
            std::string::npos)
      << plain.err;
  EXPECT_FALSE(exists("line.png"));
}

TEST_F(PictureTest, WhatCannotBeWrittenIsSaidBeforeAnyWork) {
  EXPECT_EQ(lumen({"picture", "tube.lumen", "tube"}).code, 2);
  EXPECT_EQ(lumen({"picture", "tube.png", "tube.lumen"}).code, 2);
  EXPECT_EQ(lumen({"picture", "tube.lumen", "no-such-folder/tube.png"}).code, 1);
  std::filesystem::create_directory(path("folder.png"));
  const Outcome folder = lumen({"picture", "tube.lumen", "folder.png"});
  EXPECT_EQ(folder.code, 1);
  EXPECT_NE(folder.err.find("this is a folder"), std::string::npos) << folder.err;
  EXPECT_EQ(lumen({"picture", "tube.nrrd", "tube.png"}).code, 3);
  EXPECT_EQ(lumen({"picture", "tube.lumen", "tube.png", "--volume", "truth.lumen"}).code, 4);
  for (const char* size : {"15x100", "100x4097", "100", "-3x7", "100x"})
    EXPECT_EQ(lumen({"picture", "tube.lumen", "tube.png", "--size", size}).code, 2) << size;
  EXPECT_FALSE(exists("tube.png"));
}

}  // namespace lumen::test
