// SPDX-License-Identifier: Apache-2.0
// A tube that moves by a millimetre from one volume to the next.
#include "converters/operations/moved.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "tests/unit/operations/sample_cases.h"

namespace lumen::operations {
namespace {

constexpr double kShift = 1, kReach = 2, kHalfVoxel = 0.1;  // mm

/// The volume of the tube at rest, and the same a millimetre farther along x.
PhaseSeries shiftedPhases(const convert::Volume& volume) {
  PhaseSeries series;
  series.times = {0, 0.4};
  series.period = 0.8;
  series.reach = kReach;
  series.read = [volume](std::size_t phase) {
    convert::Volume later = volume;
    later.geometry.origin.x() += kShift * static_cast<double>(phase);
    return later;
  };
  series.name = [](std::size_t phase) { return "phase " + std::to_string(phase); };
  return series;
}

/// The distance in mm, across the tube, of its middle node in the second phase from where the volume
/// carries it.
double errorAcross(const MovedCase& made) {
  const formats::CenterlineTree& tree = made.value.tree;
  const std::size_t node = tree.nodeCount() / 2;
  const Eigen::Vector3d along = toEigen(tree.direction[node]).normalized();
  const Eigen::Vector3d error = toEigen(made.value.motion->pose[tree.nodeCount() + node].centre) -
                                toEigen(tree.centre[node]) - kShift * Eigen::Vector3d::UnitX();
  return (error - error.dot(along) * along).norm();
}

class MovedTest : public testing::Test {
protected:
  [[nodiscard]] std::string fault(const PhaseSeries& series) const {
    return samples::faultOf([&] { (void)moved(m_tube.value, "tube", series, m_context); });
  }

  Progress m_progress;
  Context m_context{m_progress};
  samples::TrackedTube m_tube = samples::trackedTube();
};

TEST_F(MovedTest, TheCaseGetsItsMotionAndAStep) {
  const MovedCase made = moved(m_tube.value, "tube", shiftedPhases(m_tube.volume), m_context);
  ASSERT_TRUE(made.value.motion);
  EXPECT_EQ(made.value.motion->time, (std::vector<double>{0, 0.4}));
  EXPECT_EQ(made.value.motion->period, 0.8);
  EXPECT_EQ(made.value.motion->pose.size(), 2 * m_tube.value.tree.nodeCount());
  ASSERT_EQ(made.phases.size(), 2U);
  EXPECT_EQ(made.phases[0].farthest, 0) << "the volume that the case was tracked in is at rest";
  EXPECT_LT(errorAcross(made), kHalfVoxel);
  EXPECT_EQ(made.value.tree.centre, m_tube.value.tree.centre);
  const formats::Step& step = made.value.metadata.steps.back();
  EXPECT_EQ(step.name, "motion");
  EXPECT_EQ(std::get<std::int64_t>(step.parameters.at("phases")), 2);
  EXPECT_EQ(std::get<double>(step.parameters.at("reach")), kReach);
  EXPECT_FALSE(std::get<bool>(step.parameters.at("dark")));
}

TEST_F(MovedTest, DarkVesselsAreFollowedAsTheCaseWasTracked) {
  const samples::TrackedTube dark = samples::trackedTube(true);
  const MovedCase made = moved(dark.value, "tube", shiftedPhases(dark.volume), m_context);
  EXPECT_TRUE(std::get<bool>(made.value.metadata.steps.back().parameters.at("dark")));
  EXPECT_LT(errorAcross(made), kHalfVoxel);
  EXPECT_GT(made.phases[1].seen, 0.9);
}

TEST_F(MovedTest, APhaseThatShowsNothingIsRefusedWithBothNames) {
  PhaseSeries series = shiftedPhases(m_tube.volume);
  series.read = [&](std::size_t phase) {
    convert::Volume volume = m_tube.volume;
    if (phase > 0) volume.voxels = std::vector<float>(volume.geometry.voxelCount(), 5.0F);
    return volume;
  };
  const std::string text = fault(series);
  EXPECT_TRUE(text.starts_with("tube and phase 1: ")) << text;
}

TEST_F(MovedTest, AnErrorOfAReaderNamesThePhaseOnce) {
  PhaseSeries series = shiftedPhases(m_tube.volume);
  series.read = [](std::size_t) -> convert::Volume { throw invalidInput("phase 0: is broken"); };
  EXPECT_EQ(fault(series), "phase 0: is broken");
  series.read = [](std::size_t) -> convert::Volume { throw invalidInput("voxels.raw: is gone"); };
  EXPECT_EQ(fault(series), "tube and phase 0: voxels.raw: is gone");
}

}  // namespace
}  // namespace lumen::operations
