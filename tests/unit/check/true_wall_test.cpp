// SPDX-License-Identifier: Apache-2.0
// Cases that were tracked and fitted, whose wall's true error is known: what the check reads off the
// volume must agree with it.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/statistics.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/check/check.h"
#include "converters/judge/check/wall_samples.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/track_case.h"
#include "formats/case/case_field.h"

namespace lumen::convert {
namespace {

struct Fitted {
  Phantom phantom;
  formats::Case value;
};

Fitted fitted(const std::string& name, int size) {
  PhantomOptions options;
  options.name = name;
  options.size = size;
  Progress progress;
  Fitted result{makePhantom(options, progress), {}};
  result.value = trackFromSeeds(result.phantom.volume, result.phantom.seeds, {}, progress).result;
  fit(result.value, {}, progress);
  return result;
}

/// For each branch the signed distances of its wall's samples from the true wall, mm, positive where
/// the model is too wide.
std::vector<std::vector<double>> trueErrors(const Fitted& f, double spacing) {
  const field::BlendedField surface = formats::caseField(f.value);
  const TubeTreeDistance wall(f.phantom.truth.tree);
  const WallSampler sampler(f.value.tree, surface, spacing);
  std::vector<std::vector<double>> errors(f.value.tree.branches.size());
  std::vector<WallSample> samples;
  for (std::uint32_t n = 0; n < f.value.tree.nodeCount(); ++n) {
    samples.clear();
    sampler.sample(n, samples);
    for (const WallSample& sample : samples)
      errors[f.value.tree.branch[n]].push_back(wall.nearest(sample.position).distance);
  }
  return errors;
}

void expectAgreement(const Fitted& f) {
  Progress progress;
  const CheckReport report =
      checkCase(f.phantom.volume, f.value, recordedEdgeOptions(f.value), progress).report;
  const auto errors = trueErrors(f, report.voxelSize);
  constexpr std::size_t kEnough = 300;  // samples, for a median that the noise does not move
  std::size_t compared = 0;
  for (std::size_t b = 0; b < errors.size(); ++b) {
    const Offsets& found = report.branches[b].offsets;
    if (errors[b].size() < kEnough || found.samples < kEnough) continue;
    ++compared;
    EXPECT_NEAR(found.median, median(errors[b]), 0.125 * report.voxelSize)
        << f.value.tree.branches[b].label;
    EXPECT_LT(found.noEdge + found.wrongPolarity, 0.1) << f.value.tree.branches[b].label;
  }
  EXPECT_GE(compared, std::min<std::size_t>(errors.size(), 2));
}

TEST(TrueWall, OfTheTubeIsWhereTheOffsetStates) {
  expectAgreement(fitted("tube", 64));
}
TEST(TrueWall, OfTheBifurcationIsWhereTheOffsetStates) {
  expectAgreement(fitted("bifurcation", 96));
}
TEST(TrueWall, OfAPatientIsWhereTheOffsetStates) {
  expectAgreement(fitted("patient", 128));
}

TEST(IdealEdge, IsNotDisplacedWithoutBlur) {
  const IdealEdge edge(0, 0.2);
  EXPECT_EQ(edge.ofCylinder(1), 0);
  EXPECT_EQ(edge.ofBall(1), 0);
}

// Level sets of a blurred shape move by half the variance times the sum of the curvatures.
TEST(IdealEdge, OfAWideVesselLiesInsideByTheVarianceOverItsDiameter) {
  const double s = 0.14, voxel = 0.2;
  const IdealEdge edge(s, voxel);
  for (const double radius : {2.0, 2.35, 2.45, 4.0}) {
    EXPECT_NEAR(edge.ofCylinder(radius), -s * s / (2 * radius), 0.005 * voxel);
    EXPECT_NEAR(edge.ofBall(radius), -s * s / radius, 0.01 * voxel);
  }
}

TEST(IdealEdge, ScalesWithTheUnit) {
  const IdealEdge small(0.06, 0.1), large(0.6, 1);
  for (const double radius : {0.8, 1.5, 3.0, 20.0})
    EXPECT_NEAR(10 * small.ofCylinder(0.1 * radius), large.ofCylinder(radius), 1e-5);
}

// The peak of a thin vessel falls, and with it the half level, which makes it look wider.
TEST(IdealEdge, OfAVesselAsThinAsTheBlurLiesOutside) {
  EXPECT_GT(IdealEdge(0.67, 1).ofCylinder(0.75), 0.05);
}

}  // namespace
}  // namespace lumen::convert
