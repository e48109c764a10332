// SPDX-License-Identifier: Apache-2.0
// Volumes in which one value fills what is no image.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>

#include <nlohmann/json.hpp>

#include "formats/case/case_file.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {
namespace {

using Json = nlohmann::ordered_json;
using Inside = std::function<bool(double, double, double)>;  // of voxels from the middle

constexpr int kBorderSize = 64;
constexpr double kVoxel = 0.2, kMiddle = 0.5 * (kBorderSize - 1);

/// A fork with noise, its case, and the same fork with all voxels outside of a region set to one
/// value.
class ImageBorderTest : public CliTest {
protected:
  void SetUp() override {
    fillOnce("cut-fork", [this] {
      make({"phantom", "bifurcation", "fork.nii", "--size", "64", "--truth", "truth.lumen",
            "--seeds", "seeds.json"});
    });
  }

  /// Fills fork.nii outside of a region, as cut.nii.
  void cut(const Inside& isInside, std::int16_t fill) const {
    std::string bytes = read("fork.nii");
    std::size_t at = bytes.size() - sizeof fill * kBorderSize * kBorderSize * kBorderSize;
    for (int z = 0; z < kBorderSize; ++z)
      for (int y = 0; y < kBorderSize; ++y)
        for (int x = 0; x < kBorderSize; ++x, at += sizeof fill)
          if (!isInside(x - kMiddle, y - kMiddle, z - kMiddle))
            std::memcpy(bytes.data() + at, &fill, sizeof fill);
    write("cut.nii", bytes);
  }

  /// Millimetres of the true tree within a region.
  [[nodiscard]] double trueLength(const Inside& isInside) const {
    const formats::CenterlineTree tree = (*formats::readCaseFile(path("truth.lumen"))).tree;
    const auto place = [&](std::size_t node) {
      const auto& c = tree.centre[node];
      return std::array{double{c.x}, double{c.y}, double{c.z}};
    };
    double length = 0;
    for (std::size_t i = 0; i < tree.nodeCount(); ++i) {
      if (tree.parent[i] == formats::kNoParent) continue;
      const auto to = place(i), from = place(static_cast<std::size_t>(tree.parent[i]));
      const auto voxels = [&](std::size_t a) { return to[a] / kVoxel - kMiddle; };
      if (isInside(voxels(0), voxels(1), voxels(2)))
        length += std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    }
    return length;
  }

  [[nodiscard]] Json answer(const std::vector<std::string>& arguments) const {
    const Outcome done = lumen(arguments);
    EXPECT_EQ(done.code, 0) << done.err;
    return Json::parse(done.out);
  }
};

const Inside kCircle = [](double x, double y, double) { return x * x + y * y < 28 * 28; };
const Inside kTurned = [](double x, double y, double z) {
  const double u = 0.8 * x + 0.6 * y, v = 0.8 * y - 0.6 * x;
  return std::max({std::abs(u), std::abs(v), std::abs(z)}) < 27;
};

TEST_F(ImageBorderTest, NoVesselRunsAlongTheBorderAndThoseThatItCutEndThere) {
  for (const Inside& isInside : {kCircle, kTurned})
    for (const int fill : {-2048, -1024, 0, 3000}) {
      cut(isInside, static_cast<std::int16_t>(fill));
      make({"convert", "cut.nii", "cut.lumen"});
      const Json score = answer({"compare", "cut.lumen", "truth.lumen", "--json"});
      const double length = trueLength(isInside);
      const double outside = trueLength([](double, double, double) { return true; }) - length;
      EXPECT_LE(score["false_mm"].get<double>(), 0.01 * length) << fill;
      EXPECT_LE(score["missed_mm"].get<double>(), outside + 0.02 * length) << fill;
      EXPECT_GE(score["missed_mm"].get<double>(), outside - 0.05 * length) << fill;
    }
}

TEST_F(ImageBorderTest, TheVolumeThatTheCaseNamesIsTheWholeOne) {
  cut(kCircle, -1024);
  make({"convert", "cut.nii", "cut.lumen"});
  const Json volume = answer({"info", "cut.nii", "--voxels", "--json"});
  const Json made = answer({"info", "cut.lumen", "--json"});
  EXPECT_EQ(made["provenance"]["source"]["sha256"], volume["sha256"]) << made << volume;
}

TEST_F(ImageBorderTest, NoVesselGoesOnBeyondTheBorder) {
  cut(kCircle, -1024);
  make({"convert", "cut.nii", "cut.lumen"});
  const Outcome checked = lumen({"check", "cut.nii", "cut.lumen"});
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_TRUE(contains(checked.out, " of 3 reach as far as the volume")) << checked.out;
  EXPECT_FALSE(contains(checked.out, "goes on for")) << checked.out;
}

TEST_F(ImageBorderTest, ATrackFromAClickEndsAtTheBorder) {
  cut(kTurned, -1024);
  make({"convert", "cut.nii", "clicked.lumen", "--seeds", "seeds.json", "--seeds-only"});
  const Json score = answer({"compare", "clicked.lumen", "truth.lumen", "--json"});
  EXPECT_LE(score["false_mm"].get<double>(), 0.01 * trueLength(kTurned));
  EXPECT_GE(score["missed_mm"].get<double>(), 1);  // the ends are cut off
}

TEST_F(ImageBorderTest, TheVoxelsThatAreNoImageAreCountedForWhoAsks) {
  cut(kCircle, -1024);
  const Outcome done = lumen({"convert", "cut.nii", "cut.lumen", "--verbose"});
  EXPECT_TRUE(contains(done.err, " voxels are no image")) << done.err;
}

}  // namespace
}  // namespace lumen::test
