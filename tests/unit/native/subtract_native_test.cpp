// SPDX-License-Identifier: Apache-2.0
// Bones that moved apart between two scans, taken away from the one with contrast.
#include "converters/stages/native/subtract_native.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/error.h"
#include "converters/stages/finding/find_vessels.h"
#include "tests/unit/native/two_bones.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

NativeSubtraction subtracted(const Volume& contrast, const Volume& native) {
  Progress silent;
  return subtractNative(contrast, "cta", native, "plain", silent);
}

/// Mean of the voxels whose places `is` takes.
double levelWhere(const Volume& volume, const std::function<bool(const Vector3d&)>& is) {
  const auto& voxels = std::get<std::vector<std::int16_t>>(volume.voxels);
  double sum = 0, count = 0;
  volume.geometry.cells().forEach([&](const Cell& cell) {
    if (!is(volume.geometry.position(cell))) return;
    sum += voxels[volume.geometry.index(cell)];
    ++count;
  });
  return sum / count;
}

bool isInVessel(const Vector3d& p) {
  return TwoBones::toVessel(p) < -1;
}
bool isInBone(const Vector3d& p) {
  return std::min(TwoBones::toFirst(p), TwoBones::toSecond(p)) < 0 && TwoBones::toVessel(p) > 2;
}

class SubtractNative : public testing::Test {
protected:
  static void SetUpTestSuite() {
    s_contrast = new Volume(withContrast().draw());
    s_native = new Volume(withoutContrast().draw());
    s_left = new NativeSubtraction(subtracted(*s_contrast, *s_native));
  }
  static void TearDownTestSuite() {
    delete s_contrast;
    delete s_native;
    delete s_left;
  }
  static void expectPiece(const NativePiece& piece, const Eigen::Isometry3d& truth,
                          const Vector3d& centre) {
    const Vector3d shift = centre - truth.inverse() * centre;
    EXPECT_LT((piece.shift - shift).norm(), 0.3);
    EXPECT_NEAR(piece.rotation, Eigen::AngleAxisd(truth.linear()).angle() * 180 / M_PI, 0.6);
    EXPECT_LT(piece.residual, 1);
    EXPECT_LT(piece.difference, 60);
  }
  static std::string refusal(const Volume& contrast, const Volume& native) {
    try {
      subtracted(contrast, native);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
      return error.what();
    }
    return {};
  }

  static const Volume *s_contrast, *s_native;
  static const NativeSubtraction* s_left;
};

const Volume* SubtractNative::s_contrast;
const Volume* SubtractNative::s_native;
const NativeSubtraction* SubtractNative::s_left;

TEST_F(SubtractNative, FindsTheMotionOfTheLargerBone) {
  ASSERT_FALSE(s_left->report.pieces.empty());
  expectPiece(s_left->report.pieces[0], withoutContrast().first, TwoBones::firstCentre());
}

TEST_F(SubtractNative, MovesBonesApart) {
  EXPECT_GE(s_left->report.pieces.size(), 2);
}

constexpr double kTenth = 0.1 * (TwoBones::kBlood - TwoBones::kSoft);

TEST_F(SubtractNative, LeavesTheVesselAndNoBone) {
  EXPECT_NEAR(levelWhere(s_left->volume, isInVessel), TwoBones::kBlood, kTenth);
  EXPECT_GT(levelWhere(*s_contrast, isInBone), 400);
  EXPECT_NEAR(levelWhere(s_left->volume, isInBone), TwoBones::kSoft, kTenth);
}

/// The length of the longest course that runs within the vessel.
double lengthFound(const Volume& volume) {
  Progress silent;
  double longest = 0;
  for (const SeedBranch& course : findVessels(volume, false, {}, silent).courses) {
    const auto isIn = [](const SeedPoint& point) {
      return TwoBones::toVessel(point.position) < -1;
    };
    if (std::all_of(course.points.begin(), course.points.end(), isIn))
      longest = std::max(longest,
                         (course.points.back().position - course.points.front().position).norm());
  }
  return longest;
}

TEST_F(SubtractNative, LetsAVesselThroughBoneBeFound) {
  EXPECT_LT(lengthFound(*s_contrast), 30);
  EXPECT_GT(lengthFound(s_left->volume), 50);
}

TEST_F(SubtractNative, GivesTheSameBitsOnOneThread) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_TRUE(subtracted(*s_contrast, *s_native).volume.voxels == s_left->volume.voxels);
}

TEST_F(SubtractNative, RefusesAScanWithTheSameContrast) {
  TwoBones other = withoutContrast();
  other.blood = TwoBones::kBlood;
  EXPECT_EQ(refusal(*s_contrast, other.draw()),
            "plain: no blood has less contrast in it than in cta; expected a scan without contrast "
            "beside one with it");
}

TEST_F(SubtractNative, RefusesScansThatAreExchanged) {
  EXPECT_EQ(refusal(*s_native, *s_contrast),
            "plain: no blood has less contrast in it than in cta; expected a scan without contrast "
            "beside one with it");
}

TEST_F(SubtractNative, RefusesAVolumeThatIsNoTomogram) {
  Volume other = *s_native;
  other.voxels = std::vector<float>(other.geometry.voxelCount(), 7.0F);
  EXPECT_EQ(refusal(*s_contrast, other),
            "plain: its levels are not those of computed tomography, whose bone alone can be taken "
            "away by a scan without contrast");
}

TEST_F(SubtractNative, RefusesAScanWithoutBone) {
  TwoBones other = withoutContrast();
  other.first = other.second = motionAbout({0, 0, 0}, 0, {0, 0, 1}, {500, 0, 0});
  EXPECT_EQ(refusal(*s_contrast, other.draw()),
            "plain: it has no bone where cta lies; expected a scan of the same body without "
            "contrast");
}

TEST_F(SubtractNative, RefusesAScanOfAnotherBody) {
  TwoBones other = withoutContrast();
  other.hasRod = true;
  EXPECT_EQ(
      refusal(*s_contrast, other.draw()),
      "plain: less than half of its bone comes to lie within a voxel of that of cta; expected "
      "a scan of the same body without contrast");
}

}  // namespace
}  // namespace lumen::convert
