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

}  // namespace
}  // namespace lumen::convert
