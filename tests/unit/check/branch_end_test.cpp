// SPDX-License-Identifier: Apache-2.0
// The end of each vessel in words, on cases of beads.
#include "converters/judge/facts/branch_end.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::StopReason;
using formats::test::addBeads;
using formats::test::alongX;

/// A vessel along x from 0 to 20, and another of its own from 30 to 40.
Case twoVessels() {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 41), 1);
  addBeads(value, "b", alongX(30, 0.5F, 21), 1);
  return value;
}

TEST(BranchEnd, StatesWhyTrackingEndedAndWhere) {
  Case value = twoVessels();
  EXPECT_EQ(describeEnds(value)[0], "ends at (20.0, 0.0, 0.0)");
  const std::vector<std::pair<StopReason, std::string>> texts{
      {StopReason::NoValidCylinder, "fades: the edges show no cylinder beyond (20.0, 0.0, 0.0)"},
      {StopReason::TurnedBack, "turned back on itself at (20.0, 0.0, 0.0)"},
      {StopReason::LeftVolume, "leaves the volume at (20.0, 0.0, 0.0)"},
      {StopReason::MetBranch, "met another vessel at (20.0, 0.0, 0.0)"},
      {StopReason::EndOfSeeds, "ends where its seeds end, at (20.0, 0.0, 0.0)"},
      {StopReason::StepLimit, "reached the greatest number of nodes at (20.0, 0.0, 0.0)"}};
  for (const auto& [reason, text] : texts) {
    value.tree.branches[0].stopReason = reason;
    EXPECT_EQ(describeEnds(value)[0], text);
  }
}

TEST(BranchEnd, NamesTheVesselThatWasMet) {
  Case value = twoVessels();
  addBeads(value, "c", alongX(20.5F, 0.5F, 5), 1);
  value.tree.branches[0].stopReason = StopReason::MetBranch;
  EXPECT_EQ(describeEnds(value)[0], "met c at (20.0, 0.0, 0.0)");
}

TEST(BranchEnd, AVesselThatGoesOnNamesThoseThatBeginThereWhateverIsRecorded) {
  Case value = twoVessels();
  value.tree.branches[0].stopReason = StopReason::NoValidCylinder;
  value.tree.links = {{40, 41}};
  EXPECT_EQ(describeEnds(value)[0], "is linked with b at (20.0, 0.0, 0.0)");
  addBeads(value, "c", alongX(20.5F, 0.5F, 5), 1, 40);
  EXPECT_EQ(describeEnds(value)[0], "goes on as c at (20.0, 0.0, 0.0)");
  addBeads(value, "d", alongX(20.5F, 0.5F, 5), 0.5F, 40);
  addBeads(value, "e", alongX(20.5F, 0.5F, 5), 0.5F, 40);
  EXPECT_EQ(describeEnds(value)[0], "goes on as c, d and e at (20.0, 0.0, 0.0)");
}

TEST(BranchEnd, AnEndAtTheBorderLeavesTheVolume) {
  Case value = twoVessels();
  value.tree.branches[0].stopReason = StopReason::NoValidCylinder;
  formats::SourceVolume source;
  source.size = {40, 40, 40};
  source.spacing = {1, 1, 1};
  source.origin = {0, -20, -20};
  source.direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  value.metadata.source = source;
  EXPECT_EQ(describeEnds(value)[0], "fades: the edges show no cylinder beyond (20.0, 0.0, 0.0)");
  EXPECT_EQ(describeEnds(value)[1], "leaves the volume at (40.0, 0.0, 0.0)");
}

}  // namespace
}  // namespace lumen::convert
