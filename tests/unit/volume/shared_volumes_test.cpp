// SPDX-License-Identifier: Apache-2.0
// Files that have shown faults, where they are at hand: what each is answered with.
#include <gtest/gtest.h>

#include "text_volume.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

class SharedVolume : public testing::Test {
protected:
  static fs::path file(const char* name) {
    return fs::path(LUMEN_SHARED_DATA).parent_path() / "hostile" / name;
  }
};

TEST_F(SharedVolume, HeadersThatAttackAreRefused) {
  if (!fs::exists(file("a1.mha"))) GTEST_SKIP() << file("a1.mha") << " is absent";
  expectRefused(readRefusal(file("a1.mha")), {"3: ", "%s%s%s%s.raw", "pattern"});
  expectRefused(readRefusal(file("a2.mha")), {"3: ", "s%d.raw 0 47 0", "step"});
  expectRefused(readRefusal(file("a3.mha")), {"3: ", "NDims is \"-1\""});
  expectRefused(readRefusal(file("a5.mha")), {"3: ", "of 221184 bytes", "70000"});
}

TEST_F(SharedVolume, AssumptionsAreReported) {
  if (!fs::exists(file("a7.nrrd"))) GTEST_SKIP() << file("a7.nrrd") << " is absent";
  const Volume metres = readQuietly(file("a7.nrrd"));
  EXPECT_EQ(metres.geometry.spacing, Eigen::Vector3d::Constant(200));
  expectAssumes(metres, {"200", "unusual", "--unit"});
  expectAssumes(readQuietly(file("a8.mha")), {"no spacing", "--spacing"});
  expectAssumes(readQuietly(file("spacings-nan.nrrd")), {"no spacing", "--spacing"});
}

TEST_F(SharedVolume, ASoundOneIsReadWithoutAWord) {
  const fs::path sound = file("track-never-ends.nrrd");
  if (!fs::exists(sound)) GTEST_SKIP() << sound << " is absent";
  const Volume volume = readQuietly(sound);
  EXPECT_EQ(volume.geometry.size, (std::array{221, 221, 221}));
  EXPECT_TRUE(volume.assumptions.empty());
}

}  // namespace
}  // namespace lumen::convert
