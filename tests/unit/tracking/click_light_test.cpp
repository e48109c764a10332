// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/vessel_at_click.h"

namespace lumen::convert {
namespace {

TEST(ClickLight, CountsTheClicksInVesselsAndNoneBesideThem) {
  PhantomOptions options;
  options.name = "bifurcation";
  options.size = 64;
  Progress progress;
  const Phantom phantom = makePhantom(options, progress);
  const TrackOptions track;
  const ClickLight light(phantom.volume, track, progress);
  EXPECT_EQ(light.countInVessels(phantom.seeds), phantom.seeds.size());
  std::vector<SeedBranch> mirrored = phantom.seeds;
  for (SeedBranch& seed : mirrored)  // out of the middle, where the vessels are
    seed.points[0].position = {0.5, 0.5, seed.points[0].position.z()};
  EXPECT_EQ(light.countInVessels(mirrored), 0U);
}

}  // namespace
}  // namespace lumen::convert
